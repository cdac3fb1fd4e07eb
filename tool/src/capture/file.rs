//! The file that is captured to.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::files::read_recording;
use host_sim::origin::{self, Origin};
use host_sim::output::{self, Output};
use host_sim::recording::{self, CHANNELS, Stream};
use jiff::Timestamp;
use scene::file;

use super::label::Stands;
use super::touches::count;

/// Parts of the origin that must stay the same in one recording.
const SAME: [&str; 3] = ["scene", "tick_hz", SIDE];

/// Of the whisker that was recorded.
pub(crate) const SIDE: &str = "side";

/// What stands before the keys of its calibration.
pub(crate) const CALIBRATION: &str = "calibration.";

/// When the first touch ended, by the PC's clock.
pub(crate) const FIRST_TOUCH: &str = "first_touch";

#[derive(Debug, Default)]
pub(crate) struct Recording {
    path: PathBuf,
    pose: Option<String>,
    /// How samples stand in it.
    stands: Option<Stands>,
    origin: Origin,
    streams: Vec<Stream>,
}

pub(crate) fn origin_of(path: &Path) -> Result<Origin, Error> {
    let bytes = file::read(path, file::TABLE_BYTES);
    let (origin, ..) = origin::split(&bytes.map_err(|error| Error::file(path, error))?);
    Ok(origin)
}

impl Recording {
    /// A new recording, or with `resumes` the one that is there.
    pub(crate) fn open(
        path: &Path,
        resumes: bool,
        (pose, stands): (Option<&str>, Option<Stands>),
    ) -> Result<Self, Error> {
        output::check(path)?;
        let is_there = path.exists();
        if is_there && !resumes {
            let fault = "is there already, and is not overwritten; name another file, or go on \
                         with this one by --resume";
            return Err(Error::file(path, fault));
        }
        let mut recording = Self {
            path: path.to_owned(),
            pose: pose.map(str::to_owned),
            stands,
            ..Self::default()
        };
        if is_there {
            recording.streams = read_recording(path, CHANNELS)?;
            recording.origin = origin_of(path)?;
        }
        Ok(recording)
    }

    /// Says where it comes from, if that is not said; otherwise it must be the same module.
    pub(crate) fn comes_from(&mut self, origin: Origin) -> Result<(), Error> {
        if self.streams.is_empty() {
            self.origin = origin;
            return Ok(());
        }
        let calibrated = origin.iter().map(|(key, _)| key);
        let calibrated = calibrated.filter(|key| key.starts_with(CALIBRATION));
        for key in SAME.into_iter().chain(calibrated) {
            let (found, here) = (self.origin.get(key), origin.get(key));
            // Older files do not say which side they are of.
            if found != here && (found.is_some() || key != SIDE) {
                let [found, here] = [found, here].map(|value| value.unwrap_or("none"));
                let fault = format!(
                    "is of a module whose {key} is {found}, this one's is {here}; capture to \
                     another file"
                );
                return Err(Error::file(&self.path, fault));
            }
        }
        Ok(())
    }

    pub(crate) fn begun_at(&mut self, when: Timestamp) {
        if self.origin.get(FIRST_TOUCH).is_none() {
            let origin = std::mem::take(&mut self.origin);
            self.origin = origin.with(FIRST_TOUCH, format_args!("{when:.0}"));
        }
    }

    fn of<'s>(&'s self, label: &'s str) -> impl Iterator<Item = &'s Stream> {
        let streams = self.streams.iter();
        streams.filter(move |stream| stream.label == label)
    }

    pub(crate) fn touches(&self, label: &str) -> usize {
        count(self.of(label).filter(|stream| stream.pose == self.pose))
    }

    pub(crate) fn all_touches(&self) -> usize {
        count(self.streams.iter())
    }

    pub(crate) fn labels_and_poses(&self) -> [usize; 2] {
        let labels: BTreeSet<_> = self.streams.iter().map(|stream| &stream.label).collect();
        let poses: BTreeSet<_> = self.streams.iter().map(|stream| &stream.pose).collect();
        [labels.len(), poses.len()]
    }

    pub(crate) fn next_trial(&self, label: &str) -> u64 {
        let trials = self.of(label);
        let trials = trials.filter_map(|stream| stream.trial.parse().ok());
        trials.max().map_or(0, |last: u64| last.saturating_add(1))
    }

    pub(crate) fn add(&mut self, streams: Vec<Stream>) -> Result<(), Error> {
        let held = streams.into_iter().map(|stream| Stream {
            pose: self.pose.clone(),
            stands: self.stands,
            ..stream
        });
        self.streams.extend(held);
        let mut output = Output::create(&self.path)?;
        recording::write_from(&mut output, &self.origin, &self.streams)
            .map_err(|source| output.failed(source))?;
        output.finish()
    }

    pub(crate) fn samples(&self) -> usize {
        self.streams.iter().map(|stream| stream.samples.len()).sum()
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}
