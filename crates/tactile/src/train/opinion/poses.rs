//! Which trials were felt in one pose.

use std::vec;
use std::vec::Vec;

use crate::train::joint::Trial;

/// What is one pose: a recording; or, where it says that it has several, one of these.
type Key<'t> = (&'t str, Option<u64>);

/// The number of the pose of each trial, and how many there are.
///
/// Recordings that say in which pose each trial was felt are cut by it. If then no pose has
/// all classes, as where each presentation has a pose of its own, the first poses of the classes
/// are put together, the second ones, and so on.
pub(in crate::train) fn numbers(trials: &[Trial]) -> (Vec<usize>, usize) {
    let by_pose = numbered(trials.iter().map(key_of));
    if is_whole(trials, &by_pose) {
        return counted(by_pose);
    }
    let mut keys: Vec<(Key<'_>, &str)> = Vec::new();
    let mut ranks = Vec::with_capacity(trials.len());
    for trial in trials {
        let of_class = |((recording, _), label): &(Key<'_>, &str)| {
            (*recording, *label) == (trial.recording.as_str(), trial.label.as_str())
        };
        let own = (key_of(trial), trial.label.as_str());
        if !keys.contains(&own) {
            keys.push(own);
        }
        let same = keys.iter().filter(|key| of_class(key));
        let rank = same.clone().position(|key| *key == own).unwrap_or(0);
        ranks.push((trial.recording.as_str(), Some(rank as u64)));
    }
    counted(numbered(ranks.into_iter()))
}

fn key_of(trial: &Trial) -> Key<'_> {
    (&trial.recording, trial.pose)
}

/// Numbers of keys in the order in which they first appear.
fn numbered<'t>(keys: impl Iterator<Item = Key<'t>>) -> Vec<usize> {
    let mut known: Vec<Key<'t>> = Vec::new();
    let number = |key| {
        let found = known.iter().position(|of| *of == key);
        found.unwrap_or_else(|| {
            known.push(key);
            known.len() - 1
        })
    };
    keys.map(number).collect()
}

/// Whether some pose has all classes.
fn is_whole(trials: &[Trial], poses: &[usize]) -> bool {
    let mut labels: Vec<&str> = trials.iter().map(|trial| trial.label.as_str()).collect();
    labels.sort_unstable();
    labels.dedup();
    let count = poses.iter().copied().max().map_or(0, |last| last + 1);
    let mut found = vec![vec![false; labels.len()]; count];
    for (trial, pose) in trials.iter().zip(poses) {
        if let Ok(label) = labels.binary_search(&trial.label.as_str()) {
            found[*pose][label] = true;
        }
    }
    found.iter().any(|of_pose| of_pose.iter().all(|is| *is))
}

fn counted(numbers: Vec<usize>) -> (Vec<usize>, usize) {
    let count = numbers.iter().copied().max().map_or(0, |last| last + 1);
    (numbers, count)
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    fn trial((label, recording, pose): (&str, &str, Option<u64>)) -> Trial {
        Trial {
            label: label.to_string(),
            recording: recording.to_string(),
            pose,
            ..Trial::default()
        }
    }

    #[test]
    fn recordings_are_poses_unless_they_say_more() {
        let all = [
            ("a", "x", None),
            ("b", "x", None),
            ("a", "y", None),
            ("b", "y", None),
        ];
        assert_eq!(numbers(&all.map(trial)).0, [0, 0, 1, 1]);
        let all = [
            ("a", "x", Some(3)),
            ("b", "x", Some(3)),
            ("a", "x", Some(5)),
            ("b", "x", Some(5)),
        ];
        assert_eq!(numbers(&all.map(trial)).0, [0, 0, 1, 1]);
    }

    #[test]
    fn poses_of_one_class_each_are_put_together() {
        let all = [
            ("a", "x", Some(0)),
            ("b", "x", Some(1)),
            ("a", "x", Some(2)),
            ("b", "x", Some(3)),
        ];
        assert_eq!(numbers(&all.map(trial)), (std::vec![0, 0, 1, 1], 2));
    }
}
