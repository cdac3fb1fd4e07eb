//! The program of every board: its start and its tasks.
//!
//! | task | priority | does |
//! |---|---|---|
//! | `tick` | 2 | one [`firmware::Module::tick`]; puts its events into a queue |
//! | `end_of_frame` | 2 | raises /SS after the left sensor's last byte |
//! | `end_of_right_frame` | 2 | the same on the right, where the image has that side |
//! | `hear`, `said` | 2 | what came by the bus of a head, and what went, where the image has one |
//! | `idle` | 0 | writes the log, checks what nothing writes, feeds the watchdog, sleeps |
//!
//! All but `idle` have one priority, as they work on the same registers: none can
//! interrupt another, and they share the module without a lock. Events come to idle, and other
//! settings from it, by queues with one writer and one reader each, without a lock too. Tasks are
//! bound to a board's interrupts by [`program!`](crate::program).

use firmware::boards::TickPeriod;
use firmware::faults::number;
use firmware::{ConfigError, Event, EventRecord, Health, NotArmed, Part};
use heapless::spsc::{Consumer, Producer};
use static_cell::StaticCell;

use super::about::About;
use super::bus::{self, Head};
use super::counters::{MISSED, TICKS, WORST, WrappingCounter};
use super::integrity::Integrity;
#[cfg(feature = "deploy")]
use super::loading::{self, Line, Order};
use super::perception::Names;
use super::scene::{Pace, Scene};
use super::serial::{self, Serial};
use super::signal_pins::SignalPins;
#[cfg(feature = "deploy")]
use super::telemetry::Origin;
use super::telemetry::{self, Configs, Exchange, Telemetry};
use super::types::{Inner, Settings};
use super::user_button::{self, HAS_STOPPED, REQUEST, UserButton};
use super::watchdog::Watchdog;
use super::{
    faults, hardware, log, outputs, pace, perception, reset, retained, scene, sensor, slots, supply,
};
use crate::here::{self, Counter};

/// Fifteen events fit: idle drains them after every tick, which has four a side at most.
pub struct Queues {
    events: heapless::spsc::Queue<EventRecord, 16>,
    link: telemetry::Queues,
}

impl Queues {
    pub(crate) const fn new() -> Self {
        Self {
            events: heapless::spsc::Queue::new(),
            link: telemetry::Queues::new(),
        }
    }
}

/// A type of its own, because RTIC would make those inside public.
pub struct Module {
    inner: &'static mut Inner,
    telemetry: Telemetry,
    head: Head,
    /// In RAM, where they can be changed.
    settings: &'static mut Settings,
    /// The next full second, in [`TICKS`].
    second: u32,
}

/// Events that found the queue full. Only the tick counts them.
static DROPPED: WrappingCounter = WrappingCounter::new();

/// Of events, the tick's end of the queue.
pub type Events = Producer<'static, EventRecord>;

pub(crate) struct Started {
    pub(crate) module: Module,
    pub(crate) tick: TickPeriod,
    pub(crate) events: Events,
    pub(crate) idle: &'static mut Idle,
}

static IDLE: StaticCell<Idle> = StaticCell::new();

