//! That no panic can be reached, shown from the binary: from the interrupts of the tick
//! and of the sensors' frames, from the reset, and so from idle, and from the handlers of
//! faults there is no way to one, through calls or through code that stands inside other
//! functions, and none through a pointer.
//!
//! Beside it, that no program sleeps but where it wakes well.
//!
//! The control: the same walk finds panics in the tick of a program that is built with checks
//! of overflow.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::elf::calls::Calls;
use crate::elf::contents;
use crate::firmware::{self, Board};
use crate::run::{Fault, listing, no_faults, top};

/// Where every panic goes.
const PANICS: [&str; 2] = ["core::panicking::", "rust_begin_unwind"];

/// Ends that are meant: motor off, a last line, reset. An interrupt has none.
const MEANT: &str = "board::faults::";

/// What stops the program if `main` returns, which it cannot.
const START: &str = "Reset";

const CONTROL: &str = "scenes/full.toml";

/// Checks the scenes, or every one, on `board`, or on every one, and sees that a panic
/// would be found.
pub(crate) fn all(board: Option<Board>, scenes: &[PathBuf]) -> Result<(), Fault> {
    let every = listing(&top().join("scenes"), "toml")?;
    let scenes = if scenes.is_empty() { &every } else { scenes };
    for board in board.map_or(Board::ALL.to_vec(), |board| vec![board]) {
        for scene in scenes {
            let name = scene.file_stem().unwrap_or_default().display();
            let place = format!("{name}, {}", board.name);
            match firmware::try_build(board, scene)? {
                Ok(elf) => {
                    let proven = check(&elf).map_err(|fault| format!("{place}: {fault}"))?;
                    println!("{place}: no way to a panic in {proven}");
                }
                Err(reason) => println!("{place}: {reason}"),
            }
        }
        control(board)?;
    }
    Ok(())
}

/// `wfi` and `isb`, as they stand in flash.
const SLEEP: [u8; 6] = [0x30, 0xBF, 0xBF, 0xF3, 0x6F, 0x8F];

/// That a program sleeps at one place, where a core that wakes fetches its code again: what
/// cortex-m offers does not.
fn sleeps_well(elf: &Path) -> Result<(), Fault> {
    let sleeps = contents::occurrences(elf, &SLEEP)?;
    let functions = contents::functions(elf)?;
    let sleeps_else = functions.contains("cortex_m::asm::wfi");
    if sleeps == 1 && !sleeps_else {
        return Ok(());
    }
    Err(format!(
        "it sleeps at {sleeps} places with a barrier; at others too: {sleeps_else}"
    ))
}

/// Gives what has been walked over.
pub(crate) fn check(elf: &Path) -> Result<String, Fault> {
    sleeps_well(elf)?;
    let program = Program::of(elf)?;
    let tasks = program.calls.tasks()?;
    let tick = program.walk(&tasks)?;
    let mut wrong = tick.ends;
    wrong.extend(tick.meant);
    let idle = program.walk(&[program.calls.reset()?])?;
    wrong.extend(idle.ends);
    let handlers = program.walk(&program.calls.named(MEANT))?;
    wrong.extend(handlers.ends);
    no_faults(&wrong)?;
    Ok(format!(
        "{} functions of {} interrupts, {} of start and idle, {} of handlers of faults",
        tick.functions,
        tasks.len(),
        idle.functions,
        handlers.functions
    ))
}

/// Builds [`CONTROL`] with checks of overflow and sees panics found in its interrupts.
pub(crate) fn control(board: Board) -> Result<(), Fault> {
    let elf = firmware::build_checked(board, Path::new(CONTROL))?;
    let program = Program::of(&elf)?;
    let ways = program.walk(&program.calls.tasks()?)?.ends;
    let [first, more @ ..] = ways.as_slice() else {
        return Err(format!("control, {}: no panic is found", board.name));
    };
    let more = more.len();
    println!("control, {}: {first} is found, and {more} more", board.name);
    Ok(())
}

struct Program {
    calls: Calls,
    /// Addresses of panics that stand inside its functions.
    inlined: Vec<u64>,
}

#[derive(Default)]
struct Walk {
    functions: usize,
    /// Each panic, abort and call through a pointer, with the way to it.
    ends: Vec<String>,
    /// The same for [`MEANT`].
    meant: Vec<String>,
}

fn is_panic(name: &str) -> bool {
    PANICS.iter().any(|panic| name.contains(panic))
}

