//! From contact on one side to the excitation of the other by contact-induced
//! asymmetry (CIA): how long does the board take?
//!
//! - *contact*: the first code of x that is not at rest;
//! - *latch*: the first clock of a frame, when the sensor takes what it will answer with;
//! - *excitation*: the other side's g above what it was before.
//!
//! A tick uses the frames that were begun in the tick before it. So contact that has been
//! latched excites in the next tick, whichever side it is on. Contact that comes just
//! after a latch waits a tick more, which is the world's and not the board's.

use std::fmt;
use std::path::Path;

use host_sim::Error;
use host_sim::trace::Row;
use mlx90333::Word;
use scene::Scene;

use crate::chip::{Ps, SIDE_NAMES};
use crate::deployment::flashed;
use crate::emulate::start;
use crate::program::Program;

/// The ticks from a latch to the excitation that it brings.
pub const EXPECTED: u64 = 1;

/// How long contact on one side took to excite the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Latency {
    /// 0 left, 1 right: where the contact was.
    from: usize,
    /// The tick in which the sensor latched it, counted from 1.
    latched: u64,
    /// Ticks from there to that of the excitation.
    pub ticks: u64,
    /// From the latch to the end of that tick.
    time: Ps,
}

impl fmt::Display for Latency {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            from,
            latched,
            ticks,
            time,
        } = self;
        let (from, to) = (SIDE_NAMES[*from], SIDE_NAMES[1 - from]);
        let us = *time as f64 / 1e6;
        write!(
            f,
            "contact {from}, latched in tick {latched}, excites the {to} after {ticks} tick, {us:.1} us"
        )
    }
}

/// Runs the scene in `path`, which has two sides, CIA and an obstacle a side, until
/// contact has excited the other side; then again with the obstacles exchanged.
///
/// # Errors
/// [`Error::Work`] if the scene is no such one, both sides touch at once, nothing touches
/// or nothing is excited, or a tick goes wrong.
pub fn measure(path: &Path, program: &Path) -> Result<[Latency; 2], Error> {
    let (loaded, program) = flashed(path, program)?;
    let mut scene = loaded.scene;
    let first = once(&scene, &program)?;
    if let Some(obstacle) = &mut scene.plant.obstacle {
        obstacle.obstacle_deg.reverse();
    }
    let second = once(&scene, &program)?;
    if first.from == second.from {
        let what = "the same side touches first with the obstacles exchanged";
        return Err(Error::Work(what.to_owned()));
    }
    Ok([first, second])
}

fn once(scene: &Scene, program: &Program) -> Result<Latency, Error> {
    let wrong = |what: &str| Error::Work(format!("latency: {what}"));
    if scene.head.sides.count() < 2 || scene.cia.is_none() {
        return Err(wrong("the scene has no CIA between two sides"));
    }
    let mut run = start(scene, Vec::new(), program)?;
    let mut before = *run.row();
    let mut contact: Option<(Contact, Ps)> = None;
    for n in 1..=run.ticks() {
        let row = run.tick();
        let emulated = run.module_mut();
        emulated.check()?;
        let board = &emulated.board;
        if contact.is_none() {
            let found = Contact::of(&row, &before).map_err(wrong)?;
            // Its frame was begun in the tick before this one.
            contact = found.map(|found| (found, board.latched(found.side)));
            if contact.is_some() && n == 1 {
                return Err(wrong("there is contact from the start"));
            }
        }
        if let Some((found, latch)) = &mut contact {
            if found.excites(&row) {
                return Ok(Latency {
                    from: found.side,
                    latched: n - 1 - found.waited,
                    ticks: 1 + found.waited,
                    time: board.machine.now - *latch,
                });
            }
            found.waited += 1;
        }
        before = row;
    }
    Err(wrong("no contact excites the other side"))
}

/// The first contact.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Contact {
    side: usize,
    /// g of the other side before it.
    gain: f64,
    /// Ticks since the one that used it.
    waited: u64,
}

impl Contact {
    /// The contact in `row`, whose forerunner is `before`.
    fn of(row: &Row, before: &Row) -> Result<Option<Self>, &'static str> {
        let rest = f64::from(Word::MID.code14());
        let touches = row.x.map(|x| x != rest);
        let side = match touches {
            [false, false] => return Ok(None),
            [true, true] => return Err("both sides touch at once"),
            [left, _] => usize::from(!left),
        };
        Ok(Some(Self {
            side,
            gain: before.g[1 - side],
            waited: 0,
        }))
    }

    /// Whether g of the other side has risen.
    fn excites(&self, row: &Row) -> bool {
        row.g[1 - self.side] > self.gain
    }
}

#[cfg(test)]
mod tests {
    use super::{Contact, Row};

    const REST: f64 = 8192.0;

    fn row(x: [f64; 2], g: [f64; 2]) -> Row {
        Row {
            x,
            g,
            ..Row::default()
        }
    }

    #[test]
    fn contact_is_the_first_code_off_rest_and_excites_the_other_side() {
        let before = row([REST, REST], [1.0, 0.5]);
        assert_eq!(Contact::of(&before, &before), Ok(None));
        let touch = row([REST, REST - 1.0], [1.25, 0.5]);
        let contact = Contact::of(&touch, &before).unwrap().unwrap();
        assert_eq!((contact.side, contact.gain), (1, 1.0));
        assert!(contact.excites(&touch));
        let own = row([REST, REST - 1.0], [1.0, 0.75]);
        assert!(!contact.excites(&own), "its own side's g does not count");
        let left = Contact::of(&row([REST + 3.0, REST], [1.0, 0.5]), &before);
        assert_eq!(left.unwrap().unwrap().gain, 0.5);
        assert!(Contact::of(&row([0.0, 0.0], [1.0, 0.5]), &before).is_err());
    }
}