pub(crate) fn start(core: cortex_m::Peripherals, queues: &'static mut Queues) -> Started {
    outputs::off();
    here::prepare_for_debuggers();
    let cause = here::reset_cause();
    let start = retained::start(cause);
    let Some(found) = scene::find() else {
        faults::die(number::SETTINGS, || {})
    };
    let is_slow = found.settings.sensor.kind.is_slow();
    pace::set(found.settings.head.tick_hz, is_slow);
    let node = bus::number(found.settings);
    let about = About::new(found.settings, node);
    log::start(cause, &start, &found);
    serial::started(cause, &start, &about);
    supply::start();
    let Ok(source) = here::start_clocks() else {
        faults::die(number::NO_CLOCK, log::no_clock)
    };
    pace::runs_by(source);
    let Some(pace) = Pace::of(pace::clocks(), found.settings) else {
        faults::die(number::NO_CLOCK, || {})
    };
    if is_slow {
        reset::halve_clocks();
    }
    let (events, of_events) = queues.events.split();
    let (idle_ends, settings_ways, tick_ends) = queues.link.split();
    let reason = no_scene(&found);
    let Scene {
        settings, deployed, ..
    } = found;
    let Some(inner) = hardware::start(settings, node, &pace, Counter::start(core)) else {
        faults::die(number::MODEL, || {})
    };
    perception::find(inner, settings, node, deployed);
    let gate = perception::gate_of(inner);
    perception::adapt(settings, gate);
    let integrity = Integrity::new(settings, inner);
    let names = Names::of(inner);
    let model = perception::state(inner);
    log::model(model, &names);
    let Some(configs) = Configs::start(deployed.ok_or(reason), gate, settings_ways) else {
        faults::die(number::SETTINGS, || {})
    };
    let telemetry = Telemetry::new(settings, inner, model, tick_ends);
    let motion = settings.motion.as_ref().filter(|_| Part::Motion.is_built());
    if let Some(motion) = motion {
        let slot = deployed.map_or(usize::MAX, |deployed| deployed.slot);
        let may_arm = start.may_arm(motion.arms_at_start);
        match may_arm.and_then(|()| slots::arm_once(slot)) {
            Ok(()) => inner.arm(true),
            Err(reason) => say_not_armed(reason, &about),
        }
    }

    // The sensor's start-up, with /SS high since above.
    cortex_m::asm::delay(pace::clocks().start_up_cycles());
    #[cfg(feature = "mlx90333")]
    hardware::test_sensors(inner, settings, &pace);
    let second = settings.head.tick_hz;
    let (head, post) = Head::start(settings, &pace, node);
    let module = Module {
        inner,
        telemetry,
        head,
        settings,
        second,
    };
    let idle = IDLE.try_init(Idle {
        integrity,
        names,
        watchdog: Watchdog::start(),
        button: UserButton::start(),
        serial: Serial::start(&about),
        pins: SignalPins::start(about.links.has_pins),
        exchange: Exchange::new(idle_ends, configs, post, &about),
        about,
        events: of_events,
        in_use: deployed.map(|deployed| deployed.slot),
        fed: 0,
        logged: 0,
        before: None,
    });
    let Some(idle) = idle else {
        faults::die(number::SETTINGS, || {})
    };
    Started {
        module,
        tick: pace.tick,
        events,
        idle,
    }
}

// Apart, as inside the start it is a jump that the stack's check cannot follow.
#[cold]
#[inline(never)]
fn say_not_armed(reason: NotArmed, about: &About) {
    log::not_armed(reason);
    serial::not_armed(reason, about);
}

/// What is wrong with one that is there comes before that another place is empty.
fn no_scene(found: &Scene) -> ConfigError {
    let mut all = found.refused.iter().flatten();
    let wrong = all.find(|error| **error != ConfigError::Absent);
    wrong.copied().unwrap_or(ConfigError::Absent)
}

#[inline]
pub(crate) fn tick(module: &mut Module, events: &mut Events) {
    obey(module, events);
    let Module {
        inner,
        telemetry,
        head,
        settings,
        ..
    } = module;
    head.before(inner, settings, &mut |event| put(events, telemetry, event));
    inner.tick(settings, &mut |event| {
        head.note(&event);
        put(events, telemetry, event);
    });
    head.after(inner, settings);
    let tick_hz = settings.head.tick_hz;
    let now = TICKS.increment();
    if telemetry.is_busy() {
        tell(module);
    }
    // Full, or further ahead than a second can be: a flipped bit.
    if module.second.wrapping_sub(now).wrapping_sub(1) >= tick_hz {
        module.second = now.wrapping_add(tick_hz);
        tell_timing(module);
    }
}

/// Stops the motors before a tick, or arms them, if that was asked for.
// Apart, so that the tick keeps its registers.
#[inline(never)]
fn obey(module: &mut Module, events: &mut Events) {
    let is_stop = module.telemetry.look_for_stop(TICKS.get());
    if !Part::Motion.is_built() {
        return;
    }
    // Down, the button stops motors that are armed and arms none.
    let is_armed = module.inner.is_armed();
    let is_down = is_armed && user_button::is_down();
    if is_stop || is_down {
        stop(module, events, is_down);
    } else if !is_armed && REQUEST.take() {
        arm(module);
    }
}

