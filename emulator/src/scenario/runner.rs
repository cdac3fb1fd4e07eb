//! What is done to a board in trouble, for how long it runs, and what is expected of it.

use std::ops::Range;

use firmware::Event;
use host_sim::Error;
use host_sim::bus::WireFault;
use host_sim::bus::tmag5170::LineFault;
use mlx90333::Faults;
use tmag5170::StatusFaults;

use crate::chip::{Fault, Ps, ResetCause, SIDE_NAMES};
use crate::session::Session;
use crate::talk::wrong;
use crate::upset::{MIDDLE, Upset};

pub(super) const US: Ps = 1_000_000;
pub(super) const MS: Ps = 1_000 * US;

/// How closely it is looked at how soon something happens.
const LOOK: Ps = US;
/// Of the ticks in which motors are to move, how many they are driven in at least: they rest
/// where they turn round, and where they are on their setpoint.
const DRIVEN: f64 = 0.5;
/// How far a whisker may run on without its motor, degrees.
const RUN_ON_DEG: f64 = 60.0;

pub(super) type Done = Result<(), Error>;

/// What a board of its own is put through.
pub(super) struct Case {
    pub(super) what: String,
    /// Whether a reset is no fault.
    pub(super) may_reset: bool,
    pub(super) steps: Box<dyn Fn(&mut Runner) -> Done>,
}

/// A case in which the chip may be reset.
pub(super) fn case(what: &str, steps: impl Fn(&mut Runner) -> Done + 'static) -> Case {
    Case {
        what: what.to_owned(),
        may_reset: true,
        steps: Box::new(steps),
    }
}

/// What befalls a sensor's wires, and what it says of itself.
#[derive(Clone, Copy)]
pub(super) enum Trouble {
    Mlx(Option<WireFault>, Faults),
    Tmag(Option<LineFault>, StatusFaults),
}

impl Trouble {
    /// What there is when there is nothing.
    pub(super) const fn over(self) -> Self {
        match self {
            Self::Mlx(..) => Self::Mlx(None, Faults::NONE),
            Self::Tmag(..) => Self::Tmag(None, StatusFaults::NONE),
        }
    }

    fn befall(self, session: &mut Session, side: usize) -> bool {
        match self {
            Self::Mlx(wire, word) => session.run.slave_mut(side).map(|slave| {
                slave.set_fault(wire);
                slave.set_error_word(word);
            }),
            Self::Tmag(line, report) => session.run.tmag_mut(side).map(|slave| {
                slave.set_fault(line);
                slave.set_report(report);
            }),
        }
        .is_some()
    }
}

pub(super) struct Runner {
    pub(super) session: Session,
    log: Vec<String>,
    /// What is worth being shown.
    said: Vec<String>,
}

/// Runs a case on a board before its first tick. Returns what was seen.
pub(super) fn run(mut session: Session, case: &Case) -> Result<Vec<String>, Error> {
    session.board_mut().bears_resets = case.may_reset;
    let (log, said) = (Vec::new(), Vec::new());
    let mut runner = Runner { session, log, said };
    let done = (case.steps)(&mut runner);
    done.map_err(|error| Error::Work(format!("{}: {error}", case.what)))?;
    Ok(runner.said)
}

impl Runner {
    /// So much of the scene passes, ms.
    pub(super) fn pass(&mut self, ms: u32) -> Done {
        (0..self.ticks(ms)).try_for_each(|_| self.tick())
    }

    /// The same, in which every motor is driven in half of the ticks.
    pub(super) fn whisk(&mut self, ms: u32) -> Done {
        self.moves(ms, &[])
    }

    /// The same, in which every motor is off.
    pub(super) fn rest(&mut self, ms: u32) -> Done {
        let all: Vec<usize> = (0..self.session.sides).collect();
        self.moves(ms, &all)
    }

    /// The same, in which nothing is decided on the sides that are `off` and their motors are off in
    /// every tick; the others are driven in [`DRIVEN`] of them, all at once.
    pub(super) fn moves(&mut self, ms: u32, off: &[usize]) -> Done {
        let ticks = self.ticks(ms);
        let before = self.session.run.row().angle_deg;
        let mut driven = 0;
        for tick in 0..ticks {
            self.tick()?;
            let mut events = self.session.run.events().iter();
            let is_off = |event: &Event| matches!(event, Event::Decision(place, _) if off.contains(&place.side.into()));
            if events.any(is_off) {
                return wrong(format!("decided in tick {tick} with the motor off"));
            }
            let mut are_driven = true;
            for (side, effort) in self.session.efforts().into_iter().enumerate() {
                let is_driven = effort > 0.0;
                if off.contains(&side) && is_driven {
                    let name = SIDE_NAMES[side];
                    return wrong(format!("the {name} motor is driven in tick {tick}"));
                }
                are_driven &= is_driven || off.contains(&side);
            }
            driven += u32::from(are_driven);
        }
        if f64::from(driven) < DRIVEN * f64::from(ticks) {
            return wrong(format!("driven in {driven} of {ticks} ticks"));
        }
        let after = self.session.run.row().angle_deg;
        let ran_on = |side: &&usize| (after[**side] - before[**side]).abs() > RUN_ON_DEG;
        match off.iter().find(ran_on) {
            Some(side) => wrong(format!("moved from {} to {}", before[*side], after[*side])),
            None => Ok(()),
        }
    }