impl Program {
    fn of(elf: &Path) -> Result<Self, Fault> {
        Ok(Self {
            calls: Calls::of(elf)?,
            inlined: contents::inlined(elf, is_panic)?,
        })
    }

    fn walk(&self, from: &[u64]) -> Result<Walk, Fault> {
        let mut walk = Walk::default();
        // Each function that was reached, and from where.
        let mut reached: BTreeMap<u64, Option<u64>> = BTreeMap::new();
        let mut open: Vec<(u64, Option<u64>)> = from.iter().map(|begin| (*begin, None)).collect();
        while let Some((begin, caller)) = open.pop() {
            if reached.contains_key(&begin) {
                continue;
            }
            reached.insert(begin, caller);
            let function = self.calls.at(begin)?;
            let way = || self.way(&reached, begin);
            if is_panic(&function.name) {
                walk.ends.push(way());
                // Another caller's way to it must be seen, too.
                reached.remove(&begin);
                continue;
            }
            if function.name.contains(MEANT) && caller.is_some() {
                walk.meant.push(way());
                continue;
            }
            walk.functions += 1;
            let is_inside = |address| function.range.contains(address);
            if self.inlined.iter().any(is_inside) {
                walk.ends.push(way() + " → a panic inside");
            }
            if function.is_open {
                walk.ends.push(way() + " → a pointer");
            }
            if function.traps && function.name != START {
                walk.ends.push(way() + " → an abort");
            }
            open.extend(function.calls.iter().map(|call| (*call, Some(begin))));
        }
        Ok(walk)
    }

    fn way(&self, reached: &BTreeMap<u64, Option<u64>>, begin: u64) -> String {
        let back = std::iter::successors(Some(begin), |at| reached.get(at).copied().flatten());
        let name = |at: u64| self.calls.at(at).map_or("?", |function| &function.name);
        let mut names: Vec<&str> = back.map(name).collect();
        names.reverse();
        names.join(" → ")
    }
}

#[cfg(test)]
mod tests {
    use super::{Program, Walk};
    use crate::elf::calls::{Calls, Function};

    fn function(name: &str, begin: u64, calls: &[u64]) -> Function {
        Function {
            name: name.to_owned(),
            range: begin..begin + 16,
            own: 0,
            calls: calls.iter().copied().collect(),
            is_open: false,
            traps: false,
        }
    }

    fn walk(functions: impl IntoIterator<Item = Function>, inlined: u64) -> Walk {
        let calls = Calls::among(functions);
        let inlined = vec![inlined];
        Program { calls, inlined }.walk(&[0]).unwrap()
    }

    const NOWHERE: u64 = 800;

    #[test]
    fn every_way_to_a_panic_is_told() {
        let panic = || function("core::panicking::panic_fmt", 64, &[]);
        let (a, b) = (function("a", 16, &[64]), function("b", 32, &[16, 64]));
        let found = walk([function("tick", 0, &[16, 32]), a, b, panic()], NOWHERE);
        let mut ends = found.ends;
        ends.sort();
        let [of_a, of_b] = ends.as_slice() else {
            panic!("{ends:?}");
        };
        assert!(of_a.ends_with("a → core::panicking::panic_fmt"), "{of_a}");
        assert_eq!(of_b, "tick → b → core::panicking::panic_fmt");
        assert_eq!(found.functions, 3);
        // A circle ends, and what is never called does not count.
        let (a, b) = (function("a", 16, &[32]), function("b", 32, &[16]));
        let found = walk([function("tick", 0, &[16]), a, b, panic()], NOWHERE);
        assert_eq!((found.ends.len(), found.functions), (0, 3));
    }

    #[test]
    fn pointers_aborts_and_inlined_panics_are_told() {
        let mut tick = function("tick", 0, &[]);
        (tick.is_open, tick.traps) = (true, true);
        let found = walk([tick], 12);
        let all = ["a panic inside", "a pointer", "an abort"];
        assert_eq!(found.ends, all.map(|end| format!("tick → {end}")));
    }

    #[test]
    fn meant_ends_are_told_apart() {
        let panic = function("core::panicking::panic_fmt", 64, &[]);
        let die = function("board::faults::die", 32, &[64]);
        let found = walk([function("idle", 0, &[32]), die, panic], NOWHERE);
        assert_eq!(found.ends, [""; 0]);
        assert_eq!(found.meant, ["idle → board::faults::die"]);
    }
}
