//! Which trials were felt in one pose.

use std::format;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use crate::train::joint::Trial;

/// What is one pose: a recording; or, where it says that it has several, one of these.
type Key<'t> = (&'t str, Option<&'t str>);

pub(in crate::train) struct Poses {
    pub(in crate::train) of_trial: Vec<usize>,
    /// What each is called; none where poses were put together.
    pub(in crate::train) names: Vec<Option<String>>,
}

impl Poses {
    /// Recordings that say in which pose each trial was felt are cut by it. If then no pose has
    /// all classes, as where each presentation has a pose of its own, the first poses of the
    /// classes are put together, the second ones, and so on.
    pub(in crate::train) fn of(trials: &[Trial]) -> Self {
        let keys = || trials.iter().map(key_of);
        let by_pose = numbered(keys());
        let is_alone = trials.iter().all(|t| t.recording == trials[0].recording);
        if trials.iter().all(|trial| trial.pose.is_none()) || is_whole(trials, &by_pose) {
            let count = counted(&by_pose);
            let name = |pose| {
                let first = by_pose.iter().position(|of| *of == pose)?;
                Some(called(keys().nth(first)?, is_alone))
            };
            return Self {
                names: (0..count).map(name).collect(),
                of_trial: by_pose,
            };
        }
        let of_trial = numbered(ranks(trials).into_iter());
        Self {
            names: vec![None; counted(&of_trial)],
            of_trial,
        }
    }

    pub(in crate::train) const fn count(&self) -> usize {
        self.names.len()
    }
}

/// A pose in words; of one recording alone its name says nothing.
fn called((recording, pose): Key<'_>, is_alone: bool) -> String {
    match pose {
        None => recording.to_string(),
        Some(pose) if is_alone => format!("pose {pose}"),
        Some(pose) => format!("{recording}, pose {pose}"),
    }
}

/// Which pose of its class and recording each trial was felt in, beside the recording.
fn ranks(trials: &[Trial]) -> Vec<(&str, usize)> {
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
        ranks.push((trial.recording.as_str(), rank));
    }
    ranks
}

fn key_of(trial: &Trial) -> Key<'_> {
    (&trial.recording, trial.pose.as_deref())
}

/// Numbers of keys in the order in which they first appear.
fn numbered<K: PartialEq>(keys: impl Iterator<Item = K>) -> Vec<usize> {
    let mut known: Vec<K> = Vec::new();
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
    let mut found = vec![vec![false; labels.len()]; counted(poses)];
    for (trial, pose) in trials.iter().zip(poses) {
        if let Ok(label) = labels.binary_search(&trial.label.as_str()) {
            found[*pose][label] = true;
        }
    }
    found.iter().any(|of_pose| of_pose.iter().all(|is| *is))
}

fn counted(numbers: &[usize]) -> usize {
    numbers.iter().copied().max().map_or(0, |last| last + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial((label, recording, pose): (&str, &str, Option<u64>)) -> Trial {
        Trial {
            label: label.to_string(),
            recording: recording.to_string(),
            pose: pose.map(|pose| pose.to_string()),
            ..Trial::default()
        }
    }

    #[test]
    fn recordings_are_poses_unless_they_say_more() {
        // Poses of one class each are put together.
        for (recordings, poses, names) in [
            (["x", "x", "y", "y"], [None; 4], [Some("x"), Some("y")]),
            (
                ["x"; 4],
                [3, 3, 5, 5].map(Some),
                [Some("pose 3"), Some("pose 5")],
            ),
            (["x"; 4], [0, 1, 2, 3].map(Some), [None, None]),
        ] {
            let all = [0, 1, 2, 3].map(|n| trial((["a", "b"][n % 2], recordings[n], poses[n])));
            let found = Poses::of(&all);
            assert_eq!(found.of_trial, [0, 0, 1, 1]);
            assert_eq!(found.names, names.map(|name| name.map(str::to_string)));
        }
    }
}
