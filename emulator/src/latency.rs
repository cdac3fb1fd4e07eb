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

use std::path::Path;

use host_sim::Error;
use host_sim::trace::Row;
use mlx90333::Word;
use scene::Scene;

use crate::chip::SIDE_NAMES;
use crate::deployment::flashed;
use crate::program::Program;
use crate::session::Session;
use crate::talk::wrong;

/// How long contact on one side takes to excite the other, and the same with obstacles exchanged.
pub(crate) fn measure(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (loaded, program) = flashed(path, program)?;
    let mut scene = loaded.scene;
    if scene.head.sides.count() < 2 || scene.cia.is_none() {
        return wrong("the scene has no CIA between two sides");
    }
    let (first, said) = once(&scene, &program)?;
    if let Some(obstacle) = &mut scene.plant.obstacle {
        obstacle.obstacle_deg.reverse();
    }
    let (second, also) = once(&scene, &program)?;
    if first == second {
        return wrong("the same side touches first with the obstacles exchanged");
    }
    Ok(vec![said, also])
}

/// The side of the first contact, and how long it took.
fn once(scene: &Scene, program: &Program) -> Result<(usize, String), Error> {
    let mut session = Session::running(scene, Vec::new(), program)?;
    let mut before = *session.run.row();
    for n in 1..=session.run.ticks() {
        session.tick()?;
        let row = *session.run.row();
        let Some(side) = touching(&row)? else {
            before = row;
            continue;
        };
        if n == 1 {
            return wrong("there is contact from the start");
        }
        if !excites(side, &before, &row) {
            return wrong("excitation comes in another tick");
        }
        // Its frame was begun in the tick before this one.
        let (latched, now) = (session.board_mut().latched(side), session.machine().now);
        let us = (now - latched) as f64 / 1e6;
        let (own, other, before) = (SIDE_NAMES[side], SIDE_NAMES[1 - side], n - 1);
        let said = format!(
            "contact {own}, latched in tick {before}, excites the {other} after 1 tick, {us:.1} us"
        );
        return Ok((side, said));
    }
    wrong("no contact excites the other side")
}

/// The side that is not at rest.
fn touching(row: &Row) -> Result<Option<usize>, Error> {
    let rest = f64::from(Word::MID.code14());
    match row.x.map(|x| x != rest) {
        [false, false] => Ok(None),
        [true, true] => wrong("both sides touch at once"),
        [left, _] => Ok(Some(usize::from(!left))),
    }
}

/// Whether contact on a side has raised the g of the other.
fn excites(side: usize, before: &Row, row: &Row) -> bool {
    row.g[1 - side] > before.g[1 - side]
}

#[cfg(test)]
mod tests {
    use super::{Row, excites, touching};

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
        assert_eq!(touching(&before).unwrap(), None);
        let touch = row([REST, REST - 1.0], [1.25, 0.5]);
        assert_eq!(touching(&touch).unwrap(), Some(1));
        assert!(excites(1, &before, &touch));
        let own = row([REST, REST - 1.0], [1.0, 0.75]);
        assert!(!excites(1, &before, &own), "its own g does not count");
        let left = row([REST + 3.0, REST], [1.0, 0.5]);
        assert_eq!(touching(&left).unwrap(), Some(0));
        assert!(touching(&row([0.0, 0.0], [1.0, 0.5])).is_err());
    }
}
