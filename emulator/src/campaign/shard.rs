//! The runs of a shard, one after the other, and one run by itself.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::PathBuf;

use host_sim::Error;

use super::draw::Plan;
use super::outcome::RunRow;
use super::prepared::Prepared;

/// Of the numbers from `first` on, up to `end`, those that leave `remainder` on division by
/// `shards`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shard {
    pub(super) first: u64,
    pub(super) end: u64,
    pub(super) remainder: u64,
    pub(super) shards: u64,
}

/// Where scenes run: a scene's file and, on a board, the program that was built for it.
pub(super) type Scenes = Vec<(PathBuf, Option<PathBuf>)>;

/// Runs what is left of a shard on `subject`; `done` are the numbers of those that were run
/// before, and every other row goes to `take` as soon as it is there.
pub(super) fn run(
    subject: &str,
    scenes: &Scenes,
    plan: Plan,
    shard: Shard,
    done: &[u64],
    mut take: impl FnMut(RunRow) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut prepared: BTreeMap<usize, Prepared> = BTreeMap::new();
    for number in shard.first..shard.end {
        if number % shard.shards != shard.remainder || done.contains(&number) {
            continue;
        }
        let scene = prepare(scenes, number, &mut prepared)?;
        if plan == Plan::Words && number >= scene.words() {
            break;
        }
        take(scene.run(subject, number, plan)?)?;
    }
    Ok(())
}

/// The scene of a run: all in turn, whatever the number of shards.
fn prepare<'s>(
    scenes: &Scenes,
    number: u64,
    prepared: &'s mut BTreeMap<usize, Prepared>,
) -> Result<&'s Prepared, Error> {
    let n = (number % scenes.len().max(1) as u64) as usize;
    let (scene, program) = scenes
        .get(n)
        .ok_or_else(|| Error::Input("no scene to run".to_owned()))?;
    Ok(match prepared.entry(n) {
        Entry::Occupied(prepared) => prepared.into_mut(),
        Entry::Vacant(place) => place.insert(Prepared::new(scene, program.as_deref())?),
    })
}
