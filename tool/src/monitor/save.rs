//! What is held, written to a file.

use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::origin::Origin;
use wire::Packet;

use super::history::{Entry, History};
use crate::record_file::RecordFile;

/// What is held, taken at once.
pub(crate) struct Held {
    tick_hz: u32,
    entries: Vec<Entry>,
    lines: Vec<(u64, String)>,
}

impl Held {
    /// All that a history has.
    pub(crate) fn of(history: &History) -> Self {
        let mut entries: Vec<Entry> = history.sides.iter().flatten().copied().collect();
        // The left side's first, as they came.
        entries.sort_by_key(|entry| entry.ticks);
        let lines = history.lines.iter();
        Self {
            tick_hz: history.tick_hz,
            entries,
            lines: lines.map(|said| (said.ticks, said.what.clone())).collect(),
        }
    }

    /// Writes it to a new file; returns which, and how many records are in it.
    pub(crate) fn write(&self, path: &Path, origin: &Origin) -> Result<(PathBuf, usize), Error> {
        let path = free(path);
        let mut file = RecordFile::create(&path, origin, self.tick_hz)?;
        let mut lines = self.lines.iter().peekable();
        for entry in &self.entries {
            while let Some((_, line)) = lines.next_if(|(ticks, _)| *ticks < entry.ticks) {
                file.line(line)?;
            }
            file.packets(&[Packet::Record(entry.record)])?;
        }
        for (_, line) in lines {
            file.line(line)?;
        }
        file.finish()?;
        Ok((path, self.entries.len()))
    }
}

/// The first name like this that no file has: with a number, if need be.
fn free(path: &Path) -> PathBuf {
    let (stem, ending) = (path.file_stem(), path.extension());
    let [stem, ending] = [stem, ending].map(|part| part.unwrap_or_default().to_string_lossy());
    let numbered = (2..).map(|n: u32| path.with_file_name(format!("{stem}-{n}.{ending}")));
    let mut names = std::iter::once(path.to_owned()).chain(numbered);
    let free = names.find(|path| !path.exists());
    free.unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use host_sim::origin::Origin;
    use wire::{Flags, Packet, TickRecord};

    use super::Held;
    use crate::monitor::history::History;
    use crate::source::Heard;
    use crate::table;

    #[test]
    fn what_is_held_is_what_is_saved_and_no_file_is_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.csv");
        let mut history = History::new(100, 2, None);
        let mut records = Vec::new();
        for sequence in 1..=50 {
            for flags in [Flags::VALID, Flags::RIGHT] {
                records.push(TickRecord {
                    sequence,
                    flags,
                    ..TickRecord::default()
                });
            }
        }
        for record in &records {
            history.take(&Heard {
                packets: vec![Packet::Record(*record)],
                lines: Vec::new(),
            });
        }
        let held = Held::of(&history);
        let names = [0; 3].map(|_| held.write(&path, &Origin::default()).unwrap());
        let expected = ["s.csv", "s-2.csv", "s-3.csv"].map(|name| (folder.path().join(name), 100));
        assert_eq!(names, expected);
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(table::read(&bytes).unwrap().records, records);
    }
}
