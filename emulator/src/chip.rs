//! A chip but for its core: peripherals and the time in which they run.
//!
//! Each peripheral is a file; `models` has a file a chip, with its peripherals' versions,
//! addresses, clock gates and wires. Here are the lines between them: requests, interrupts, pins.
//!
//! A register that no peripheral knows, or a setting that it does not model, ends the run with a
//! [`Fault`]; a peripheral without its clock reads zero and ignores writes, as on the chip.

mod can;
mod can_bus;
mod can_errors;
mod dma;
mod facts;
mod fault;
mod fields;
mod flash;
mod gpio;
mod lines;
mod model;
mod models;
mod mux;
mod pins;
mod plain;
mod power;
mod rcc;
mod registers;
mod remap;
mod requests;
mod sensor_lines;
mod serial_port;
mod spi;
mod timer;
mod trouble;
mod usart;
mod watchdog;
mod wiring;

pub(crate) use can::{Arrival, Request};
pub(crate) use facts::{Fact, FactKind, facts};
pub(crate) use fault::{Fault, ResetCause};
pub(crate) use model::{CoreKind, Model};
pub(crate) use models::MODELS;
pub(crate) use power::WELL_MV;
pub(crate) use sensor_lines::{Needs, SensorEnd};
pub(crate) use wiring::SIDE_NAMES;

use crate::memory::Memories;
use can::BxCan;
use dma::Dma;
use flash::Flash;
use gpio::Gpio;
use lines::Lines;
use mux::Mux;
use plain::Plain;
use power::Power;
use rcc::{Clocks, Rcc};
use remap::Remap;
use sensor_lines::SensorLines;
use serial_port::SerialLine;
use spi::Spi;
use timer::Timer;
use usart::Usart;
use watchdog::Watchdog;
use wiring::CAN_IRQS;

/// Time since power-up, picoseconds: wraps after half a year.
pub(crate) type Ps = u64;

/// The voltage detector's interrupt in the NVIC, of every chip.
const SUPPLY_IRQ: u16 = 1;

#[derive(Debug)]
pub(crate) struct Chip {
    pub(crate) model: &'static Model,
    /// The time up to which everything has happened, and at which accesses happen.
    pub(crate) now: Ps,
    rcc: Rcc,
    clocks: Clocks,
    power: Power,
    exti: Lines,
    pub(crate) flash: Flash,
    /// What switches the pull-downs of USB-C pins off, on the G071.
    system: Plain,
    debug: Plain,
    gpio: [Gpio; 3],
    remap: Remap,
    timers: Vec<Timer>,
    /// SPI1, and SPI2 where it is used: that of the left side, and of the right.
    spis: Vec<Spi>,
    dmas: Vec<Dma>,
    mux: Mux,
    watchdog: Watchdog,
    /// USART2, the ST-LINK's serial port, and its line.
    usart: Usart,
    serial: SerialLine,
    /// The controller of a head's bus, where the chip has one.
    pub(crate) can: BxCan,
    /// The sensors' wires, the left side's first.
    pub(crate) lines: [SensorLines; 2],
    fault: Option<Fault>,
}

impl Chip {
    pub(crate) fn new(model: &'static Model) -> Result<Self, Fault> {
        let rcc = Rcc::new(model.rcc);
        let clocks = rcc.clocks()?;
        let timers = model.timers.iter();
        let spis = model.spis.iter();
        Ok(Self {
            model,
            now: 0,
            rcc,
            clocks,
            power: Power::new(model.power),
            exti: Lines::new(model.lines),
            flash: Flash::new(model.flash_interface),
            system: Plain::new(&[(0x00, 0)]),
            debug: Plain::new(model.debug_registers),
            gpio: model.ports.map(Gpio::new),
            remap: Remap::default(),
            timers: timers.map(|(_, kind, _)| Timer::new(*kind)).collect(),
            spis: spis.map(|_| Spi::new(model.spi_version)).collect(),
            dmas: model.dmas.iter().map(|layout| Dma::new(layout)).collect(),
            mux: Mux::default(),
            watchdog: Watchdog::new(1_000_000_000_000 / model.lsi_hz, model.has_window),
            usart: Usart::new(model.usart),
            serial: SerialLine::default(),
            can: BxCan::new(),
            lines: SIDE_NAMES.map(SensorLines::new),
            fault: None,
        })
    }

