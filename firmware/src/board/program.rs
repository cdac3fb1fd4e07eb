//! The program of every board: its start and its tasks.
//!
//! | task | priority | does |
//! |---|---|---|
//! | `tick` | 2 | one [`firmware::Module::tick`]; puts its events into a queue |
//! | `end_of_frame` | 2 | raises /SS after the left sensor's last byte |
//! | `end_of_right_frame` | 2 | the same on the right, where the scene has that side |
//! | `idle` | 0 | writes the log, checks what nothing writes, feeds the watchdog, sleeps |
//!
//! All but the last have one priority, as they work on the same registers: none can
//! interrupt another, and they share the module without a lock. The queue they share
//! with idle, which holds them off while it takes an event out. They are bound to a
//! board's interrupts by [`program!`](crate::program).

use firmware::Event;
use firmware::faults::number;

use super::counters::{MISSED, TICKS, WORST, WrappingCounter};
use super::inner::Inner;
use super::integrity::Integrity;
use super::loading::Line;
use super::scene::{self, Names, Perception, SETTINGS, SIDES, Settings, TICK_HZ};
use super::sensor::Frames;
use super::serial::{self, Serial};
use super::signal_pins::SignalPins;
use super::telemetry::{self, Telemetry};
use super::user_button::{REQUEST, UserButton};
use super::watchdog::Watchdog;
use super::{faults, loading, log, outputs, retained, supply};
use crate::board::CLOCKS;
use crate::here::{self, Counter};

/// The module and its settings. A type of its own, because RTIC would make
/// those inside public.
pub struct Module {
    inner: Inner,
    telemetry: Telemetry,
    /// In RAM, where they can be changed.
    settings: &'static mut Settings,
    /// The next full second, in [`TICKS`].
    second: u32,
}

/// Where something lies that is made at the start, and need not be moved to from the stack
/// once more. A list, as an empty one is of zeros, which take no flash.
pub struct Slot<T>(heapless::Vec<T, 1>);

impl<T> Slot<T> {
    const fn new() -> Self {
        Self(heapless::Vec::new())
    }

    fn fill(&mut self, with: T) -> Option<&mut T> {
        // There is room for one.
        let _ = self.0.push(with);
        self.0.first_mut()
    }
}

/// Where settings and perception lie.
pub struct Place {
    settings: Slot<Settings>,
    perception: Slot<Perception>,
}

impl Place {
    /// Empty.
    pub(crate) const fn new() -> Self {
        Self {
            settings: Slot::new(),
            perception: Slot::new(),
        }
    }
}

/// Events that found the queue full. Only the tick counts them.
static DROPPED: WrappingCounter = WrappingCounter::new();

/// What idle gets from the start.
pub(crate) struct ForIdle {
    integrity: Integrity,
    names: Names,
}

/// From the reset to a module that is ready for its first tick.
pub(crate) fn start(core: cortex_m::Peripherals, place: &'static mut Place) -> (Module, ForIdle) {
    outputs::off();
    here::prepare_for_debuggers();
    let cause = here::reset_cause();
    let start = retained::start(cause);
    log::start(cause, &start);
    serial::started(cause, &start);
    supply::start();
    if let Err(error) = here::start_clocks() {
        faults::die(number::NO_CLOCK, || log::clock(error));
    }
    if scene::SENSORS_ARE_SLOW {
        here::halve_clocks();
    }
    here::clock_sensors();
    let slot_counts = const { CLOCKS.slot_counts(TICK_HZ) };
    let sources = SIDES.map(|side| [scene::source(Frames::new(&side.sensor, slot_counts))]);
    let motion = scene::start_motion();
    let perception = scene::start_perception();
    let perception = perception.and_then(|made| place.perception.fill(made));
    let (Some(perception), Some(settings)) = (perception, place.settings.fill(SETTINGS)) else {
        faults::die(number::MODEL, || {})
    };
    scene::adapt(settings, perception);
    let integrity = Integrity::new(settings, perception);
    let names = scene::names(perception);
    let model = scene::model(perception);
    log::model(model);
    let counter = Counter::start(core);
    let telemetry = Telemetry::new(settings, perception, model);
    let mut inner = firmware::Module::new(sources, motion, perception, counter);
    if scene::HAS_MOTOR {
        match start.may_arm(scene::ARMS_AT_START) {
            Ok(()) => inner.arm(true),
            Err(reason) => {
                log::not_armed(reason);
                serial::not_armed(reason);
            }
        }
    }

    // The sensor's start-up, with /SS high since above.
    cortex_m::asm::delay(CLOCKS.start_up_cycles());
    let module = Module {
        inner,
        telemetry,
        settings,
        second: TICK_HZ,
    };
    (module, ForIdle { integrity, names })
}