/// Until somebody arms them: what was asked for before arms none, and no reset does.
#[cold]
#[inline(never)]
fn stop(module: &mut Module, events: &mut Events, is_by_button: bool) {
    module.inner.arm(false);
    module.head.stop();
    retained::set_stopped(module.inner.motion().is_some());
    REQUEST.take();
    if is_by_button {
        module.telemetry.stop();
        HAS_STOPPED.make();
        put(events, &mut module.telemetry, Event::Stopped);
    }
}

#[cold]
#[inline(never)]
fn arm(module: &mut Module) {
    module.inner.arm(true);
    module.head.arm();
    retained::set_stopped(false);
}

/// Events come from many places: this stands in flash once.
#[inline(never)]
fn put(events: &mut Events, telemetry: &mut Telemetry, event: Event) {
    // A tick counts itself once it has ended.
    let sequence = TICKS.get().wrapping_add(1);
    if events.enqueue(EventRecord { sequence, event }).is_err() {
        DROPPED.increment();
    }
    telemetry.note(&event);
}

/// Records of this tick, and what was asked for.
// Apart, so that a tick without it keeps its registers.
#[cold]
#[inline(never)]
fn tell(module: &mut Module) {
    let telemetry = &mut module.telemetry;
    telemetry.send(module.inner, module.settings, TICKS.get());
    if telemetry.waits() {
        talk(module);
    }
}

// Apart, so that records keep their registers.
#[cold]
#[inline(never)]
fn talk(module: &mut Module) {
    let telemetry = &mut module.telemetry;
    let arms = telemetry.talk(module.inner, &mut module.settings, TICKS.get());
    // Other boards of a head may be off where this one is not.
    if arms && Part::Bus.is_built() {
        module.head.arm();
    }
}

/// Once a second: for [`Idle`], which has no access to the module, and for the next start.
#[cold]
fn tell_timing(module: &mut Module) {
    retained::second();
    let timing = module.inner.timing_mut();
    WORST.set(timing.take_worst());
    MISSED.set(timing.missed());
}

#[inline]
pub(crate) fn end_of_frame(module: &mut Module, side: usize) {
    // There is one on each side.
    if let Some(whisker) = module.inner.whiskers_mut().get_mut(side) {
        sensor::end_of_frame(whisker.sensor_mut().source_mut());
    }
}

#[cfg(feature = "bus")]
pub(crate) fn hear(module: &mut Module) {
    module.head.hear();
}

#[cfg(feature = "bus")]
pub(crate) fn said(module: &mut Module) {
    module.head.said();
}

pub(crate) struct Idle {
    integrity: Integrity,
    names: Names,
    watchdog: Watchdog,
    button: UserButton,
    serial: Option<Serial>,
    pins: Option<SignalPins>,
    about: About,
    events: Consumer<'static, EventRecord>,
    exchange: Exchange,
    in_use: Option<usize>,
    /// Ticks at the last feed of the watchdog, and at the last line on timing.
    fed: u32,
    logged: u32,
    before: Option<Health>,
}

impl Idle {
    pub(crate) fn run(&mut self) {
        let now = TICKS.get();
        if now == self.fed {
            return;
        }
        self.fed = now;
        while let Some(event) = self.events.dequeue() {
            if let Some(pins) = &mut self.pins {
                pins.note(&event.event, event.sequence);
            }
            self.report(event);
        }
        if let Some(pins) = &mut self.pins {
            pins.show(now);
        }
        self.exchange.take_from_head(&self.names);
        if self.about.links.has_rtt {
            self.exchange.take_from_probe(&self.names);
        }
        #[cfg(feature = "deploy")]
        self.load();
        if Part::Motion.is_built()
            && retained::STOPPED.take()
            && let Some(slot) = self.in_use
        {
            let _ = slots::arm_once(slot);
        }
        self.exchange.log_changes(now);
        self.integrity.step();
        // Both are alive: the tick, and idle itself.
        self.watchdog.feed();
        if Part::Motion.is_built() && self.about.has_motors && self.button.is_pressed() {
            REQUEST.make();
            self.report_now(Event::Armed);
        }
        if now.wrapping_sub(self.logged) >= pace::tick_hz() {
            self.logged = now;
            self.health();
        }
        // Before the answer that may end them.
        self.exchange.send_records();
        self.exchange.answer_probe();
        self.exchange.answer_head();
        if let Some(serial) = &mut self.serial {
            serial.serve(now, &self.about, (&mut self.exchange, &self.names));
            serial.send();
        }
    }

