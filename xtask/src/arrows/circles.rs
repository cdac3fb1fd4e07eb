//! Circles in a graph of files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Arrows from a file to a file, with the names that draw each.
pub(super) type Arrows = BTreeMap<(PathBuf, PathBuf), BTreeSet<String>>;

/// The sets of files from each of which the arrows lead to all others of the set:
/// the strongly connected components of more than one file.
pub(super) fn circles(arrows: &Arrows) -> Vec<BTreeSet<PathBuf>> {
    let mut reached = BTreeMap::<&PathBuf, BTreeSet<&PathBuf>>::new();
    for (from, _) in arrows.keys() {
        if !reached.contains_key(from) {
            let seen = reach(arrows, from);
            reached.insert(from, seen);
        }
    }
    let mut circles = Vec::<BTreeSet<PathBuf>>::new();
    for (file, others) in &reached {
        if !others.contains(file) || circles.iter().any(|circle| circle.contains(*file)) {
            continue;
        }
        let back = |other: &&&PathBuf| reached.get(**other).is_some_and(|r| r.contains(file));
        circles.push(others.iter().filter(back).map(|&p| p.clone()).collect());
    }
    circles
}

/// The files to which arrows lead from `start`, by one or more.
fn reach<'a>(arrows: &'a Arrows, start: &PathBuf) -> BTreeSet<&'a PathBuf> {
    let mut seen = BTreeSet::new();
    let mut open = vec![start];
    while let Some(file) = open.pop() {
        for (_, to) in arrows.keys().filter(|(from, _)| from == file) {
            if seen.insert(to) {
                open.push(to);
            }
        }
    }
    seen
}
