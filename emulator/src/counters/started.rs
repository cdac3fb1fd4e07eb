//! A board whose counters start just below their wraps.

use super::{CNT, COUNTERS, Counter, Place, TIM5, TOUCHES};
use crate::board::Board;
use crate::chip::Fault;
use crate::debug_info::{DebugInfo, Leaf};
use crate::program::Program;
use scene::Scene;

/// A word in which a wrap is to be seen.
struct Seen {
    counter: &'static Counter,
    leaf: Leaf,
    is_beyond: bool,
}

pub(crate) struct Started {
    seen: Vec<Seen>,
    /// Touches that the program takes for reported before the first.
    touches: u32,
}

/// A path without its indices.
pub(crate) fn bare(path: &str) -> String {
    let parts = path.split('[');
    let parts = parts.map(|part| part.split_once(']').map_or(part, |(_, rest)| rest));
    parts.collect()
}

/// Whether a scene has what this path leads to: lists have room for more than there are.
fn is_used(path: &str, scene: &Scene) -> bool {
    let whiskers = scene.whiskers();
    let classifier = scene.classifier.as_ref();
    let heard = classifier.map_or(0, |classifier| classifier.whiskers.heard(whiskers));
    let driven = scene.whisking.as_ref().map_or(0, |_| whiskers);
    let mut lists = [("touches[", heard), ("INNER.whiskers[", driven)].into_iter();
    lists.all(|(list, count)| {
        let rest = path.split_once(list).map(|(_, rest)| rest);
        let index = rest.and_then(|rest| rest.split(']').next());
        index.is_none_or(|index| index.parse().is_ok_and(|index: usize| index < count))
    })
}

fn read(board: &Board, leaf: &Leaf) -> Result<u32, Fault> {
    let mut word = [0; 4];
    let size = word.len().min(leaf.size as usize);
    let memories = &board.machine.memories;
    memories.read(leaf.address, &mut word[..size])?;
    Ok(u32::from_le_bytes(word))
}

fn set_count(board: &Board, timer: u32, count: u32) -> Result<(), Fault> {
    let mut chip = board.machine.chip();
    chip.write(timer + CNT, count, u32::MAX)
}

impl Started {
    /// Starts every counter that `program` has for `scene`, before the first tick of `board`.
    pub(crate) fn new(program: &Program, board: &mut Board, scene: &Scene) -> Result<Self, Fault> {
        let leaves = DebugInfo::new(program)?.leaves()?.into_iter();
        let used = leaves.filter(|leaf| is_used(&leaf.path, scene));
        let named: Vec<(String, Leaf)> = used.map(|leaf| (bare(&leaf.path), leaf)).collect();
        let all = |end: &'static str| {
            let ends = named.iter().filter(move |(path, _)| path.ends_with(end));
            ends.map(|(_, leaf)| leaf.clone())
        };
        let has_variable = all("INNER.clock.now").next().is_some();
        let mut started = Self {
            seen: Vec::new(),
            touches: 0,
        };
        for counter in &COUNTERS {
            let first = counter.first(scene.tick_hz);
            match counter.place {
                Place::Ram(path) => {
                    for leaf in all(path) {
                        let size = leaf.size.min(4) as usize;
                        let bytes = first.to_le_bytes();
                        board.machine.memories.write(leaf.address, &bytes[..size])?;
                    }
                }
                Place::TimerOf(path) => {
                    for leaf in all(path) {
                        let timer = read(board, &leaf)?;
                        set_count(board, timer, first)?;
                    }
                }
                Place::Tim5 if has_variable => {}
                Place::Tim5 => set_count(board, TIM5, first)?,
            }
            let seen = counter.is_seen().then_some(counter.seen);
            for leaf in seen.into_iter().flat_map(all) {
                if counter.what == TOUCHES {
                    started.touches = first;
                }
                started.seen.push(Seen {
                    counter,
                    leaf,
                    is_beyond: false,
                });
            }
        }
        Ok(started)
    }

    pub(crate) fn look(&mut self, board: &Board) -> Result<(), Fault> {
        for seen in self.seen.iter_mut().filter(|seen| !seen.is_beyond) {
            let count = read(board, &seen.leaf)?;
            seen.is_beyond = seen.counter.is_beyond(count);
        }
        Ok(())
    }

    pub(crate) fn wrapped(&self) -> Result<usize, String> {
        let left = self.seen.iter().filter(|seen| !seen.is_beyond);
        let left: Vec<&str> = left.map(|seen| seen.counter.what).collect();
        if left.is_empty() {
            return Ok(self.seen.len());
        }
        Err(format!("not wrapped: {}", left.join(", ")))
    }

    /// The number that the program gives to a touch of this number by a module that has
    /// started at zero; the air stays 0, and after 65535 comes 1.
    pub(crate) fn touch(&self, number: u16) -> u16 {
        let Some(before) = number.checked_sub(1) else {
            return 0;
        };
        let shifted = (u32::from(before) + self.touches) % u32::from(u16::MAX);
        shifted as u16 + 1
    }
}