/// One tick of the module; `put` puts its events into the queue, or gives them back.
#[inline]
pub(crate) fn tick(module: &mut Module, mut put: impl FnMut(Event) -> Result<(), Event>) {
    if scene::HAS_MOTOR && REQUEST.take() {
        module.inner.arm(true);
    }
    module.inner.tick(module.settings, &mut |event| {
        if put(event).is_err() {
            DROPPED.increment();
        }
        telemetry::note(&event);
    });
    let now = TICKS.increment();
    if telemetry::is_busy() {
        tell(module);
    }
    // Full, or further ahead than a second can be: a flipped bit.
    if module.second.wrapping_sub(now).wrapping_sub(1) >= TICK_HZ {
        module.second = now.wrapping_add(TICK_HZ);
        tell_timing(module);
    }
}

/// Records of this tick, and what was asked for.
// Apart, so that a tick without it keeps its registers.
#[cold]
#[inline(never)]
fn tell(module: &mut Module) {
    let Module {
        inner,
        telemetry,
        settings,
        ..
    } = module;
    telemetry.send(inner, settings, TICKS.get());
    if telemetry::waits() {
        talk(module);
    }
}

/// Carries out what was asked for.
// Apart, so that records keep their registers.
#[cold]
#[inline(never)]
fn talk(module: &mut Module) {
    let Module {
        inner,
        telemetry,
        settings,
        ..
    } = module;
    telemetry.talk(inner, settings, TICKS.get());
}

/// Once a second: for [`Idle`], which has no access to the module, and for the next start.
#[cold]
fn tell_timing(module: &mut Module) {
    retained::second();
    let timing = module.inner.timing_mut();
    WORST.set(timing.take_worst());
    MISSED.set(timing.missed());
}

/// The frame of a side's sensor has ended.
#[inline]
pub(crate) fn end_of_frame(module: &mut Module, side: usize) {
    if let Some(sensor) = module.inner.sensor_mut(side, 0) {
        scene::frames(sensor.source_mut()).end_of_frame();
    }
}

/// Writes an event to the log. What the scene cannot do has no line.
#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "names of a model that is linked take no memory"
)]
fn write(event: Event, names: &Names) {
    match event {
        Event::Decision(place, decision) if scene::DECIDES => {
            let class = decision.class();
            let name = class.and_then(|class| scene::class_name(names, class));
            log::decision(place, name.unwrap_or("unknown"), decision);
        }
        Event::Touch { place, number } if scene::DECIDES => {
            log::touch(place, number);
        }
        Event::TouchEnd { place, number } if scene::DECIDES => {
            log::touch_end(place, number);
        }
        Event::SensorLost(place, fault) => log::sensor_lost(place, fault),
        Event::SensorBack(place) => log::sensor_back(place),
        Event::ZeroMoved(place, codes) if scene::FINDS_ZERO => log::zero_moved(place, codes),
        Event::MotorFault(place, fault) if scene::HAS_MOTOR => log::motor_fault(place, fault),
        Event::MotorRetry(place) if scene::HAS_MOTOR => log::motor_retry(place),
        Event::MotorGivenUp(place) if scene::HAS_MOTOR => log::motor_given_up(place),
        Event::Decision(..)
        | Event::Touch { .. }
        | Event::TouchEnd { .. }
        | Event::ZeroMoved(..)
        | Event::MotorFault(..)
        | Event::MotorRetry(_)
        | Event::MotorGivenUp(_) => {}
    }
}

/// The state of the idle task.
pub(crate) struct Idle {
    integrity: Integrity,
    names: Names,
    watchdog: Watchdog,
    button: UserButton,
    serial: Serial,
    pins: SignalPins,
    /// Ticks at the last feed of the watchdog, and at the last line on timing.
    fed: u32,
    logged: u32,
    before: log::Health,
    tuned: telemetry::Tuned,
}

