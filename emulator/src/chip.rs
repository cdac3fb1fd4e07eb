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
mod pins;
mod plain;
mod rcc;
mod registers;
mod requests;
mod reset;
mod sensor_lines;
mod spi;
mod time;
mod timer;
mod timers;
mod upset;
mod watchdog;
mod wiring;

pub(crate) use fault::Fault;
pub(crate) use reset::ResetCause;
pub(crate) use sensor_lines::SensorEnd;
pub(crate) use time::Ps;
pub(crate) use wiring::SIDE_NAMES;

use dma::Dma;
use gpio::Gpio;
use plain::Plain;
use rcc::{Clocks, Rcc};
use sensor_lines::SensorLines;
use spi::Spi;
use timer::Timer;
use timers::{KINDS, TIM1, TIM7};
use watchdog::Watchdog;
use wiring::SIDES;

/// The interrupt of the tick, TIM7, in the NVIC.
pub(crate) const TICK_IRQ: u16 = 55;
/// The interrupts of the sensors' frames, left and right, in the NVIC.
pub(crate) const FRAME_IRQS: [u16; 2] = [SIDES[0].end_of_frame, SIDES[1].end_of_frame];

/// The timer that makes the ticks.
const TICK: usize = TIM7;

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
    timers: [Timer; 7],
    /// SPI1 and SPI2: that of the left side, and of the right.
    spis: [Spi; 2],
    /// DMA1 and DMA2.
    dmas: [Dma; 2],
    watchdog: Watchdog,
    /// The wires of each side's sensor.
    lines: [SensorLines; 2],
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
            timers: KINDS.map(Timer::new),
            spis: Default::default(),
            dmas: Default::default(),
            watchdog: Watchdog::new(),
            lines: SIDE_NAMES.map(SensorLines::new),
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
        self.spis = Default::default();
        self.dmas = Default::default();
        self.watchdog = Watchdog::new();
        // /SS floats, with the sensor's own pull-up.
        self.select_sensors();
        Ok(())
    }

    /// A cycle of the core now.
    pub(crate) const fn cycle(&self) -> Ps {
        self.clocks.core
    }

    /// Whether the interrupt lines of tick and frames are up.
    pub(crate) fn interrupts(&self) -> [(u16, bool); 3] {
        let frame = |side: usize| {
            let wires = &SIDES[side];
            let up = self.dmas[wires.dma].interrupts(wires.rx.stream);
            (wires.end_of_frame, up)
        };
        let tick = (TICK_IRQ, self.timers[TICK].interrupts());
        [tick, frame(0), frame(1)]
    }

    /// When the tick's timer had its last update.
    pub(crate) const fn tick_began(&self) -> Ps {
        self.timers[TICK].updated
    }

    /// The next time at which something happens by itself.
    pub(crate) fn next_event(&self) -> Option<Ps> {
        let timers =
            (0..self.timers.len()).filter_map(|n| self.timers[n].next(self.timer_clock(n)));
        let bytes = self.spis.iter().filter_map(|spi| spi.shift);
        let bytes = bytes.map(|shift| shift.ends);
        timers.chain(bytes).chain(self.watchdog.bites()).min()
    }

    /// Lets everything happen that is due by `now`; `sensors` hang on the wires, the
    /// left one first. Returns what resets the chip.
    ///
    /// # Errors
    /// The first fault since the last call.
    pub(crate) fn advance(
        &mut self,
        now: Ps,
        memory: &dyn Memory,
        sensors: &mut [impl SensorEnd],
    ) -> Result<Option<ResetCause>, Fault> {
        loop {
            if let Some(fault) = self.fault.take() {
                return Err(fault);
            }
            self.serve_requests(memory)?;
            self.begin_bytes(sensors)?;
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
            self.end_bytes(sensors);
        }
        self.now = now;
        Ok(None)
    }

    /// Tells the sensors of bytes that have begun.
    fn begin_bytes(&mut self, sensors: &mut [impl SensorEnd]) -> Result<(), Fault> {
        for (side, sensor) in sensors.iter_mut().enumerate() {
            if let Some(shift) = self.spis[side].shift {
                let bit = self.spis[side].bit(self.spi_clock(side));
                self.lines[side].begin(shift.began, bit, sensor)?;
            }
        }
        Ok(())
    }

    /// Ends the bytes that are due.
    fn end_bytes(&mut self, sensors: &mut [impl SensorEnd]) {
        let now = self.now;
        for side in 0..self.spis.len() {
            let shift = self.spis[side].shift.filter(|shift| shift.ends == now);
            if let Some(shift) = shift {
                let sensor = sensors.get_mut(side);
                let sensor = sensor.filter(|_| self.sensor_is_connected(side));
                let answer = self.lines[side].end(shift.sent, now, sensor);
                self.spis[side].end(answer, now, self.spi_clock(side));
            }
        }
    }

    /// The clock of a side's SPI: that of APB2 for SPI1, of APB1 for SPI2.
    fn spi_clock(&self, side: usize) -> Ps {
        [self.clocks.apb2, self.clocks.apb1][side]
    }

    fn timer_clock(&self, n: usize) -> Ps {
        if n < TIM1 {
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