    pub(crate) fn reset(&mut self, cause: ResetCause) -> Result<(), Fault> {
        self.rcc.reset(cause);
        self.clocks = self.rcc.clocks()?;
        let map = self.model.map.iter();
        map.for_each(|(unit, ..)| self.reset_unit(*unit));
        // /SS floats, with the sensor's own pull-up.
        self.select_sensors();
        Ok(())
    }

    pub(crate) const fn cycle(&self) -> Ps {
        self.clocks.core
    }

    /// The interrupt lines of tick, frames and supply, and whether they are up; the tick's
    /// first, then that of the left side's frames.
    pub(crate) fn interrupts(&self) -> impl Iterator<Item = (u16, bool)> {
        let wiring = &self.model.wiring;
        let tick = (wiring.tick_irq, self.timers[wiring.tick].interrupts());
        let frames = wiring.sides.iter().map(|side| {
            let up = self.dmas[side.dma].interrupts(side.rx.stream);
            (side.end_of_frame, up)
        });
        let supply = (SUPPLY_IRQ, self.exti.interrupts());
        let bus = CAN_IRQS.into_iter().zip(self.can.interrupts());
        let bus = bus.filter(|_| wiring.can_function.is_some());
        std::iter::once(tick)
            .chain(frames)
            .chain([supply])
            .chain(bus)
    }

    pub(crate) fn tick_began(&self) -> Ps {
        self.timers[self.model.wiring.tick].updated
    }

    pub(crate) fn next_event(&self) -> Option<Ps> {
        let timers =
            (0..self.timers.len()).filter_map(|n| self.timers[n].next(self.timer_clock(n)));
        let bytes = self.spis.iter().filter_map(|spi| spi.shift);
        let bytes = bytes.map(|shift| shift.ends);
        let others = [
            self.watchdog.bites(),
            self.usart.sends_until(),
            self.serial.next(),
            self.can.next(),
        ];
        let others = others.into_iter().flatten();
        timers.chain(bytes).chain(others).min()
    }

    /// Lets everything happen that is due by `now`; `sensors` hang on the wires, the
    /// left one first. Returns what resets the chip.
    pub(crate) fn advance(
        &mut self,
        now: Ps,
        memories: &Memories,
        sensors: &mut [impl SensorEnd],
    ) -> Result<Option<ResetCause>, Fault> {
        loop {
            if let Some(fault) = self.fault.take() {
                return Err(fault);
            }
            self.serve_requests(memories)?;
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
            self.carry_serial()?;
            self.can.advance(due);
        }
        self.now = now;
        Ok(None)
    }

    fn begin_bytes(&mut self, sensors: &mut [impl SensorEnd]) -> Result<(), Fault> {
        for (side, sensor) in sensors.iter_mut().enumerate() {
            if self.lines[side].take_over() {
                sensor.release();
            }
            if let Some(shift) = self.spis[side].shift {
                let bit = self.spis[side].bit(self.spi_clock(side));
                let is_polled = !self.spis[side].asks_dma();
                self.lines[side].begin((shift.began, bit), is_polled, sensor)?;
            }
        }
        Ok(())
    }

    fn end_bytes(&mut self, sensors: &mut [impl SensorEnd]) {
        let now = self.now;
        for side in 0..self.spis.len() {
            let shift = self.spis[side].shift.filter(|shift| shift.ends == now);
            if let Some(shift) = shift {
                let sensor = sensors.get_mut(side);
                let sensor = sensor.filter(|_| self.sensor_is_connected(side));
                let answer = self.lines[side].end(shift.sent, now, sensor);
                let clock = self.spi_clock(side);
                self.spis[side].end(answer, now, clock);
            }
        }
    }

    fn spi_clock(&self, side: usize) -> Ps {
        self.clocks.bus(self.model.spis[side])
    }

    fn timer_clock(&self, n: usize) -> Ps {
        let (.., bus) = self.model.timers[n];
        self.clocks.timer(bus)
    }

    pub(crate) fn keep(&mut self, fault: Fault) {
        self.fault.get_or_insert(fault);
    }
}

#[cfg(test)]
mod tests;
