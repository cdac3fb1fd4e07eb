//! A supply that dips and a clock that stops, in idle and in the middle of a tick: are the
//! motor pins low in time, does the chip wait, and does the next start say why?

use std::path::Path;

use host_sim::Error;
use host_sim::loaded::Loaded;

use crate::chip::{Chip, Ps, ResetCause, WELL_MV};
use crate::deployment::flashed;
use crate::machine::Machine;
use crate::program::Program;
use crate::starting::{rests, whisks};
use crate::trouble::Trouble;

const US: Ps = 1_000_000;
const MS: Ps = 1_000 * US;

/// Within which the pins must be low, and how closely that is looked at.
const PINS_LOW: Ps = 50 * US;
const STEP: Ps = US;

/// Below the detector's threshold, where the clock of every board is still right, mV.
const LOW_MV: u32 = 2_750;
/// Below what the fastest clock needs, where each chip still runs, mV.
const LOWER_MV: u32 = 2_200;
/// Below the power-down reset, mV. RAM keeps its contents, as it does for a moment.
const GONE_MV: u32 = 1_000;
/// Below the highest brown-out level, mV.
const BROWN_MV: u32 = 2_800;

/// For how long the supply is low, and for how long a fault handler is watched: longer than
/// the watchdog bears.
const DIP: Ps = 45 * MS;

/// Befalls the board that runs the scene in `path`, each time a new one while its motors are
/// driven:
///
/// - the supply falls below the voltage detector's threshold, in idle and in a tick;
/// - it falls below the power-down reset at once, and comes back slowly;
/// - it falls below the brown-out level, where the chip has one;
/// - the clock from outside stops;
/// - the non-maskable interrupt comes without a cause.
///
/// The motor pins must be low within 50 us, the start must wait for the supply, motors must
/// stay off after it, and the log must say why. Returns what was measured, and the lines of
/// the log.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn dip(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (loaded, program) = flashed(path, program)?;
    let board = || Bench::new(&loaded, &program);
    let mut lines = Vec::new();
    for within_tick in [false, true] {
        lines.extend(board()?.falls(within_tick)?);
    }
    lines.push(board()?.goes()?);
    lines.extend(board()?.browns_out()?);
    lines.extend(board()?.clock_stops()?);
    lines.extend(board()?.stray_interrupt()?);
    Ok(lines)
}

/// A board that whisks.
struct Bench {
    trouble: Trouble,
    tick_hz: u32,
}

impl Bench {
    fn new(loaded: &Loaded, program: &Program) -> Result<Self, Error> {
        let mut trouble = Trouble::new(&loaded.scene, program)?;
        trouble.run.module_mut().bears_resets = true;
        let tick_hz = loaded.scene.tick_hz;
        whisks(&mut trouble, tick_hz / 4, "after power-up")?;
        Ok(Self { trouble, tick_hz })
    }

    fn falls(mut self, within_tick: bool) -> Result<[String; 3], Error> {
        self.await_drive(within_tick)?;
        self.supply(LOW_MV)?;
        let place = if within_tick { "in a tick" } else { "in idle" };
        let low = self.pins_low(&format!("the supply falls {place}"))?;
        let reset = self.leaves_clock()?;
        self.supply(LOWER_MV)?;
        self.wait(DIP)?;
        self.trouble.line("waiting for the supply")?;
        self.supply(WELL_MV)?;
        Ok([low, reset, self.refuses("software", 58)?])
    }

    fn goes(mut self) -> Result<String, Error> {
        self.await_drive(false)?;
        self.supply(GONE_MV)?;
        self.wait(DIP)?;
        self.supply(LOW_MV)?;
        self.wait(DIP)?;
        self.trouble.line("waiting for the supply")?;
        self.supply(WELL_MV)?;
        self.refuses("power-up", 53)
    }

    fn browns_out(mut self) -> Result<Vec<String>, Error> {
        const TOO_LOW: &str = "brown-out level";
        let before = self.trouble.line(TOO_LOW);
        if !self.machine().disturb(Chip::set_brown_out) {
            return match before {
                Ok(line) => Err(Error::Work(format!("there is none: {line}"))),
                Err(_) => Ok(Vec::new()),
            };
        }
        self.await_drive(true)?;
        self.supply(BROWN_MV)?;
        self.wait(DIP)?;
        self.trouble.log.clear();
        self.supply(WELL_MV)?;
        let refused = self.refuses("brown-out", 53)?;
        match self.trouble.line(TOO_LOW) {
            Ok(line) => Err(Error::Work(format!("at the highest level: {line}"))),
            Err(_) => Ok(vec![before?, refused]),
        }
    }