    fn report(&mut self, event: EventRecord) {
        log::event(&event.event, &self.names);
        if let Some(serial) = &mut self.serial {
            serial.say(&event.event, &self.names);
        }
        self.exchange.send_event(event);
    }

    fn report_now(&mut self, event: Event) {
        let sequence = TICKS.get();
        self.report(EventRecord { sequence, event });
    }

    #[cfg(feature = "deploy")]
    fn load(&mut self) {
        let Some((load, answer, origin)) = self.exchange.load_due() else {
            return;
        };
        let node = self.exchange.post.number();
        let line = match (origin, &mut self.serial) {
            (Origin::Board(_), _) => Line::Head(&mut self.exchange.post),
            (origin, Some(serial)) if origin.is_serial() => Line::Serial(serial),
            _ => Line::Probe(&mut self.exchange.probe),
        };
        let order = Order {
            load,
            in_use: self.in_use,
            answer,
            node,
        };
        loading::run(line, order);
    }

    /// Once a second: how ticks have fared, and the limits that were passed.
    fn health(&mut self) {
        // A probe that lets go has put them back as they were before it came.
        here::prepare_for_debuggers();
        let health = Health {
            worst_tenths: pace::tenths(WORST.get()),
            missed: MISSED.get(),
            dropped: DROPPED.get(),
        };
        let before = self.before.replace(health);
        let is_first = before.is_none();
        let before = before.unwrap_or_default();
        self.report_now(Event::Health(health));
        for (number, has_passed) in [
            (number::INTERNAL_CLOCK, is_first && pace::is_internal()),
            (number::MISSED, health.missed != before.missed),
            (number::DROPPED, health.dropped != before.dropped),
        ] {
            if has_passed {
                self.report_now(Event::Limit(number));
            }
        }
    }
}

/// Binds the tasks to the interrupts of the tick timer and of each side's rx DMA.
#[macro_export]
macro_rules! program {
    (
        tick: $tick:ident, end_of_frame: $left:ident
        $(, end_of_right_frame: $right:ident)? $(, bus: $heard:ident, $said:ident)?
    ) => {
        #[rtic::app(device = stm32_metapac, peripherals = false)]
        #[allow(
            unsafe_op_in_unsafe_fn,
            reason = "RTIC's own, seen because of this macro"
        )]
        mod app {
            use $crate::board::program::{self, Events, Idle, Module, Queues, Started};
            use $crate::board::{sleep, tick_timer};

            #[shared]
            struct Shared {
                // Its tasks cannot interrupt each other.
                #[lock_free]
                module: Module,
            }

            #[local]
            struct Local {
                events: Events,
                idle: &'static mut Idle,
            }

            #[init(local = [queues: Queues = Queues::new()])]
            fn init(cx: init::Context) -> (Shared, Local) {
                let started = program::start(cx.core, cx.local.queues);
                let Started {
                    module,
                    tick,
                    events,
                    idle,
                } = started;
                tick_timer::start(tick);
                (Shared { module }, Local { events, idle })
            }

            #[task(binds = $tick, priority = 2, shared = [module], local = [events])]
            fn tick(cx: tick::Context) {
                tick_timer::acknowledge();
                program::tick(cx.shared.module, cx.local.events);
            }

            #[task(binds = $left, priority = 2, shared = [module])]
            fn end_of_frame(cx: end_of_frame::Context) {
                program::end_of_frame(cx.shared.module, 0);
            }

            $(#[task(binds = $right, priority = 2, shared = [module])]
            fn end_of_right_frame(cx: end_of_right_frame::Context) {
                program::end_of_frame(cx.shared.module, 1);
            })?

            $(#[task(binds = $heard, priority = 2, shared = [module])]
            fn hear(cx: hear::Context) {
                program::hear(cx.shared.module);
            }

            #[task(binds = $said, priority = 2, shared = [module])]
            fn said(cx: said::Context) {
                program::said(cx.shared.module);
            })?

            #[idle(local = [idle])]
            fn idle(cx: idle::Context) -> ! {
                loop {
                    cx.local.idle.run();
                    sleep::until_interrupt();
                }
            }
        }
    };
}
