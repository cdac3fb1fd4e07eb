//! The STM32F446 but for its core: peripherals and the time in which they run.
//!
//! Each peripheral is a file; `registers` has their addresses, clock gates and
//! resets. Here are the lines between them: requests, interrupts, pins.
//!
//! A register that no peripheral knows, or a setting that it does not model,
//! ends the run with a [`Fault`]; a peripheral without its clock reads zero and
//! ignores writes, as on the chip.

mod dma;
mod fault;
mod gpio;
mod plain;
mod rcc;
mod registers;
mod reset;
mod sensor_lines;
mod spi;
mod time;
mod timer;
mod watchdog;

pub(crate) use fault::Fault;
pub(crate) use reset::ResetCause;
pub(crate) use sensor_lines::SensorEnd;
pub(crate) use time::Ps;

use dma::{Dma, Move};
use gpio::{Gpio, Role};
use plain::Plain;
use rcc::{Clocks, Rcc};
use sensor_lines::SensorLines;
use spi::Spi;
use timer::Timer;
use watchdog::Watchdog;

/// The interrupt of the tick, TIM3, in the NVIC.
pub(crate) const TICK_IRQ: u16 = 29;
/// The interrupt of the sensor's frame, DMA2 stream 0.
pub(crate) const FRAME_IRQ: u16 = 56;

/// TIM2, TIM3, TIM5, TIM1, TIM8 in [`Chip::timers`].
const ENCODER: usize = 0;
const TICK: usize = 1;
const MOTOR: usize = 3;
const PACER: usize = 4;

/// Everything on the chip but the core and its memories.
#[derive(Debug)]
pub(crate) struct Chip {
    /// The time up to which everything has happened, and at which accesses happen.
    pub(crate) now: Ps,
    rcc: Rcc,
    clocks: Clocks,
    flash: Plain,
    debug: Plain,
    gpio: [Gpio; 3],
    timers: [Timer; 5],
    spi: Spi,
    dma: Dma,
    watchdog: Watchdog,
    lines: SensorLines,
    fault: Option<Fault>,
}

impl Chip {
    /// A chip as its supply comes.
    pub(crate) fn new() -> Result<Self, Fault> {
        let rcc = Rcc::new();
        let clocks = rcc.clocks()?;
        Ok(Self {
            now: 0,
            rcc,
            clocks,
            flash: Plain::new(&[0x00]),
            debug: Plain::new(&[0x04, 0x08, 0x0C]),
            gpio: [
                Gpio::new([0xA800_0000, 0x0C00_0000, 0x6400_0000]),
                Gpio::new([0x0000_0280, 0x0000_00C0, 0x0000_0100]),
                Gpio::new([0; 3]),
            ],
            timers: [
                Timer::new(u32::MAX, false),
                Timer::new(0xFFFF, false),
                Timer::new(u32::MAX, false),
                Timer::new(0xFFFF, true),
                Timer::new(0xFFFF, true),
            ],
            spi: Spi::default(),
            dma: Dma::default(),
            watchdog: Watchdog::new(),
            lines: SensorLines::default(),
            fault: None,
        })
    }

    /// A reset: every peripheral as after power-up, but for what outlives it.
    pub(crate) fn reset(&mut self, cause: ResetCause) -> Result<(), Fault> {
        self.rcc.reset(cause);
        self.clocks = self.rcc.clocks()?;
        self.flash.reset();
        self.debug.reset();
        self.gpio.iter_mut().for_each(Gpio::reset);
        self.timers.iter_mut().for_each(Timer::reset);
        self.spi = Spi::default();
        self.dma = Dma::default();
        self.watchdog = Watchdog::new();
        // /SS floats, with the sensor's own pull-up.
        self.lines.select(false);
        Ok(())
    }

    /// A cycle of the core now.
    pub(crate) const fn cycle(&self) -> Ps {
        self.clocks.core
    }

    /// Whether the interrupt lines of tick and frame are up.
    pub(crate) fn interrupts(&self) -> [(u16, bool); 2] {
        [
            (TICK_IRQ, self.timers[TICK].interrupts()),
            (FRAME_IRQ, self.dma.interrupts(0)),
        ]
    }

    /// When the tick's timer had its last update.
    pub(crate) const fn tick_began(&self) -> Ps {
        self.timers[TICK].updated
    }

    /// Moves the encoder to this position, counts.
    pub(crate) const fn set_encoder(&mut self, position: i32) {
        self.timers[ENCODER].set_position(position);
    }

    /// Sets the levels of the Hall sensors on PA15, PB3 and PB10.
    pub(crate) fn set_halls(&mut self, [first, second, third]: [bool; 3]) {
        self.gpio[0].drive(15, first);
        self.gpio[1].drive(3, second);
        self.gpio[1].drive(10, third);
    }