impl Idle {
    /// Starts the watchdog.
    pub(crate) fn new(ForIdle { integrity, names }: ForIdle) -> Self {
        Self {
            integrity,
            names,
            watchdog: Watchdog::start(),
            button: UserButton::start(),
            serial: Serial::start(),
            pins: SignalPins::start(),
            fed: 0,
            logged: 0,
            before: log::Health::default(),
            tuned: telemetry::Tuned::new(),
        }
    }

    /// What is to be done between two sleeps; `take` takes an event out of the queue.
    pub(crate) fn run(&mut self, take: impl FnMut() -> Option<Event>) {
        let now = TICKS.get();
        if now == self.fed {
            return;
        }
        self.fed = now;
        // A tick queues its events before it counts itself.
        for event in core::iter::from_fn(take) {
            self.pins.note(&event, now);
            write(event, &self.names);
            self.serial.tell(&event, &self.names);
        }
        self.pins.show(now);
        telemetry::hear();
        if let Some((answer, is_by_serial)) = telemetry::to_load() {
            loading::run(Line::new(&mut self.serial, is_by_serial), answer);
        }
        self.tuned.tell(now);
        self.integrity.step();
        // Both are alive: the tick, and idle itself.
        self.watchdog.feed();
        if scene::HAS_MOTOR && self.button.is_pressed() {
            REQUEST.make();
            log::armed();
            self.serial.armed();
        }
        if now.wrapping_sub(self.logged) >= TICK_HZ {
            self.logged = now;
            let health = log::Health {
                worst: WORST.get(),
                missed: MISSED.get(),
                dropped: DROPPED.get(),
            };
            log::health(&health, &self.before);
            self.serial.health(&health, &self.before);
            self.before = health;
        }
        self.serial.serve(now);
    }
}

/// The program of a board: binds the tasks to the interrupts of the tick timer
/// and of each side's rx DMA.
#[macro_export]
macro_rules! program {
    (tick: $tick:ident, end_of_frame: $left:ident $(, end_of_right_frame: $right:ident)?) => {
        #[rtic::app(device = stm32_metapac, peripherals = false)]
        #[allow(
            unsafe_op_in_unsafe_fn,
            reason = "RTIC's own, seen because of this macro"
        )]
        mod app {
            use firmware::Queue;

            use $crate::board::program::{self, Idle, Module, Place};
            use $crate::board::scene::TICK_HZ;
            use $crate::board::tick_timer::TickTimer;
            use $crate::board::CLOCKS;

            #[shared]
            struct Shared {
                // Its tasks cannot interrupt each other.
                #[lock_free]
                module: Module,
                // Sixteen events: idle drains them after every tick, which has four a side
                // at most.
                queue: &'static mut Queue<16>,
            }

            #[local]
            struct Local {
                tick_timer: TickTimer,
                idle: Idle,
            }

            #[init(local = [queue: Queue<16> = Queue::new(), place: Place = Place::new()])]
            fn init(cx: init::Context) -> (Shared, Local) {
                let (module, for_idle) = program::start(cx.core, cx.local.place);
                let local = Local {
                    tick_timer: TickTimer::start(const { CLOCKS.tick(TICK_HZ) }),
                    idle: Idle::new(for_idle),
                };
                let queue = cx.local.queue;
                (Shared { module, queue }, local)
            }

            #[task(binds = $tick, priority = 2, shared = [module, queue], local = [tick_timer])]
            fn tick(mut cx: tick::Context) {
                cx.local.tick_timer.acknowledge();
                program::tick(cx.shared.module, |event| {
                    cx.shared.queue.lock(|queue| queue.put(event))
                });
            }

            #[task(binds = $left, priority = 2, shared = [module])]
            fn end_of_frame(cx: end_of_frame::Context) {
                program::end_of_frame(cx.shared.module, 0);
            }

            $(#[task(binds = $right, priority = 2, shared = [module])]
            fn end_of_right_frame(cx: end_of_right_frame::Context) {
                program::end_of_frame(cx.shared.module, 1);
            })?

            #[idle(shared = [queue], local = [idle])]
            fn idle(mut cx: idle::Context) -> ! {
                loop {
                    cx.local.idle.run(|| cx.shared.queue.lock(|queue| queue.take()));
                    cortex_m::asm::wfi();
                }
            }
        }
    };
}
