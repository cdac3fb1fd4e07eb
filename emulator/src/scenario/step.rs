//! What is done to a board in trouble, for how long it runs, and what is expected of it.

use std::ops::Range;

use firmware::Event;
use host_sim::Error;
use host_sim::bus::WireFault;
use host_sim::bus::tmag5170::LineFault;
use mlx90333::Faults;
use tmag5170::StatusFaults;

use crate::chip::{Fault, Ps, SIDE_NAMES};
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

pub(super) enum Step {
    /// So much of the scene passes, ms.
    Pass(u32),
    /// The same, in which nothing is decided on these sides and their motors are off in every
    /// tick; the others are driven in [`DRIVEN`] of them, all at once.
    Move { ms: u32, off: Vec<usize> },
    /// Time passes on the chip alone, at whose end no motor is driven.
    Stand(Ps),
    /// A tick that does not end within this time, and drives no motor after it.
    Hang(Ps),
    /// The scene goes on until every motor is driven, and then into the next tick, or not.
    UntilDriven { in_tick: bool },

    /// The core is held in the middle of the next tick, or something else befalls it there.
    Upset(Upset),
    /// The user button is held down so long, ms.
    Press(u32),
    /// Something is done to the board from outside.
    Do(fn(&mut Session) -> Result<(), Fault>),
    /// The supply changes, mV.
    Supply(u32),
    /// A bit of memory is inverted.
    Flip { address: u32, bit: u32 },
    /// This befalls these sides' sensors.
    Sensors(Vec<usize>, Trouble),

    /// So it is now, or becomes within this time.
    Within(Ps, &'static str, fn(&mut Session) -> Result<bool, Fault>),
    /// The first line of health: the longest tick, us, and ticks missed.
    Health { us: Range<f64>, missed: u32 },
    /// There is no contact on these sides.
    NoContact(Vec<usize>),
    /// The log has lines with this text.
    Says(String),
    /// The log has so many lines with this text.
    SaysTimes(usize, String),
    /// The log has been read up to here.
    Forget,
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

pub(super) struct Case {
    pub(super) what: String,
    /// Whether a reset is no fault.
    pub(super) may_reset: bool,
    pub(super) steps: Vec<Step>,
}

pub(super) fn says(text: impl Into<String>) -> Step {
    Step::Says(text.into())
}

/// Every motor is driven in half of the ticks.
pub(super) const fn whisk(ms: u32) -> Step {
    let off = Vec::new();
    Step::Move { ms, off }
}

struct Runner {
    session: Session,
    log: Vec<String>,
    /// What is worth being shown.
    said: Vec<String>,
}

/// Runs a case on a board before its first tick. Returns what was seen.
pub(super) fn run(mut session: Session, case: &Case) -> Result<Vec<String>, Error> {
    session.board_mut().bears_resets = case.may_reset;
    let (log, said) = (Vec::new(), Vec::new());
    let mut runner = Runner { session, log, said };
    for step in &case.steps {
        let done = runner.step(step);
        done.map_err(|error| Error::Work(format!("{}: {error}", case.what)))?;
    }
    Ok(runner.said)
}

impl Runner {
    fn step(&mut self, step: &Step) -> Result<(), Error> {
        let session = &mut self.session;
        match step {
            Step::Pass(ms) => return self.pass(self.ticks(*ms)),
            Step::Move { ms, off } => return self.moves(self.ticks(*ms), off),
            Step::Stand(time) => return self.stand(*time),
            Step::Hang(time) => {
                if session.board_mut().run_for(*time)? || session.drives() {
                    return wrong("the tick ends, or a motor is driven");
                }
            }
            Step::UntilDriven { in_tick } => return self.until_driven(*in_tick),
            Step::Upset(upset) => session.machine().upset_next_tick(MIDDLE, *upset),
            Step::Press(ms) => return self.press(*ms),
            Step::Do(act) => act(session)?,
            Step::Supply(mv) => _ = session.machine().set_supply(*mv)?,
            Step::Flip { address, bit } => {
                session.machine().memories.flip(*address, 1 << bit)?;
            }
            Step::Sensors(sides, trouble) => {
                if !sides.iter().all(|side| trouble.befall(session, *side)) {
                    return wrong("the scene has no such sensor");
                }
            }
            Step::Within(time, what, is_so) => return self.within(*time, what, *is_so),
            Step::Health { us, missed } => return self.health(us, *missed),
            Step::NoContact(sides) => {
                let contact = session.run.row().contact;
                if let Some(side) = sides.iter().find(|side| contact[**side] != 0.0) {
                    return wrong(format!("the {} still has contact", SIDE_NAMES[*side]));
                }
            }
            Step::Says(text) => return self.line(text).map(|line| self.said.push(line)),
            Step::SaysTimes(times, text) => {
                let found = self.log.iter().filter(|line| line.contains(text)).count();
                if found != *times {
                    return wrong(self.not_said(&format!("{times} times {text}")));
                }
            }
            Step::Forget => self.log.clear(),
        }
        Ok(())
    }

    const fn ticks(&self, ms: u32) -> u32 {
        ms * self.session.tick_hz / 1_000
    }

    fn read_log(&mut self) {
        self.log.extend(self.session.log());
    }

    fn pass(&mut self, ticks: u32) -> Result<(), Error> {
        for _ in 0..ticks {
            self.session.tick()?;
            self.read_log();
        }
        Ok(())
    }

    fn moves(&mut self, ticks: u32, off: &[usize]) -> Result<(), Error> {
        let before = self.session.run.row().angle_deg;
        let mut driven = 0;
        for tick in 0..ticks {
            self.pass(1)?;
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

    fn stand(&mut self, time: Ps) -> Result<(), Error> {
        self.session.board_mut().wait(time)?;
        self.read_log();
        if self.session.drives() {
            return wrong("a motor is driven");
        }
        Ok(())
    }

    fn until_driven(&mut self, in_tick: bool) -> Result<(), Error> {
        self.pass(1)?;
        for _ in 0..self.session.tick_hz {
            if self.session.drives_all() {
                break;
            }
            self.pass(1)?;
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

    fn press(&mut self, ms: u32) -> Result<(), Error> {
        for (is_down, ms) in [(false, 50), (true, ms), (false, 50)] {
            self.session.machine().chip().set_button(is_down);
            self.pass(self.ticks(ms))?;
        }
        Ok(())
    }

    fn within(
        &mut self,
        most: Ps,
        what: &str,
        is_so: fn(&mut Session) -> Result<bool, Fault>,
    ) -> Result<(), Error> {
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

    fn line(&self, text: &str) -> Result<String, Error> {
        let line = self.log.iter().find(|line| line.contains(text)).cloned();
        line.ok_or_else(|| Error::Work(self.not_said(text)))
    }

    fn not_said(&self, text: &str) -> String {
        format!(
            "the log does not say \"{text}\":\n  {}",
            self.log.join("\n  ")
        )
    }

    fn health(&mut self, us: &Range<f64>, missed: u32) -> Result<(), Error> {
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
}
