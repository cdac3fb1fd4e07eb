//! A recording: `label,trial,x,y,contact,touch,pose` rows; rows of one label, trial and pose that
//! follow each other are one stream in time order. A sample counts while contact is at least the
//! model's gate; without the column each does. The number of the touch, 0 in the air, is what the
//! module itself said: a whisker that bends by its own inertia has contact in the air. `pose` is
//! there only of scenes whose poses differ. Lines that begin with `# ` may stand above the table.

pub mod touches;

use std::collections::HashSet;
use std::io::{self, Read, Write};

use tactile::MAX_STREAMS;

use crate::Error;
pub use crate::classifier::GATE;
use crate::columns::{Column, columns};
use crate::origin::{self, Origin};
use crate::run::Run;

/// Two channels under one label, trial and pose, in time order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stream {
    /// Class name.
    pub label: String,
    /// Any token.
    pub trial: String,
    /// x and y of each sample.
    pub samples: Vec<[f64; 2]>,
    /// Contact π of each sample; none: all are of contact.
    pub contact: Option<Vec<f64>>,
    /// Number of the touch of each sample, 0 in the air; none: the module did not say.
    pub touch: Option<Vec<u16>>,
    /// The pose in which it was presented; none: all poses are alike, or nothing is known of it.
    pub pose: Option<String>,
    /// How what was touched stood: its tilt, and how deep it reached; none: nothing is known of it.
    pub stands: Option<[f64; 2]>,
}

/// A recording as it is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Samples a second, if it says them.
    pub tick_hz: Option<u32>,
    /// What was recorded.
    pub streams: Vec<Stream>,
    /// The column of tilt or depth that is there without the other.
    pub alone: Option<&'static str>,
}

/// The columns of a recording, in the order in which one is written.
pub const COLUMNS: [Column; 9] = columns! {
    "label", "",
        "what was touched: the name of a class. Neither it nor a trial or a pose may have a control \
        character, or begin as a formula of a spreadsheet does: with `=` or `@`, or with `+` or \
        `-` where no number follows";
    "trial", "",
        "any token; rows of one label, trial and pose that follow each other are one stream in time \
        order";
    "x", "any", "of a simulated sensor the 14-bit code of x; `--channels` takes other columns";
    "y", "any", "the same of y";
    "contact", "", "contact π as in the trace; may be left out: then every row is of contact";
    "touch", "",
        "number of the touch, 0 in the air; where all have the same number, such as 1, each rise \
        from 0 begins another touch; may be left out: then contact says where one begins";
    "pose", "",
        "the pose in which it was presented, any token: rows of one value are of one pose; may be \
        left out: then a file is a pose. `host-sim record` writes it of a scene with \
        `plant.tilt_spread_deg`, `plant.obstacle_spread_deg` or `plant.gain_spread`: a number from \
        0, each presentation another";
    "tilt_deg", "degrees, or any",
        "tilt of what was touched; with `depth_deg` a model learns to estimate both. May be left \
        out, or empty. `host-sim record` writes both where poses differ, as `pose`, and with \
        `classifier.pose`";
    "depth_deg", "degrees, or any",
        "how deep it reached; of a simulated whisker how far its whisk would go beyond where it \
        meets the surface";
};

/// What stands in the name of a trial before the number of a whisker beside the first.
const WHISKER: &str = " whisker ";

/// Most labels of a recording: a model takes 32 of them, and of each pair decisions are counted.
const MOST_LABELS: usize = 1000;

/// The channels of a recording, unless said otherwise.
pub const CHANNELS: [&str; 2] = ["x", "y"];

impl Stream {
    /// The whisker that felt it, from 1, by the end of its trial's name, as [`Recorder`] writes it.
    pub fn whisker(&self) -> usize {
        let number = self.numbered().filter(|n| (1..=MAX_STREAMS).contains(n));
        number.unwrap_or(1)
    }

    /// The number there, which may be that of no whisker.
    pub fn numbered(&self) -> Option<usize> {
        let (_, number) = self.trial.rsplit_once(WHISKER)?;
        number.parse().ok()
    }