    fn clock_stops(mut self) -> Result<Vec<String>, Error> {
        self.await_drive(true)?;
        if !self.machine().disturb(|chip| chip.stop_clock(true))? {
            whisks(&mut self.trouble, self.tick_hz / 4, "without its clock")?;
            return Ok(vec!["no clock from outside is needed".to_owned()]);
        }
        let low = self.pins_low("the clock stops in a tick")?;
        self.machine().disturb(|chip| chip.stop_clock(false))?;
        self.dies(50)?;
        Ok(vec![low, self.refuses("watchdog", 50)?])
    }

    fn stray_interrupt(mut self) -> Result<[String; 2], Error> {
        self.await_drive(true)?;
        self.machine().raise_nmi();
        let low = self.pins_low("a non-maskable interrupt without a cause")?;
        self.dies(51)?;
        Ok([low, self.refuses("watchdog", 51)?])
    }

    fn machine(&mut self) -> &mut Machine {
        &mut self.trouble.board_mut().machine
    }

    fn supply(&mut self, supply_mv: u32) -> Result<(), Error> {
        self.machine().set_supply(supply_mv)?;
        Ok(())
    }

    /// Goes on until every motor is driven, and then into the next tick, or stays before it.
    fn await_drive(&mut self, within_tick: bool) -> Result<(), Error> {
        self.trouble.pass(1)?;
        for _ in 0..self.tick_hz {
            if !self.trouble.driven().contains(&false) {
                break;
            }
            self.trouble.pass(1)?;
        }
        let until = self.machine().now + MS * 1_000 / Ps::from(self.tick_hz);
        while within_tick && !self.machine().is_in_tick() && self.machine().now < until {
            self.trouble.board_mut().wait(STEP)?;
        }
        if self.machine().is_in_tick() != within_tick || self.trouble.driven().contains(&false) {
            return Err(Error::Work("no such tick".to_owned()));
        }
        Ok(())
    }

    /// Lets time pass on the chip alone, at whose end no motor may be driven.
    fn wait(&mut self, time: Ps) -> Result<(), Error> {
        self.trouble.board_mut().wait(time)?;
        self.trouble.take_log();
        if self.trouble.driven().contains(&true) {
            return Err(Error::Work("driven without supply or clock".to_owned()));
        }
        Ok(())
    }

    /// Waits until the motor pins are low, and says how long it took.
    fn pins_low(&mut self, what: &str) -> Result<String, Error> {
        let us = self.within(|trouble| !trouble.driven().contains(&true), what)?;
        Ok(format!("{what}: pins low within {us} us"))
    }

    /// Waits until the chip is reset, which takes it back to its own clock.
    fn leaves_clock(&mut self) -> Result<String, Error> {
        let software = Some(ResetCause::Software);
        let is_reset = |trouble: &mut Trouble| trouble.board_mut().reset.take() == software;
        let us = self.within(is_reset, "its clock stays fast")?;
        Ok(format!("- and the fast clock is left within {us} us more"))
    }

    /// Waits until something has happened, within [`PINS_LOW`]; how long it took, us.
    fn within(&mut self, has: impl Fn(&mut Trouble) -> bool, what: &str) -> Result<Ps, Error> {
        let begun = self.machine().now;
        while !has(&mut self.trouble) {
            if self.machine().now - begun > PINS_LOW {
                return Err(Error::Work(format!("{what}: nothing within 50 us")));
            }
            self.trouble.board_mut().wait(STEP)?;
        }
        let passed = self.machine().now - begun;
        Ok(passed.div_ceil(US))
    }

    /// The handler of this fault has its line in the log and feeds the watchdog, for longer than
    /// that bears without; its bite is not waited for, which other tests do.
    fn dies(&mut self, fault: u8) -> Result<(), Error> {
        self.wait(DIP)?;
        self.trouble.line(&format!("fault board {fault} "))?;
        if let Some(cause) = self.trouble.board_mut().reset {
            return Err(Error::Work(format!("fault {fault}: reset by {cause:?}")));
        }
        self.trouble.board_mut().reset_now(ResetCause::Watchdog)?;
        Ok(())
    }

    /// The module ticks, with its motors off; its second start was for this cause and fault.
    fn refuses(&mut self, cause: &str, fault: u8) -> Result<String, Error> {
        rests(&mut self.trouble, self.tick_hz / 10, cause)?;
        self.trouble.line(&format!("not-armed {fault} "))?;
        self.trouble.line(&format!(" {cause} 2 {fault}"))
    }
}
