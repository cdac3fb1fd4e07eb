//! Bits that flip in the settings in RAM, in the model in flash, and in what the classifier holds
//! of it in RAM: does the board notice, switch its motors off and say so?

use std::path::Path;

use host_sim::Error;
use host_sim::loaded::Loaded;

use crate::chip::{Fault, Ps};
use crate::debug_info::{DebugInfo, Place};
use crate::program::Program;
use crate::trouble::Trouble;

/// What is made at the start, in lists of one: the settings, and in the perception what no
/// sample changes.
const PLACE: &str = "__rtic_internal_local_init_place";
const SETTINGS: &[&str] = &["settings", "buffer", "buffer"];
const PERCEPTION: &[&str] = &["perception", "buffer", "buffer"];
const CONSTANTS: [&[&str]; 2] = [
    &["classifier", "bayes", "constants"],
    &["classifier", "factors"],
];

/// Words of each of which a bit is flipped, evenly spread.
const WORDS: u32 = 4;
/// Ticks after which no motor may be driven: idle looks at 16 words of each in a tick.
const WITHIN: [u32; 2] = [20, 400];
/// The first bytes of a model.
const MODEL: &[u8] = b"WLIK\x02\x00";

/// Flips bits in the settings of the scene in `path`, each after a new start, and, if it has
/// a classifier, in its model and in what it holds of that. The motors must be off within 20
/// ticks, with the model within 400, and the log must say fault 55 or 56. Returns these lines.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn damage(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let loaded = Loaded::new(path)?;
    let elf = Program::load(program)?;
    let info = DebugInfo::new(&elf)?;
    let place = info.variable(PLACE)?;
    let mut flips = evenly(member(place, SETTINGS)?, WITHIN[0], "fault 55")?;
    if loaded.scene.classifier.is_some() && !loaded.scene.awaits_model() {
        let perception = member(place, PERCEPTION)?.element(0)?;
        for path in CONSTANTS {
            flips.extend(evenly(member(perception, path)?, WITHIN[0], "fault 56")?);
        }
    }
    let model = elf.segments().find_map(|(address, contents)| {
        let at = contents
            .windows(MODEL.len())
            .position(|bytes| bytes == MODEL)?;
        Some(address + at as u32)
    });
    flips.extend(model.map(|address| Flip {
        // In the row of a table.
        address: address + 1_024,
        bit: 0,
        within: WITHIN[1],
        fault: "fault 56",
    }));

    let mut heard = Vec::new();
    for flip in flips {
        let mut trouble = whisking(&loaded, program)?;
        let memories = &mut trouble.board_mut().machine.memories;
        memories.flip(flip.address, 1 << flip.bit)?;
        heard.push(must_stop(&mut trouble, loaded.scene.tick_hz, &flip)?);
    }
    heard.dedup();
    Ok(heard)
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

/// Bits of [`WORDS`] of its words, evenly spread.
fn evenly(of: Place<'_>, within: u32, fault: &'static str) -> Result<Vec<Flip>, Fault> {
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
fn whisking(loaded: &Loaded, program: &Path) -> Result<Trouble, Error> {
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
    trouble.listen();
    trouble.hear(fault)
}
