//! The program of every board: its start and its tasks.
//!
//! | task | priority | does |
//! |---|---|---|
//! | `tick` | 2 | one [`firmware::Module::tick`]; puts its events into a queue |
//! | `end_of_frame` | 2 | raises /SS after the sensor's last byte |
//! | `idle` | 0 | writes the log, feeds the watchdog, sleeps |
//!
//! The first two have one priority: they work on the same registers. They are
//! bound to a board's interrupts by [`program!`](crate::program).

use core::sync::atomic::{AtomicU32, Ordering};

use firmware::Event;
use firmware::design_parameters::hold_limits;
use heapless::spsc::{Consumer, Producer};
use mlx90333::Decoder;

use super::motion::{self, Moves};
use super::scene::{self, Deciding, Moving, Number, TICK_HZ};
use super::sensor::Frames;
use super::touch::{self, Decides};
use super::watchdog::Watchdog;
use super::{faults, log, outputs};
use crate::here::{self, CLOCKS, Counter};

/// The module. A type of its own, because RTIC would make those inside public.
pub struct Module {
    inner: Inner,
}

type Inner = firmware::Module<
    Number,
    Frames,
    <Moving as Moves>::Motion,
    <Deciding as Decides>::Perception,
    Counter,
    1,
    1,
>;

/// Its constants.
const CONFIG: firmware::Config<Number, motion::Config<Moving>, touch::Config<Deciding>> =
    firmware::Config {
        decoder: Decoder::new(),
        hold_limits: hold_limits(TICK_HZ),
        contact: scene::CONTACT,
        motion: Moving::CONFIG,
        perception: Deciding::CONFIG,
        period: CLOCKS.tick_counts(TICK_HZ),
    };

/// Ticks since the start. Only the tick writes it.
pub(crate) static TICKS: AtomicU32 = AtomicU32::new(0);

/// Events that found the queue full. Only the tick writes it.
static DROPPED: AtomicU32 = AtomicU32::new(0);

/// One more. In two steps, because a Cortex-M0+ has none that does both; each
/// counter has one writer.
#[inline]
fn count(counter: &AtomicU32) {
    counter.store(
        counter.load(Ordering::Relaxed).wrapping_add(1),
        Ordering::Relaxed,
    );
}

/// From the reset to a module that is ready for its first tick.
pub(crate) fn start(core: cortex_m::Peripherals) -> (Module, <Deciding as Decides>::Names) {
    outputs::off();
    here::prepare_for_debuggers();
    log::start(here::reset_cause());
    if let Err(error) = here::start_clocks() {
        faults::die(|| log::clock(error));
    }
    let frames = Frames::new(const { CLOCKS.slot_counts(TICK_HZ) });
    let motion = Moving::start();
    let Some((perception, names)) = Deciding::start() else {
        faults::die(log::model)
    };
    let counter = here::start_counter(core);
    let inner = Inner::new([[frames]], motion, perception, counter);

    // The sensor's start-up, with /SS high since above.
    cortex_m::asm::delay(CLOCKS.start_up_cycles());
    (Module { inner }, names)
}

/// One tick of the module; its events go to `say`.
#[inline]
pub(crate) fn tick(module: &mut Module, say: &mut Producer<'static, Event>) {
    module.inner.tick(&CONFIG, &mut |event| {
        if say.enqueue(event).is_err() {
            count(&DROPPED);
        }
    });
    count(&TICKS);
}

/// The longest tick since the last call, and the ticks missed since the start.
pub(crate) fn timing(module: &mut Module) -> (u32, u32) {
    let timing = module.inner.timing_mut();
    (timing.take_worst(), timing.missed())
}

/// The sensor's frame has ended.
#[inline]
pub(crate) fn end_of_frame(module: &mut Module) {
    if let Some(sensor) = module.inner.sensor_mut(0, 0) {
        sensor.source_mut().end_of_frame();
    }
}

/// What idle remembers.
pub(crate) struct Idle {
    heard: Consumer<'static, Event>,
    names: <Deciding as Decides>::Names,
    watchdog: Watchdog,
    seen: u32,
    told: u32,
    before: log::Health,
}

impl Idle {
    /// Starts the watchdog.
    pub(crate) fn new(
        heard: Consumer<'static, Event>,
        names: <Deciding as Decides>::Names,
    ) -> Self {
        Self {
            heard,
            names,
            watchdog: Watchdog::start(),
            seen: 0,
            told: 0,
            before: log::Health::default(),
        }
    }

    /// What is to be done between two sleeps; `timing` asks the module for its
    /// [`timing`].
    pub(crate) fn run(&mut self, timing: impl FnOnce() -> (u32, u32)) {
        while let Some(event) = self.heard.dequeue() {
            log::event(event, &self.names);
        }
        let now = TICKS.load(Ordering::Relaxed);
        if now == self.seen {
            return;
        }
        self.seen = now;
        // Both have done their work: the tick, and idle itself.
        self.watchdog.feed();
        if now.wrapping_sub(self.told) >= TICK_HZ {
            self.told = now;
            let (worst, missed) = timing();
            let health = log::Health {
                worst,
                missed,
                dropped: DROPPED.load(Ordering::Relaxed),
            };
            log::health(&health, &self.before);
            self.before = health;
        }
    }
}

/// The program of a board: binds the tasks to the interrupts of the tick timer
/// and of the rx DMA.
#[macro_export]
macro_rules! program {
    (tick: $tick:ident, end_of_frame: $end_of_frame:ident) => {
        #[rtic::app(device = stm32_metapac, peripherals = false)]
        #[allow(
            unsafe_op_in_unsafe_fn,
            reason = "RTIC's own, seen because of this macro"
        )]
        mod app {
            use defmt_rtt as _;
            use firmware::Event;
            use heapless::spsc::{Producer, Queue};

            use $crate::board::counter::TickTimer;
            use $crate::board::program::{self, Idle, Module};
            use $crate::board::scene::TICK_HZ;
            use $crate::here::CLOCKS;

            #[shared]
            struct Shared {
                module: Module,
            }

            #[local]
            struct Local {
                tick_timer: TickTimer,
                say: Producer<'static, Event>,
                idle: Idle,
            }

            // Sixteen events: idle drains them after every tick, which has three at most.
            #[init(local = [queue: Queue<Event, 17> = Queue::new()])]
            fn init(cx: init::Context) -> (Shared, Local) {
                let (module, names) = program::start(cx.core);
                let (say, heard) = cx.local.queue.split();
                let local = Local {
                    tick_timer: TickTimer::start(const { CLOCKS.tick(TICK_HZ) }),
                    say,
                    idle: Idle::new(heard, names),
                };
                (Shared { module }, local)
            }

            #[task(binds = $tick, priority = 2, shared = [module], local = [tick_timer, say])]
            fn tick(mut cx: tick::Context) {
                cx.local.tick_timer.acknowledge();
                let say = cx.local.say;
                cx.shared.module.lock(|module| program::tick(module, say));
            }

            #[task(binds = $end_of_frame, priority = 2, shared = [module])]
            fn end_of_frame(mut cx: end_of_frame::Context) {
                cx.shared.module.lock(program::end_of_frame);
            }

            #[idle(shared = [module], local = [idle])]
            fn idle(mut cx: idle::Context) -> ! {
                loop {
                    let idle = &mut *cx.local.idle;
                    idle.run(|| cx.shared.module.lock(program::timing));
                    cortex_m::asm::wfi();
                }
            }
        }
    };
}