    /// Whether each sample counts where contact must be at least `gate`.
    pub fn counts(&self, gate: f64) -> impl Iterator<Item = bool> {
        let contact = |n| self.contact.as_ref().map(|contact| contact.get(n).copied());
        (0..self.samples.len())
            .map(move |n| contact(n).is_none_or(|pi| pi.is_some_and(|pi: f64| pi >= gate)))
    }

    /// The number of the touch of each sample that counts for a model that knows touches,
    /// 0 of those that do not. Where the module did not say, a touch begins with the first
    /// sample that counts and with each after `gap` that do not.
    pub fn touches(&self, gate: f64, gap: u32) -> impl Iterator<Item = u16> {
        let (mut last, mut apart) = (0_u16, gap);
        self.counts(gate).enumerate().map(move |(n, counts)| {
            if !counts {
                apart = apart.saturating_add(1);
                return 0;
            }
            if let Some(touch) = &self.touch {
                return touch.get(n).copied().unwrap_or(0);
            }
            if apart >= gap {
                last = last.checked_add(1).unwrap_or(1);
            }
            apart = 0;
            last
        })
    }
}

/// Collects the samples that the classifier of a run gets, in the air too, tick by tick, one stream
/// for each presentation and whisker that is heard. The run needs no classifier for it.
#[derive(Debug, Default)]
pub struct Recorder {
    /// Of each whisker.
    streams: Vec<Vec<Stream>>,
}

impl Recorder {
    /// Takes the samples of the run's last tick, if there were any.
    pub fn take(&mut self, run: &mut Run) {
        let heard = run.samples().len();
        let felt: Vec<Option<f64>> = (0..heard).map(|n| run.felt_by(n)).collect();
        let (label, trial) = run.presented();
        let pose = run.pose().map(|pose| pose.to_string());
        let stands = run.stands();
        let samples = run.samples();
        self.streams.resize_with(heard, Vec::new);
        let each = self.streams.iter_mut().zip(samples).zip(felt);
        for (n, ((streams, sample), contact)) in each.enumerate() {
            let contact = contact.unwrap_or(0.0);
            let cells = sample.map(|sample| Cells {
                channels: sample.codes.map(f64::from),
                // As the board computes it, or nearer: more digits say nothing.
                contact: Some(f64::from(contact as f32)),
                touch: Some(sample.touch),
            });
            // Each presentation to each whisker is a trial.
            let trial = match n {
                0 => trial.to_string(),
                _ => format!("{trial}{WHISKER}{}", n + 1),
            };
            let (trial, pose) = (trial.as_str(), pose.as_deref());
            let tokens = Tokens { label, trial, pose };
            append(streams, tokens, cells);
            if let Some(stream) = streams.last_mut() {
                stream.stands = stands.get(n).copied();
            }
        }
    }

    /// The recorded streams, those of the first whisker first.
    pub fn into_streams(self) -> Vec<Stream> {
        self.streams.into_iter().flatten().collect()
    }
}

/// What programs write where there is no value.
const MISSING: [&str; 9] = [
    "nan", "NaN", "NAN", "NaT", "NA", "<NA>", "None", "null", "NULL",
];

/// What a row is of.
#[derive(Debug, Clone, Copy)]
pub struct Tokens<'t> {
    /// The label.
    pub label: &'t str,
    /// The trial.
    pub trial: &'t str,
    /// The pose, where there is one.
    pub pose: Option<&'t str>,
}

