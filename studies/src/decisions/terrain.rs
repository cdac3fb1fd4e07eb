//! A robot's vibration over three grounds: other drives, and other stretches of the same.

use anyhow::Result;
use std::path::Path;

use host_sim::decisions::{Decided, UNKNOWN};
use host_sim::evaluation::{Shown, presentations};
use host_sim::files;
use host_sim::recording::{CHANNELS, Stream};
use host_sim::training::{Expected, How, Tables};
use tactile::ModelBuf;
use tactile::score::Interval;

use super::figures::Goal::{self, AtLeast, AtMost};
use super::{Extent, percent};
use crate::page::Page;

const WINDOW: usize = 2000;
const RATE_HZ: u32 = 100;

/// What the windows of some drives were decided to be.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Windows {
    right: usize,
    wrong: usize,
    all: usize,
}

impl Windows {
    /// Of a window counts the first decision for a class.
    fn of(shown: &[Shown]) -> Self {
        let mut windows = Self::default();
        for shown in shown {
            windows.all += 1;
            let mut named = shown.decided.iter().filter(|d| d.decision != UNKNOWN);
            match named.next().map(Decided::is_right) {
                Some(true) => windows.right += 1,
                Some(false) => windows.wrong += 1,
                None => {}
            }
        }
        windows
    }

    fn decided(self) -> usize {
        self.right + self.wrong
    }
}

pub(super) fn section(page: &mut Page, folder: &Path, extent: &Extent) -> Result<()> {
    let read = |name| files::read_recording(&folder.join(name), CHANNELS);
    let (first, second) = (read("terrain-train.csv")?, read("terrain-test.csv")?);
    let drives = drives(&first, &second);
    let places: Vec<usize> = (0..drives.len()).take(extent.drives).collect();
    let others = extent.cores.each("terrain", &places, |&left_out| {
        let known = drives.iter().enumerate().filter(|(n, _)| *n != left_out);
        let recordings = known.map(|(n, drive)| (n.to_string(), vec![drive.clone()]));
        let model = trained(&recordings.collect::<Vec<_>>(), Expected::default())?;
        decided(&model, &windows(&drives[left_out]))
    })?;
    let [quarters, again] = [0, 1].map(|n| first.iter().map(|half| cut(half, n)).collect());
    let known = [
        vec![("first halves".to_owned(), first)],
        vec![
            ("first quarters".to_owned(), quarters),
            ("second quarters".to_owned(), again),
        ],
    ];
    let [bench, same] =
        [Expected::Bench, Expected::Same].map(|e| known.each_ref().map(|of| (of, e)));
    let known = extent.cores.each(
        "terrain",
        &[bench, same].concat(),
        |(recordings, expected)| {
            let model = trained(recordings, *expected)?;
            let drives = second.iter().map(|drive| decided(&model, &windows(drive)));
            drives.collect::<Result<Vec<Windows>, _>>()
        },
    )?;

    page.heading(2, "Terrain");
    page.say(format_args!(
        "Real recordings ([tests/data/terrain](../../tests/data/terrain/README.md)), in windows \
         of {WINDOW} samples or, of a shorter drive, all of it; what is left over is not used. A \
         window is right or wrong by its first decision for a class at a stated 99 %, and \
         undecided without one. *Other drives*: each of {} drives is left out in turn and the \
         model is trained on the rest, a drive a recording. *Known drives*: trained on the first \
         half of each, tried on the second. What training holds out to weigh its tables is, of \
         one recording, a drive, as if others were to come; given as two recordings, a quarter \
         of each drive in either, another stretch of the same drives, which is what is asked. With \
         `--expect same` a model takes use for like its training, as another stretch is. \
         Intervals count a drive as one observation: its windows are alike.",
        others.len()
    ));
    let mut rows = Vec::new();
    let mut line = |setting: &str, figure: &str, drives: &[Windows], share: Share, goal: Goal| {
        let of = by_drive(drives, share);
        let windows: usize = drives.iter().map(|drive| share.1(*drive)).sum();
        rows.push(vec![
            format!("{setting}: {figure}"),
            goal.text(),
            percent(of),
            windows.to_string(),
            goal.verdict(100.0 * of.share).to_owned(),
        ]);
    };
    let wrong: Share = (|windows| windows.wrong, |windows| windows.all);
    let decided: Share = (Windows::decided, |windows| windows.all);
    let right: Share = (|windows| windows.right, Windows::decided);
    let (other, none) = ("other drives", AtLeast(f64::NEG_INFINITY));
    line(other, "windows wrong", &others, wrong, AtMost(2.0));
    line(other, "windows decided", &others, decided, none);
    line(other, "right of those", &others, right, none);
    let given = [
        "one recording",
        "two recordings",
        "one recording, `--expect same`",
        "two recordings, `--expect same`",
    ];
    for (name, drives) in given.iter().zip(&known) {
        let name = format!("known drives, {name}");
        line(&name, "windows decided", drives, decided, AtLeast(65.0));
        line(&name, "right of those", drives, right, AtLeast(92.0));
    }
    page.table("figure | goal | found | windows |", rows);
    Ok(())
}

