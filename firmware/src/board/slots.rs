//! The flash of scenes and models: two slots, of which the newest valid one counts
//! (`firmware::boards`). A program may bring a first scene with it, in the first
//! (`config::linked`).

use firmware::boards::{self, Region, Slot, SlotHeader, has_armed};
use firmware::{ConfigError, HEADER_BYTES, NotArmed, Part};
use wire::Load;

use crate::here::FACTS;
use crate::here::flash::Writer;

pub(crate) const SLOTS: [Slot; 2] = FACTS.flash.slots;

/// The most that a slot has room for; models, where the image has a use for them.
pub(crate) const ROOM: Load = {
    let slot = SLOTS[0];
    Load {
        config: slot.config().words() as u16,
        model: if Part::Classifier.is_built() {
            slot.model.words() as u16
        } else {
            0
        },
    }
};

/// By pairs the flash of some boards is written: whoever sends fills up with zeros.
pub(crate) const fn is_paired(load: Load) -> bool {
    load.config.is_multiple_of(2) && load.model.is_multiple_of(2)
}

/// What lies in a region of flash. A debugger writes it while the core is halted, and resets the
/// chip; or the loader does, once nothing reads it any more.
fn contents(region: Region) -> &'static [u8] {
    let start = core::ptr::with_exposed_provenance::<u8>(region.start as usize);
    #[allow(unsafe_code, reason = "flash beside the program is no variable")]
    // SAFETY: a region of the board's flash, of which a test says that the memory map has it
    // beside the program's; it is there for ever. The loader writes it, which has the chip for
    // itself and ends with a reset, and a start the mark of a slot, of which no slice is in use
    // then: so never while this slice is read.
    unsafe {
        core::slice::from_raw_parts(start, region.bytes as usize)
    }
}

pub(crate) fn header(slot: &Slot) -> Option<SlotHeader> {
    SlotHeader::of(contents(slot.head))
}

pub(crate) fn headers() -> [Option<SlotHeader>; 2] {
    SLOTS.each_ref().map(header)
}

/// In how many slots a start looks for its scene: where nothing is deployed, in the first alone, in
/// which lies what is linked.
const SEARCHED: usize = if Part::TAKES_CONFIGURATIONS {
    SLOTS.len()
} else {
    1
};

pub(crate) fn newest_first() -> impl Iterator<Item = usize> {
    let order = if Part::TAKES_CONFIGURATIONS {
        boards::newest_first(headers())
    } else {
        [0, 1]
    };
    order.into_iter().take(SEARCHED)
}

pub(crate) fn config(slot: &Slot) -> &'static [u8] {
    contents(slot.config())
}

pub(crate) fn no_header(slot: &Slot) -> ConfigError {
    let is_erased = |bytes: &[u8]| bytes.iter().all(|byte| *byte == u8::MAX);
    match contents(slot.head).get(..HEADER_BYTES) {
        Some(first) if !is_erased(first) => ConfigError::Strange,
        _ => ConfigError::Absent,
    }
}

pub(crate) fn model(slot: &Slot) -> &'static [u8] {
    contents(slot.model)
}

/// Notes in the flash of a slot that its scene arms motors by itself, before it does, or that
/// somebody has stopped them: a loss of power leaves RAM without what it knew of a stop, and a
/// whisker where it is not at rest.
///
/// # Errors
/// It was noted before, or flash does not take the note.
#[cold]
#[inline(never)]
pub(crate) fn arm_once(slot: usize) -> Result<(), NotArmed> {
    let slot = SLOTS.get(slot).ok_or(NotArmed::Before)?;
    if has_armed(contents(slot.head)) {
        return Err(NotArmed::Before);
    }
    let mark = slot.mark();
    let mut writer = Writer::new();
    let is_noted = (mark.start..mark.end())
        .step_by(4)
        .all(|at| writer.write(at as usize, 0));
    writer.close();
    is_noted.then_some(()).ok_or(NotArmed::Before)
}
