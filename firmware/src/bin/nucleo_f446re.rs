//! The whisker module on a NUCLEO-F446RE: one whisker, the left.
//!
//! Here are the pins, the types and the tasks; drivers are in `board`, what a
//! tick does is in the library, and the numbers come from the scene that the
//! build was given (`WHISKER_SCENE`).
//!
//! | task | priority | does |
//! |---|---|---|
//! | `tick` | 2 | one [`firmware::Module::tick`]; puts its events into a queue |
//! | `end_of_frame` | 2 | raises /SS after the sensor's last byte |
//! | `idle` | 0 | writes the log, feeds the watchdog, sleeps |
//!
//! The first two have one priority: they work on the same registers.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../board/mod.rs"]
pub mod board;

/// On a PC there is nothing to do: this program is for the board.
#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
#[rtic::app(device = stm32f4xx_hal::pac, peripherals = true)]
mod app {
    use core::sync::atomic::{AtomicU32, Ordering};

    use defmt_rtt as _;
    use firmware::design_parameters::patience;
    use firmware::{Config, Event};
    use heapless::spsc::{Consumer, Producer, Queue};
    use mlx90333::Decoder;
    use stm32f4xx_hal::gpio::GpioExt;
    use stm32f4xx_hal::pac::Peripherals;

    use crate::board::counter::{Counter, Ticker};
    use crate::board::log::{Health, Names, TICKS};
    use crate::board::sensor::{self, Frames};
    use crate::board::timing::{self, TickPeriod};
    use crate::board::watchdog::Watchdog;
    use crate::board::{clock, faults, log, outputs, scene, touch};

    #[cfg(not(motor = "none"))]
    use crate::board::motor::{self, Motion};
    #[cfg(motor = "none")]
    use firmware::Passive as Motion;

    type Module = firmware::Module<f32, Frames, Motion, touch::Perception, Counter, 1, 1>;

    const TICK: TickPeriod = TickPeriod::new(scene::TICK_HZ);

    const CONFIG: Config<
        f32,
        <Motion as firmware::Motion<f32, 1, 1>>::Config,
        <touch::Perception as firmware::Perception<f32, 1, 1>>::Config,
    > = Config {
        decoder: Decoder::new(),
        patience: patience(scene::TICK_HZ),
        contact: scene::CONTACT,
        #[cfg(motor = "none")]
        motion: (),
        #[cfg(not(motor = "none"))]
        motion: motor::CONFIG,
        perception: touch::CONFIG,
        period: TICK.counts(),
    };

    /// Events that found the queue full.
    static DROPPED: AtomicU32 = AtomicU32::new(0);

    #[shared]
    struct Shared {
        module: Module,
    }

    #[local]
    struct Local {
        ticker: Ticker,
        say: Producer<'static, Event>,
        heard: Consumer<'static, Event>,
        names: Names,
        watchdog: Watchdog,
    }

    // Sixteen events: idle drains them after every tick, which has three at most.
    #[init(local = [queue: Queue<Event, 17> = Queue::new()])]
    fn init(cx: init::Context) -> (Shared, Local) {
        outputs::off();
        let device: Peripherals = cx.device;
        let mut rcc = device.RCC;
        clock::prepare_for_debuggers(&device.DBGMCU);
        log::start(clock::reset_cause(&rcc));
        if let Err(error) = clock::start(&rcc, &device.FLASH) {
            faults::die(|| log::clock(error));
        }

        let gpioa = device.GPIOA.split(&mut rcc);
        let gpiob = device.GPIOB.split(&mut rcc);
        let frames = Frames::new(
            device.SPI1,
            device.TIM8,
            device.DMA2,
            sensor::Pins {
                sck: gpioa.pa5,
                miso: gpioa.pa6,
                mosi: gpioa.pa7,
                select: gpiob.pb6,
            },
            const { timing::slot_counts(scene::TICK_HZ) },
            &mut rcc,
        );

        #[cfg(motor = "none")]
        let motion = Motion;
        #[cfg(motor = "h-bridge")]
        let pins = motor::Pins {
            pwm: gpioa.pa8,
            direction: gpiob.pb5,
        };
        #[cfg(motor = "six-step")]
        let pins = {
            let gpioc = device.GPIOC.split(&mut rcc);
            motor::Pins {
                inputs: (gpioa.pa8, gpioa.pa9, gpioa.pa10),
                enables: (gpioc.pc10, gpioc.pc11, gpioc.pc12),
                halls: (gpioa.pa15, gpiob.pb3, gpiob.pb10),
            }
        };
        #[cfg(not(motor = "none"))]
        let motion = {
            use crate::board::encoder::Encoder;
            let encoder = Encoder::start(device.TIM2, gpioa.pa0, gpioa.pa1, &mut rcc);
            motor::motion(motor::start(device.TIM1, pins, &mut rcc), encoder)
        };

        #[cfg(perception = "none")]
        let (perception, names) = ((), Names {});
        #[cfg(not(perception = "none"))]
        let (perception, names) = match touch::listen() {
            Some((perception, model)) => (perception, Names { model }),
            None => faults::die(log::model),
        };

        let counter = Counter::start(device.TIM5, &mut rcc);
        let module = Module::new([[frames]], motion, perception, counter);

        // The sensor's start-up, with /SS high since above.
        cortex_m::asm::delay(timing::START_UP_CYCLES);
        let (say, heard) = cx.local.queue.split();
        let local = Local {
            ticker: Ticker::start(device.TIM3, TICK, &mut rcc),
            say,
            heard,
            names,
            watchdog: Watchdog::start(device.IWDG),
        };
        (Shared { module }, local)
    }

    #[task(binds = TIM3, priority = 2, shared = [module], local = [ticker, say])]
    fn tick(mut cx: tick::Context) {
        cx.local.ticker.acknowledge();
        let say = cx.local.say;
        cx.shared.module.lock(|module| {
            module.tick(&CONFIG, &mut |event| {
                if say.enqueue(event).is_err() {
                    DROPPED.fetch_add(1, Ordering::Relaxed);
                }
            });
        });
        TICKS.fetch_add(1, Ordering::Relaxed);
    }

    #[task(binds = DMA2_STREAM0, priority = 2, shared = [module])]
    fn end_of_frame(mut cx: end_of_frame::Context) {
        cx.shared.module.lock(|module| {
            if let Some(sensor) = module.sensor_mut(0, 0) {
                sensor.source_mut().end_of_frame();
            }
        });
    }

    #[idle(shared = [module], local = [heard, names, watchdog])]
    fn idle(mut cx: idle::Context) -> ! {
        let mut seen = 0;
        let mut told = 0;
        let mut before = Health::default();
        loop {
            while let Some(event) = cx.local.heard.dequeue() {
                log::event(event, cx.local.names);
            }
            let now = TICKS.load(Ordering::Relaxed);
            if now != seen {
                seen = now;
                // Both have done their work: the tick, and idle itself.
                cx.local.watchdog.feed();
                if now.wrapping_sub(told) >= scene::TICK_HZ {
                    told = now;
                    let health = cx.shared.module.lock(|module| {
                        let timing = module.timing_mut();
                        Health {
                            worst: timing.take_worst(),
                            missed: timing.missed(),
                            dropped: DROPPED.load(Ordering::Relaxed),
                        }
                    });
                    log::health(&health, &before);
                    before = health;
                }
            }
            cortex_m::asm::wfi();
        }
    }
}