impl Tokens<'_> {
    /// Whether they can be such.
    ///
    /// # Errors
    /// What is wrong with the first that cannot.
    pub fn check(&self) -> Result<(), String> {
        let needed = [("label", self.label), ("trial", self.trial)];
        for (name, text) in needed {
            if text.trim().is_empty() {
                return Err(format!("the {name} is empty"));
            }
            if MISSING.contains(&text) {
                return Err(format!("the {name} is missing: {text:?}"));
            }
        }
        let pose = self.pose.map(|pose| ("pose", pose));
        needed.into_iter().chain(pose).try_for_each(|(name, text)| {
            if text.starts_with('"') {
                // A reader of CSV takes marks away that stand right behind a comma.
                return Err(format!(
                    "{name} {} has quotation marks behind a blank",
                    excerpt(text)
                ));
            }
            let checked = tactile::name::check(text);
            checked.map_err(|reason| format!("{name} {} {reason}", excerpt(text)))
        })
    }
}

struct Cells {
    channels: [f64; 2],
    contact: Option<f64>,
    touch: Option<u16>,
}

/// Adds a sample to the last stream, or to another if it is of something else. A row without a pose
/// is of that of the row before.
fn append(streams: &mut Vec<Stream>, tokens: Tokens<'_>, sample: Option<Cells>) {
    let Tokens { label, trial, pose } = tokens;
    let pose = pose.filter(|pose| !pose.is_empty());
    let is_same = |last: &Stream| {
        let is_in_pose = pose.is_none() || last.pose.as_deref() == pose;
        is_in_pose && last.label == label && last.trial == trial
    };
    if !streams.last().is_some_and(is_same) {
        streams.push(Stream {
            label: label.to_owned(),
            trial: trial.to_owned(),
            pose: pose.map(str::to_owned),
            ..Stream::default()
        });
    }
    if let (Some(stream), Some(cells)) = (streams.last_mut(), sample) {
        stream.samples.push(cells.channels);
        if let Some(contact) = cells.contact {
            stream.contact.get_or_insert_default().push(contact);
        }
        if let Some(touch) = cells.touch {
            stream.touch.get_or_insert_default().push(touch);
        }
    }
}

/// Reads a recording whose channels are the columns `channels`. More columns are
/// ignored, their order is free.
///
/// # Errors
/// [`Error::Input`] names the line and what is wrong with it.
pub fn read(table: impl Read, channels: [&str; 2]) -> Result<Vec<Stream>, Error> {
    read_whole(table, channels).map(|recording| recording.streams)
}

/// The same with what stands above its table.
///
/// # Errors
/// As [`read`].
pub fn read_whole(mut table: impl Read, channels: [&str; 2]) -> Result<Recording, Error> {
    let mut file = Vec::new();
    let read = table.read_to_end(&mut file);
    read.map_err(|error| Error::Input(error.to_string()))?;
    parse(&file, channels).map_err(Error::Input)
}

/// Writes a recording.
///
/// # Errors
/// Any error of the writer.
pub fn write(table: impl Write, streams: &[Stream]) -> io::Result<()> {
    write_from(table, &Origin::default(), streams)
}

/// Writes a recording below where it comes from.
///
/// # Errors
/// Any error of the writer.
pub fn write_from(mut table: impl Write, origin: &Origin, streams: &[Stream]) -> io::Result<()> {
    origin.write(&mut table)?;
    let mut table = csv::Writer::from_writer(table);
    let any = |has: fn(&Stream) -> bool| streams.iter().any(has);
    let touch = any(|stream| stream.touch.is_some());
    // Whoever reads touches asks for contact beside them.
    let contact = touch || any(|stream| stream.contact.is_some());
    let pose = any(|stream| stream.pose.is_some());
    let stands = any(|stream| stream.stands.is_some());
    let are_there = [true, true, true, true, contact, touch, pose, stands, stands];
    let mut write = |cells: [&str; 9]| {
        let cells = cells.into_iter().zip(are_there);
        table.write_record(cells.filter_map(|(cell, is_there)| is_there.then_some(cell)))
    };
    write(COLUMNS.map(|column| column.name))?;
    for stream in streams {
        let pose = stream.pose.as_deref().unwrap_or_default();
        let stood = stream.stands.map(|stands| stands.map(|of| of.to_string()));
        let [tilt, depth] = stood.unwrap_or_default();
        for (n, [x, y]) in stream.samples.iter().enumerate() {
            let contact = stream.contact.as_ref().and_then(|contact| contact.get(n));
            let contact = (contact.map_or(1.0, |contact| *contact) as f32).to_string();
            let touch = stream.touch.as_ref().and_then(|touch| touch.get(n));
            let touch = touch.copied().unwrap_or(0).to_string();
            let Stream { label, trial, .. } = stream;
            let [x, y] = [x, y].map(f64::to_string);
            write([label, trial, &x, &y, &contact, &touch, pose, &tilt, &depth])?;
        }
    }
    table.flush()
}