    /// Time passes on the chip alone, at whose end no motor is driven.
    pub(super) fn stand(&mut self, time: Ps) -> Done {
        self.session.board_mut().wait(time)?;
        self.read_log();
        if self.session.drives() {
            return wrong("a motor is driven");
        }
        Ok(())
    }

    /// A tick that does not end within this time, and drives no motor after it.
    pub(super) fn hang(&mut self, time: Ps) -> Done {
        if self.session.board_mut().run_for(time)? || self.session.drives() {
            return wrong("the tick ends, or a motor is driven");
        }
        Ok(())
    }

    /// The scene goes on until every motor is driven, and then into the next tick, or not.
    pub(super) fn until_driven(&mut self, in_tick: bool) -> Done {
        self.tick()?;
        for _ in 0..self.session.tick_hz {
            if self.session.drives_all() {
                break;
            }
            self.tick()?;
        }
        let until = self.session.machine().now + self.session.period();
        while in_tick && !self.session.machine().is_in_tick() && self.session.machine().now < until
        {
            self.session.board_mut().wait(LOOK)?;
        }
        if self.session.machine().is_in_tick() != in_tick || !self.session.drives_all() {
            return wrong("no such tick");
        }
        Ok(())
    }

    /// Befalls the core in the middle of the next tick.
    pub(super) fn upset(&mut self, upset: Upset) {
        self.session.machine().planned.plan(MIDDLE, upset);
    }

    pub(super) fn press(&mut self, ms: u32) -> Done {
        for (is_down, ms) in [(false, 50), (true, ms), (false, 50)] {
            self.session.machine().chip().set_button(is_down);
            self.pass(ms)?;
        }
        Ok(())
    }

    pub(super) fn reset(&mut self, cause: ResetCause) -> Done {
        Ok(self.session.board_mut().reset_now(cause)?)
    }

    pub(super) fn supply(&mut self, mv: u32) -> Done {
        Ok(self.session.machine().set_supply(mv).map(drop)?)
    }

    pub(super) fn sensors(&mut self, sides: &[usize], trouble: Trouble) -> Done {
        let mut sides = sides.iter();
        if !sides.all(|side| trouble.befall(&mut self.session, *side)) {
            return wrong("the scene has no such sensor");
        }
        Ok(())
    }

    pub(super) fn is_so(
        &mut self,
        what: &str,
        is_so: impl Fn(&mut Session) -> Result<bool, Fault>,
    ) -> Done {
        self.within(0, what, is_so)
    }

    /// So it is now, or becomes within this time.
    pub(super) fn within(
        &mut self,
        most: Ps,
        what: &str,
        is_so: impl Fn(&mut Session) -> Result<bool, Fault>,
    ) -> Done {
        let begun = self.session.machine().now;
        while !is_so(&mut self.session)? {
            if self.session.machine().now - begun >= most {
                return wrong(format!("not so within {} us: {what}", most / US));
            }
            self.session.board_mut().wait(LOOK)?;
        }
        let us = (self.session.machine().now - begun).div_ceil(US);
        self.said.push(format!("{what}: within {us} us"));
        Ok(())
    }

    /// The first line of health: the longest tick, us, and ticks missed.
    pub(super) fn health(&mut self, us: &Range<f64>, missed: u32) -> Done {
        let line = self.line(" health ")?;
        let mut fields = line.split(' ').skip_while(|field| *field != "health");
        let mut number = || fields.nth(1).and_then(|field| field.parse::<f64>().ok());
        let is_right =
            number().is_some_and(|worst| us.contains(&worst)) && number() == Some(missed.into());
        if !is_right {
            return wrong(format!("not {us:?} us and {missed} missed: {line}"));
        }
        self.said.push(line);
        Ok(())
    }

    pub(super) fn has_no_contact(&self, sides: &[usize]) -> Done {
        let contact = self.session.run.row().contact;
        match sides.iter().find(|side| contact[**side] != 0.0) {
            Some(side) => wrong(format!("the {} still has contact", SIDE_NAMES[*side])),
            None => Ok(()),
        }
    }

    pub(super) fn says(&mut self, text: &str) -> Done {
        let line = self.line(text)?;
        self.said.push(line);
        Ok(())
    }

    pub(super) fn says_times(&self, times: usize, text: &str) -> Done {
        let found = self.log.iter().filter(|line| line.contains(text)).count();
        if found != times {
            return wrong(self.not_said(&format!("{times} times {text}")));
        }
        Ok(())
    }

    /// The log has been read up to here.
    pub(super) fn forget(&mut self) {
        self.log.clear();
    }

    const fn ticks(&self, ms: u32) -> u32 {
        ms * self.session.tick_hz / 1_000
    }

    fn tick(&mut self) -> Done {
        self.session.tick()?;
        self.read_log();
        Ok(())
    }

    fn read_log(&mut self) {
        self.log.extend(self.session.log());
    }

    fn line(&self, text: &str) -> Result<String, Error> {
        let line = self.log.iter().find(|line| line.contains(text)).cloned();
        line.ok_or_else(|| Error::Work(self.not_said(text)))
    }

    fn not_said(&self, text: &str) -> String {
        let log = self.log.join("\n  ");
        format!("the log does not say \"{text}\":\n  {log}")
    }
}
