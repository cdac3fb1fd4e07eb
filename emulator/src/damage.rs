//! Bits that flip in the settings in RAM and in the model in flash: does the board notice,
//! switch its motors off and say so?

use std::path::Path;

use host_sim::Error;
use host_sim::commands::run::Loaded;

use crate::chip::Ps;
use crate::debug_info::DebugInfo;
use crate::program::Program;
use crate::trouble::Trouble;

/// What is made at the start, and in it the list of one that the settings are.
const PLACE: &str = "__rtic_internal_local_init_place";
const SETTINGS: [&str; 3] = ["settings", "buffer", "buffer"];

/// Words of the settings of which a bit is flipped, evenly spread.
const WORDS: u32 = 4;
/// Ticks after which no motor may be driven: idle looks at 16 words of each in a tick.
const WITHIN: [u32; 2] = [20, 400];
/// The first bytes of a model.
const MODEL: &[u8] = b"WLIK\x02\x00";

/// Flips bits in the settings of the scene in `path`, each after a new start, and, if it has
/// one, in its model. The motors must be off within 20 ticks, with the model within 400, and
/// the log must say fault 55 or 56. Returns these lines.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn damage(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let loaded = Loaded::new(path)?;
    let elf = Program::load(program)?;
    let info = DebugInfo::new(&elf)?;
    let mut settings = info.variable(PLACE)?;
    for name in SETTINGS {
        settings = settings.member(name)?;
    }
    let (size, tick_hz) = (settings.size()?, loaded.scene.tick_hz);
    let mut heard = Vec::new();
    for n in 0..WORDS {
        let address = settings.address + (size - 4) / 4 * n / (WORDS - 1) * 4;
        let mut trouble = whisking(&loaded, program)?;
        trouble
            .board_mut()
            .machine
            .memories
            .flip(address, 1 << (n % 8))?;
        heard.push(must_stop(&mut trouble, tick_hz, WITHIN[0], "fault 55")?);
    }
    let at = elf.segments().find_map(|(address, contents)| {
        let at = contents
            .windows(MODEL.len())
            .position(|bytes| bytes == MODEL)?;
        Some(address + at as u32)
    });
    if let Some(address) = at {
        let mut trouble = whisking(&loaded, program)?;
        // In the row of a table.
        trouble
            .board_mut()
            .machine
            .memories
            .flip(address + 1_024, 1)?;
        heard.push(must_stop(&mut trouble, tick_hz, WITHIN[1], "fault 56")?);
    }
    heard.dedup();
    Ok(heard)
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

/// What the log says of a fault after which no motor is driven within so many ticks.
fn must_stop(
    trouble: &mut Trouble,
    tick_hz: u32,
    ticks: u32,
    fault: &str,
) -> Result<String, Error> {
    let period = 1_000_000_000_000 / Ps::from(tick_hz);
    trouble.board_mut().wait(Ps::from(ticks) * period)?;
    if trouble.driven().contains(&true) {
        return Err(Error::Work(format!("{fault}: a motor is driven")));
    }
    trouble.listen();
    trouble.hear(fault)
}