    /// Duty on the motor pins PA8 to PA10, counts of a period of counts; zero
    /// where the pin is not the timer's.
    pub(crate) fn motor_duties(&self) -> [(u32, u32); 3] {
        [0, 1, 2].map(|channel: u32| {
            let (on, period) = self.timers[MOTOR].duty(channel as usize);
            match self.gpio[0].role(8 + channel) {
                Role::Alternate(1) => (on, period),
                Role::Output(true) => (period, period),
                _ => (0, period),
            }
        })
    }

    /// Levels of the motor's other outputs: direction on PB5, and enables on
    /// PC10 to PC12. A pin that is not driven is low.
    pub(crate) fn motor_pins(&self) -> (bool, [bool; 3]) {
        let high = |port: usize, pin| self.gpio[port].role(pin) == Role::Output(true);
        (high(1, 5), [high(2, 10), high(2, 11), high(2, 12)])
    }

    /// The next time at which something happens by itself.
    pub(crate) fn next_event(&self) -> Option<Ps> {
        let timers =
            (0..self.timers.len()).filter_map(|n| self.timers[n].next(self.timer_clock(n)));
        let byte = self.spi.shift.map(|shift| shift.ends);
        timers.chain(byte).chain(self.watchdog.bites()).min()
    }

    /// Lets everything happen that is due by `now`. Returns what resets the chip.
    ///
    /// # Errors
    /// The first fault since the last call.
    pub(crate) fn advance(
        &mut self,
        now: Ps,
        memory: &dyn Memory,
        sensor: &mut dyn SensorEnd,
    ) -> Result<Option<ResetCause>, Fault> {
        loop {
            if let Some(fault) = self.fault.take() {
                return Err(fault);
            }
            self.serve_requests(memory)?;
            if let Some(shift) = self.spi.shift {
                let bit = self.spi.bit(self.clocks.apb2);
                self.lines.begin(shift.began, bit, sensor)?;
            }
            let Some(due) = self.next_event().filter(|&due| due <= now) else {
                break;
            };
            self.now = due;
            if self.watchdog.bites() == Some(due) {
                return Ok(Some(ResetCause::Watchdog));
            }
            for n in 0..self.timers.len() {
                let clock = self.timer_clock(n);
                self.timers[n].sync(due, clock);
            }
            if let Some(shift) = self.spi.shift.filter(|shift| shift.ends == due) {
                let heard = self.sensor_is_connected();
                let answer = self.lines.end(shift.sent, due, heard, sensor);
                self.spi.end(answer, due, self.clocks.apb2);
            }
        }
        self.now = now;
        Ok(None)
    }

    /// Whether the SPI's pins and mode are those that the sensor's wires need.
    fn sensor_is_connected(&self) -> bool {
        let port = &self.gpio[0];
        let spi = |pin| port.role(pin) == Role::Alternate(5);
        spi(5) && spi(6) && spi(7) && port.is_open_drain(7) && self.spi.is_mode_1()
    }

    /// Moves bytes for every request that a stream listens to.
    fn serve_requests(&mut self, memory: &dyn Memory) -> Result<(), Fault> {
        loop {
            let moved = if self.spi.requests() {
                self.dma.request(0, 3)
            } else {
                None
            };
            if let Some(Move { from, to }) = moved {
                self.move_byte(from, to, memory)?;
                continue;
            }
            if !self.timers[PACER].request {
                return Ok(());
            }
            let Some(Move { from, to }) = self.dma.request(1, 7) else {
                return Ok(());
            };
            self.timers[PACER].request = false;
            self.move_byte(from, to, memory)?;
        }
    }

    fn move_byte(&mut self, from: u32, to: u32, memory: &dyn Memory) -> Result<(), Fault> {
        let byte = match memory.get(from) {
            Some(byte) => byte,
            None => self.read(from)? as u8,
        };
        if memory.put(to, byte).is_none() {
            self.write(to, byte.into(), u32::MAX)?;
        }
        Ok(())
    }

    fn timer_clock(&self, n: usize) -> Ps {
        if n < 3 {
            self.clocks.apb1_timer
        } else {
            self.clocks.apb2_timer
        }
    }

    /// Keeps the first fault of an access for [`Chip::advance`] to tell.
    pub(crate) fn keep(&mut self, fault: Fault) {
        self.fault.get_or_insert(fault);
    }
}

/// The chip's memories, as the DMA sees them.
pub(crate) trait Memory {
    /// A byte; `None` where there is no memory.
    fn get(&self, address: u32) -> Option<u8>;

    /// Writes a byte; `None` where there is no RAM.
    fn put(&self, address: u32, byte: u8) -> Option<()>;
}

#[cfg(test)]
mod tests;