/// The line of each sample of a table that [`read`] takes.
#[cfg(feature = "cli")]
pub(crate) fn lines(table: &[u8]) -> Vec<u64> {
    let (_, above, table) = origin::split(table);
    let mut reader = csv::Reader::from_reader(table);
    let records = reader.byte_records().map_while(Result::ok);
    let line = |record: csv::ByteRecord| line_of(table, above, record.position());
    records.map(line).collect()
}

/// The line of a row of `table`, which `above` lines stand above. What is between two rows, as the
/// rest of an end of a line or blank lines, belongs to the second.
pub fn line_of(table: &[u8], above: u64, row: Option<&csv::Position>) -> u64 {
    let Some(row) = row else {
        return above;
    };
    let between = table.iter().skip(row.byte() as usize);
    let between = between.take_while(|byte| matches!(byte, b'\r' | b'\n'));
    let ends = between.filter(|byte| **byte == b'\n').count();
    above + row.line() + ends as u64
}

/// What is wrong with `table` as a table, which `above` lines stand above.
pub fn broken(error: &csv::Error, table: &[u8], above: u64) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths {
            pos: Some(at),
            expected_len,
            len,
        } => format!(
            "line {}: {len} cells; the header has {expected_len}{}",
            line_of(table, above, Some(at)),
            if len > expected_len {
                " (a comma within a number?)"
            } else {
                ""
            }
        ),
        csv::ErrorKind::Utf8 { pos: Some(at), .. } => {
            let line = line_of(table, above, Some(at));
            format!("line {line}: not UTF-8 (Latin-1?); save it as CSV in UTF-8")
        }
        _ => error.to_string(),
    }
}

/// A cell in a message, cut where a quotation mark has made it long.
fn excerpt(cell: &str) -> String {
    let begin: String = cell.chars().take(80).collect();
    let is_cut = begin.len() < cell.len();
    let more = is_cut.then_some("… (a quotation mark that is not closed?)");
    format!("{begin:?}{}", more.unwrap_or_default())
}

fn finite(text: &str, name: &str, line: u64) -> Result<f64, String> {
    let shown = excerpt(text);
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ if text.contains([',', '\'', ' ', '\u{a0}', '\u{202f}']) => Err(format!(
            "line {line}: {name} is {shown}, not a finite number; write it like 1000 or 0.5"
        )),
        _ => Err(format!(
            "line {line}: {name} is {shown}, not a finite number"
        )),
    }
}

