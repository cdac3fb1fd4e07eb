//! What is held, written to a file.

use std::path::{Path, PathBuf};

use firmware::Packet;
use host_sim::Error;
use host_sim::origin::Origin;

use super::history::History;
use crate::record_file::RecordFile;

pub(crate) struct Held {
    tick_hz: u32,
    records: usize,
    packets: Vec<(u64, Packet)>,
    lines: Vec<(u64, String)>,
    classes: Vec<String>,
}

impl Held {
    pub(crate) fn of(history: &History) -> Self {
        let records = history.sides.iter().flatten();
        let records = records.map(|entry| (entry.ticks, Packet::Record(entry.what)));
        let mut packets: Vec<_> = records.collect();
        let count = packets.len();
        let events = history.events.iter();
        packets.extend(events.map(|said| (said.ticks, Packet::Event(said.what))));
        // The left side's first, as they came.
        packets.sort_by_key(|(ticks, _)| *ticks);
        // What was said before the first record that is held has no time in the file.
        let first = history.oldest();
        packets.retain(|(ticks, _)| *ticks >= first);
        let lines = history.lines.iter().filter(|said| said.ticks >= first);
        Self {
            tick_hz: history.tick_hz,
            records: count,
            packets,
            classes: history.module_classes.clone(),
            lines: lines.map(|said| (said.ticks, said.what.clone())).collect(),
        }
    }

    pub(crate) fn write(&self, path: &Path, origin: &Origin) -> Result<(PathBuf, usize), Error> {
        let path = free(path);
        let mut file = RecordFile::create(&path, origin, self.tick_hz, &self.classes)?;
        let mut lines = self.lines.iter().peekable();
        for (ticks, packet) in &self.packets {
            while let Some((_, line)) = lines.next_if(|(said, _)| said < ticks) {
                file.line(line)?;
            }
            file.packets(std::slice::from_ref(packet))?;
        }
        for (_, line) in lines {
            file.line(line)?;
        }
        file.finish()?;
        Ok((path, self.records))
    }
}

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
    use firmware::Packet;
    use host_sim::origin::Origin;
    use wire::Flags;

    use super::Held;
    use crate::monitor::history::History;
    use crate::source::{Incoming, record};
    use crate::table;

    #[test]
    fn what_is_held_is_what_is_saved_and_no_file_is_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.csv");
        let mut history = History::new((100, 1), 2, None);
        let both = |sequence| [Flags::VALID, Flags::RIGHT].map(|flags| record(sequence, flags));
        let records: Vec<_> = (1..=50).flat_map(both).collect();
        for record in &records {
            history.take(&Incoming::of([Packet::Record(*record)]));
        }
        let held = Held::of(&history);
        let names = [0; 3].map(|_| held.write(&path, &Origin::default()).unwrap());
        let expected = ["s.csv", "s-2.csv", "s-3.csv"].map(|name| (folder.path().join(name), 100));
        assert_eq!(names, expected);
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(table::read(&bytes).unwrap().records, records);
    }
}
