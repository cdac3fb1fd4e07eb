//! Makes sure that instructions are counted, and not nearly so.

use crate::machine::{instructions, nops, turns};

/// Counts code of known length.
///
/// # Panics
/// If a count is off, even by one: then no other can be believed.
pub fn all() {
    // The call and the return.
    expect(2, instructions(nops::<0>, 0, &mut ()));
    expect(2 + 1, instructions(nops::<1>, 0, &mut ()));
    expect(2 + 10, instructions(nops::<10>, 0, &mut ()));
    expect(2 + 997, instructions(nops::<997>, 0, &mut ()));
    for n in [1, 2, 3, 10, 1_000, 99_999, 300_000] {
        expect(2 + 2 * n, instructions(turns, n, &mut ()));
    }
}

fn expect(known: u32, counted: u32) {
    assert!(
        known == counted,
        "{known} instructions were counted as {counted}: does the emulator run with -icount shift=10?"
    );
}
