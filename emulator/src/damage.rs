//! Bits that flip in the settings in RAM, in the model in flash, and in what the classifier holds
//! of it in RAM: does the board notice, switch its motors off and say so?

use std::path::Path;

use host_sim::Error;
use host_sim::loaded::Loaded;

use crate::chip::{Fault, Ps};
use crate::debug_info::{DebugInfo, Place};
use crate::deployment::flashed;
use crate::program::Program;
use crate::trouble::Trouble;

/// The settings, and how fast the module ticks by them.
const SETTINGS: [(&str, &[&str]); 2] = [("SETTINGS", &["val"]), ("PACE", &[])];
/// In the module: what the classifier holds that no sample changes.
const MODULE: &str = "INNER";
const CONSTANTS: [&[&str]; 2] = [
    &[
        "perception",
        "classifier",
        "found",
        "classifier",
        "constants",
    ],
    &["perception", "classifier", "found", "factors"],
];

/// Words of each of which a bit is flipped, evenly spread.
const WORDS: u32 = 4;
/// Words of each that idle looks at in a tick.
const LOOKED_AT: u32 = 16;
/// Bytes of the largest model that is damaged here.
const MODEL_BYTES: u32 = 12 * 1024;

/// Flips bits in the settings of the scene in `path`, each after a new start, and, if it has
/// a classifier, in its model and in what it holds of that. The motors must be off once idle has
/// looked at all of it, and the log must say fault 55 or 56. Returns these lines.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn damage(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (loaded, program) = flashed(path, program)?;
    let info = DebugInfo::new(&program)?;
    let mut flips = Vec::new();
    for (name, path) in SETTINGS {
        flips.extend(evenly(
            member(info.variable(name)?, path)?,
            "fault board 55 ",
        )?);
    }
    let classifier = loaded.scene.classifier.as_ref();
    if classifier.is_some_and(|classifier| classifier.model.is_some()) {
        let module = info.variable(MODULE)?;
        for path in CONSTANTS {
            flips.extend(evenly(member(module, path)?, "fault board 56 ")?);
        }
        let [slot, _] = program.model()?.facts.flash.slots;
        flips.push(Flip {
            // In the row of a table.
            address: slot.model.start + 1_024,
            bit: 0,
            within: within(MODEL_BYTES),
            fault: "fault board 56 ",
        });
    }

    let mut lines = Vec::new();
    for flip in flips {
        let mut trouble = whisking(&loaded, &program)?;
        let memories = &mut trouble.board_mut().machine.memories;
        memories.flip(flip.address, 1 << flip.bit)?;
        lines.push(must_stop(&mut trouble, loaded.scene.tick_hz, &flip)?);
    }
    lines.dedup();
    Ok(lines)
}

/// A bit that flips.
struct Flip {
    address: u32,
    bit: u32,
    /// Ticks after which no motor may be driven, and what the log must say.
    within: u32,
    fault: &'static str,
}

/// The part that these names lead to.
fn member<'d>(of: Place<'d>, path: &[&str]) -> Result<Place<'d>, Fault> {
    path.iter().try_fold(of, |place, name| place.member(name))
}

/// Ticks after which every word of so many bytes was looked at: that of a walk which had just
/// passed the word, and a whole one; and two in which idle is late.
const fn within(bytes: u32) -> u32 {
    2 * (bytes / 4).div_ceil(LOOKED_AT) + 2
}

/// Bits of [`WORDS`] of its words, evenly spread.
fn evenly(of: Place<'_>, fault: &'static str) -> Result<Vec<Flip>, Fault> {
    let within = within(of.size()?);
    let last = of.size()? / 4 - 1;
    let mut words: Vec<u32> = (0..WORDS).map(|n| last * n / (WORDS - 1)).collect();
    words.dedup();
    let flip = |word| Flip {
        address: of.address + 4 * word,
        bit: word % 8,
        within,
        fault,
    };
    Ok(words.into_iter().map(flip).collect())
}

/// A board that has whisked for a while.
fn whisking(loaded: &Loaded, program: &Program) -> Result<Trouble, Error> {
    let mut trouble = Trouble::new(&loaded.scene, program)?;
    let tick_hz = loaded.scene.tick_hz;
    trouble.pass(tick_hz / 10)?;
    let driven =
        (0..tick_hz / 5).any(|_| trouble.pass(1).is_ok() && trouble.driven().contains(&true));
    if driven || loaded.scene.motor.is_none() {
        return Ok(trouble);
    }
    Err(Error::Work("no motor is driven".to_owned()))
}

/// What the log says of the fault that a flip is, after which no motor may be driven.
fn must_stop(trouble: &mut Trouble, tick_hz: u32, flip: &Flip) -> Result<String, Error> {
    let Flip { within, fault, .. } = *flip;
    let period = 1_000_000_000_000 / Ps::from(tick_hz);
    trouble.board_mut().wait(Ps::from(within) * period)?;
    if trouble.driven().contains(&true) {
        return Err(Error::Work(format!("{fault}: a motor is driven")));
    }
    trouble.take_log();
    trouble.line(fault)
}