fn parse(file: &[u8], channels: [&str; 2]) -> Result<Recording, String> {
    if let Some(fault) = origin::foreign(file) {
        return Err(fault);
    }
    let (origin, above, rows) = origin::split(file);
    let broken = |error: csv::Error| broken(&error, rows, above);
    let first = above + 1;
    let mut table = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(rows);
    let header = table.headers().map_err(broken)?.clone();
    let optional = |name: &str| {
        let mut found = header.iter().enumerate().filter(|(_, cell)| *cell == name);
        match (found.next(), found.next()) {
            (place, None) => Ok(place.map(|(place, _)| place)),
            (_, Some(_)) => Err(format!("line {first}: two columns {name:?}")),
        }
    };
    let [x_name, y_name] = channels;
    if x_name == y_name {
        return Err(format!(
            "both channels are the column {x_name:?}; two are needed"
        ));
    }
    let column = |name: &str| {
        optional(name)?.ok_or_else(|| {
            format!(
                "line {first}: no column {name:?}; a recording has label,trial,{x_name},{y_name}"
            )
        })
    };
    let [label, trial] = [column("label")?, column("trial")?];
    let [x, y] = [column(x_name)?, column(y_name)?];
    let [contact, touch] = [optional("contact")?, optional("touch")?];
    let pose = optional("pose")?;
    let stands = COLUMNS[7..].iter().map(|column| optional(column.name));
    let stands: Vec<Option<usize>> = stands.collect::<Result<_, _>>()?;

    let mut streams: Vec<Stream> = Vec::new();
    let mut labels = HashSet::new();
    let mut record = csv::StringRecord::new();
    while table.read_record(&mut record).map_err(broken)? {
        let line = line_of(rows, above, record.position());
        let cell = |place: usize| record.get(place).unwrap_or_default();
        let number = |name: &str, place: usize| finite(cell(place), name, line);
        // As wide as it is written.
        let contact_at = |place: usize| match number("contact", place)? {
            contact if (contact as f32).is_finite() => Ok(contact),
            _ => Err(format!(
                "line {line}: contact is {}, beyond single precision",
                excerpt(cell(place))
            )),
        };
        let whole = |place: usize| {
            touches::number(cell(place)).map_err(|fault| format!("line {line}: {fault}"))
        };
        let sample = Cells {
            channels: [number(x_name, x)?, number(y_name, y)?],
            contact: contact.map(contact_at).transpose()?,
            touch: touch.map(whole).transpose()?,
        };
        let (label, trial) = (cell(label), cell(trial));
        let pose = pose.map(cell);
        let tokens = Tokens { label, trial, pose };
        let checked = tokens.check();
        checked.map_err(|fault| format!("line {line}: {fault}"))?;
        let before = streams.len();
        append(&mut streams, tokens, Some(sample));
        let Some(stream) = streams.get_mut(before) else {
            continue;
        };
        if labels.insert(label.to_owned()) && labels.len() > MOST_LABELS {
            return Err(format!(
                "line {line}: label {label:?} is one of more than {MOST_LABELS}; a label is the \
                 name of what was touched"
            ));
        }
        if let [Some(tilt), Some(depth)] = &stands[..]
            && !(cell(*tilt).is_empty() || cell(*depth).is_empty())
        {
            let [of_tilt, of_depth] = [COLUMNS[7].name, COLUMNS[8].name];
            stream.stands = Some([number(of_tilt, *tilt)?, number(of_depth, *depth)?]);
        }
    }
    if streams.is_empty() {
        return Err("no samples".to_owned());
    }
    touches::tell_apart(&mut streams);
    let tick_hz = origin.tick_hz()?;
    let alone = stands.iter().position(Option::is_some);
    let alone = alone.filter(|_| stands.contains(&None));
    let alone = alone.map(|n| COLUMNS[7 + n].name);
    Ok(Recording {
        tick_hz,
        streams,
        alone,
    })
}

#[cfg(test)]
mod tests {
    use super::{CHANNELS, GATE, Stream};

    fn parse(table: &[u8]) -> Result<Vec<Stream>, String> {
        super::parse(table, CHANNELS).map(|recording| recording.streams)
    }

    #[test]
    fn contact_says_which_samples_count() {
        let text = "label,trial,u,contact,v,x\na,1,2,0.04,3,9\na,1,4,0.05,5,9\n";
        let streams = super::parse(text.as_bytes(), ["u", "v"]).unwrap().streams;
        assert_eq!(streams[0].samples, [[2.0, 3.0], [4.0, 5.0]]);
        let counts: Vec<_> = streams[0].counts(GATE).collect();
        assert_eq!(counts, [false, true]);
        let mut written = Vec::new();
        super::write(&mut written, &streams).unwrap();
        let text = String::from_utf8(written).unwrap();
        assert_eq!(
            text,
            "label,trial,x,y,contact\na,1,2,3,0.04\na,1,4,5,0.05\n"
        );
    }