/// Some of the windows, and of which.
type Share = (fn(Windows) -> usize, fn(Windows) -> usize);

fn cut(stream: &Stream, half: usize) -> Stream {
    let middle = stream.samples.len() / 2;
    let (first, second) = stream.samples.split_at(middle);
    Stream {
        samples: [first, second][half].to_vec(),
        ..stream.clone()
    }
}

/// The halves of each drive, one behind the other.
fn drives(first: &[Stream], second: &[Stream]) -> Vec<Stream> {
    let whole = |half: &Stream| {
        let is_rest = |of: &&Stream| (&of.label, &of.trial) == (&half.label, &half.trial);
        let rest = second.iter().find(is_rest);
        let mut drive = half.clone();
        let samples = rest.into_iter().flat_map(|rest| &rest.samples);
        drive.samples.extend(samples);
        drive
    };
    first.iter().map(whole).collect()
}

fn windows(drive: &Stream) -> Vec<Stream> {
    let length = WINDOW.min(drive.samples.len().max(1));
    let window = |samples: &[[f64; 2]]| Stream {
        samples: samples.to_vec(),
        ..drive.clone()
    };
    drive.samples.chunks_exact(length).map(window).collect()
}

fn trained(recordings: &[(String, Vec<Stream>)], expect: Expected) -> Result<ModelBuf> {
    let how = How {
        expect,
        ..How::of(Tables::Joint)
    };
    Ok(how.train(recordings, RATE_HZ)?.model)
}

fn decided(model: &ModelBuf, windows: &[Stream]) -> Result<Windows> {
    Ok(Windows::of(&presentations(model, 0.99, windows)?))
}

/// A share of windows, its interval as of one observation a drive that has any.
fn by_drive(drives: &[Windows], (part, whole): Share) -> Interval {
    let sum = |of: fn(Windows) -> usize| drives.iter().map(|drive| of(*drive)).sum::<usize>();
    let observed = drives.iter().filter(|drive| whole(**drive) > 0).count();
    Interval::of_share(sum(part) as f64 / sum(whole) as f64, observed)
}

#[cfg(test)]
mod tests {
    use super::{Windows, by_drive};

    #[test]
    fn a_drive_is_one_observation_and_none_without_windows() {
        let drive = |right, wrong| Windows {
            right,
            wrong,
            all: 10,
        };
        let drives = [drive(9, 1), drive(0, 0), drive(5, 5)];
        let right = by_drive(&drives, (|w| w.right, Windows::decided));
        assert_eq!((right.share, right.count), (0.7, 2));
        assert!(right.low < 0.3 && right.high > 0.9);
    }
}
