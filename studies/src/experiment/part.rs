//! Part files: what one shard recorded, to be joined with the others.
//!
//! Bytes, all numbers little-endian: `WHISKER PART 1`, a line that names the
//! request, a newline; then for each recording its data set, job, channels and
//! count of values (u32 each) and the values (f32); at the end the CRC-32 of
//! all before.

use std::path::{Path, PathBuf};

use super::dataset::{Dataset, Job};
use super::record::jobs;
use super::recording::{Recording, Recordings};
use super::request::Request;
use host_sim::Error;
use host_sim::output::write_whole;

const MAGIC: &str = "WHISKER PART 1 ";
const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// The bytes of a part.
pub fn bytes(request: &Request, recordings: &Recordings) -> Vec<u8> {
    let mut bytes = format!("{MAGIC}{}\n", request.line()).into_bytes();
    for (job, recording) in recordings {
        // Counts are far below 2³²: the largest set has 3200 jobs of 2²⁰ values.
        let head = [
            job.dataset.number(),
            job.number as u32,
            recording.channels as u32,
            recording.values.len() as u32,
        ];
        bytes.extend(head.iter().flat_map(|word| word.to_le_bytes()));
        bytes.extend(recording.values.iter().flat_map(|x| x.to_le_bytes()));
    }
    let sum = CRC.checksum(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// Writes a part file.
///
/// # Errors
/// [`Error::Write`].
pub fn write(path: &Path, request: &Request, recordings: &Recordings) -> Result<(), Error> {
    write_whole(path, &bytes(request, recordings))
}

/// Takes a recording off the front of words; `None` if it is cut short.
fn recording(words: &mut impl Iterator<Item = [u8; 4]>) -> Option<(Job, Recording)> {
    let mut count = || words.next().map(u32::from_le_bytes);
    let dataset = Dataset::from_number(count()?)?;
    let [number, channels, count] = [count()?, count()?, count()?].map(|word| word as usize);
    let values: Vec<f32> = words.take(count).map(f32::from_le_bytes).collect();
    let whole = channels > 0 && values.len() == count;
    whole.then_some((Job { dataset, number }, Recording { channels, values }))
}

/// Reads part `bytes` into `recordings`; what is wrong with them otherwise.
fn read(bytes: &[u8], request: &Request, recordings: &mut Recordings) -> Result<(), String> {
    let (body, sum) = bytes.split_last_chunk::<4>().ok_or("too short")?;
    let rest = body
        .strip_prefix(MAGIC.as_bytes())
        .ok_or("not a part of an experiment")?;
    if CRC.checksum(body) != u32::from_le_bytes(*sum) {
        return Err("damaged: its checksum is wrong".to_owned());
    }
    let end = rest.iter().position(|byte| *byte == b'\n');
    let (line, rest) = rest.split_at(end.ok_or("no first line")?);
    let (line, expected) = (String::from_utf8_lossy(line), request.line());
    if line != expected {
        return Err(format!("of another request: {line}, not {expected}"));
    }
    let (words, odd) = rest.get(1..).unwrap_or(&[]).as_chunks::<4>();
    let mut words = words.iter().copied().peekable();
    while words.peek().is_some() || !odd.is_empty() {
        let (job, recording) = recording(&mut words).ok_or("a recording is cut short")?;
        let Job { dataset, number } = job;
        if recordings.insert(job, recording).is_some() {
            return Err(format!("{} {number} is there twice", dataset.text()));
        }
    }
    Ok(())
}

/// Joins parts, in any order.
///
/// # Errors
/// [`Error::Input`] if a file cannot be read, is no part of this request, or
/// has a recording that another has too; or if recordings are missing.
pub fn join(paths: &[PathBuf], request: &Request) -> Result<Recordings, Error> {
    let mut recordings = Recordings::default();
    for path in paths {
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        read(&bytes, request, &mut recordings).map_err(|fault| Error::file(path, fault))?;
    }
    let expected = jobs(request);
    let missing: Vec<&Job> = expected
        .iter()
        .filter(|job| !recordings.contains_key(job))
        .collect();
    if let Some(Job { dataset, number }) = missing.first() {
        return Err(Error::Input(format!(
            "{} of {} recordings are in no part, the first: {} {number}",
            missing.len(),
            expected.len(),
            dataset.text(),
        )));
    }
    Ok(recordings)
}

/// The request that a part is of, from its first line: names, quick, seed.
///
/// # Errors
/// [`Error::Input`] if it cannot be read.
pub fn first_line(path: &Path) -> Result<String, Error> {
    let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
    let line = bytes.split(|byte| *byte == b'\n').next().unwrap_or(&[]);
    String::from_utf8_lossy(line)
        .strip_prefix(MAGIC)
        .map(str::to_owned)
        .ok_or_else(|| Error::file(path, "not a part of an experiment"))
}