    #[test]
    fn a_touch_is_asked_for_beside_contact() {
        let text = "label,trial,x,y,contact,touch\na,1,2,3,0.5,0\na,1,4,5,0.5,7\na,1,4,5,0,7\n";
        let streams = parse(text.as_bytes()).unwrap();
        let counts: Vec<_> = streams[0].counts(GATE).collect();
        let touches: Vec<_> = streams[0].touches(GATE, 1).collect();
        assert_eq!(counts, [true, true, false]);
        assert_eq!(touches, [0, 7, 0]);
        let mut written = Vec::new();
        super::write(&mut written, &streams).unwrap();
        assert_eq!(String::from_utf8(written).unwrap(), text);
    }

    #[test]
    fn lines_above_the_table_are_counted_and_change_nothing() {
        let table = "label,trial,x,y\n#1,1,2,3\n";
        let below = format!("# scene = bench\n# a remark\n{table}");
        assert_eq!(parse(below.as_bytes()), parse(table.as_bytes()));
        assert_eq!(parse(table.as_bytes()).unwrap()[0].label, "#1");
        let fault = parse(b"\n# a remark\r\n,,\r\nlabel,trial,x\n").unwrap_err();
        assert!(fault.starts_with("line 4: no column"), "{fault}");
        let fault = parse(b"\n\nlabel;trial;x;y\n").unwrap_err();
        assert!(fault.starts_with("line 3: semicolons"), "{fault}");
        let blank = format!("\n \n{table}");
        assert_eq!(parse(blank.as_bytes()), parse(table.as_bytes()));
        #[cfg(feature = "cli")]
        assert_eq!(super::lines(below.as_bytes()), [4]);
    }

    /// Those that the page of recordings does not have.
    #[test]
    fn faults_name_their_line() {
        let many: Vec<_> = (0..2000).map(|n| format!("l{n},1,2,3\n")).collect();
        let many = format!("label,trial,x,y\n{}", many.concat());
        let fails = |table: &str, says: &str| {
            let table = table.replace("HEADER", "label,trial,x,y");
            for end in ["\n", "\r\n"] {
                let fault = parse(table.replace('\n', end).as_bytes()).unwrap_err();
                assert!(fault.starts_with(says), "{fault}");
            }
        };
        fails("label,trial,x,x,y\na,1,2,2,2\n", "line 1: two columns");
        fails("HEADER\na,1,2,3\na,1,1e999,3\n", "line 3: x is \"1e999\"");
        let beyond = "line 2: contact is \"1e39\", beyond single precision";
        fails("HEADER,contact\na,1,2,3,1e39\n", beyond);
        let missing = "line 4: the label is missing: \"<NA>\"";
        fails("# a\nHEADER\na,1,2,3\n<NA>,1,2,3\n", missing);
        fails("# a\nHEADER\na,1,2,3\n\na,1\n", "line 5: 2 cells");
        fails("\n\nHEADER\n\na,1,2,\n", "line 5: y is \"\"");
        let comma = "line 2: 5 cells; the header has 4 (a comma within a number?)";
        fails("HEADER\na,1,1,000,3\n", comma);
        let open = format!("HEADER\na,1,2,\"3\n{}", "a,1,2,3\n".repeat(20));
        let begin = "line 2: y is \"3\\na,1,2,3\\n";
        let fault = parse(open.replace("HEADER", "label,trial,x,y").as_bytes()).unwrap_err();
        assert!(fault.starts_with(begin) && fault.len() < 200, "{fault}");
        assert!(
            fault.contains("… (a quotation mark that is not closed?)"),
            "{fault}"
        );
        fails(
            "HEADER\na,1,\"1,000\",3\n",
            "line 2: x is \"1,000\", not a finite number; write",
        );
        fails(&many, "line 1002: label \"l1000\" is one of more than 1000");
        let hidden = r#"line 2: pose "\u{202e}b" has the character '\u{202e}'"#;
        fails("HEADER,pose\na,1,2,3,\u{202e}b\n", hidden);
    }
}
