//! A recording: `label,trial,x,y` rows; rows of one label and trial that
//! follow each other are one stream in time order.

use std::io::{self, Read, Write};

use crate::Error;
use crate::run::Run;

/// Two channels under one label and trial, in time order.
#[derive(Debug, Clone, PartialEq)]
pub struct Stream {
    /// Class name.
    pub label: String,
    /// Any token.
    pub trial: String,
    /// x and y of each sample.
    pub samples: Vec<[f64; 2]>,
}

/// Collects the samples that the classifier of a run gets, tick by tick, one
/// stream for each presentation. The run needs no classifier for it.
#[derive(Debug, Default)]
pub struct Recorder {
    streams: Vec<Stream>,
}

impl Recorder {
    /// Takes the sample of the run's last tick, if there was one.
    pub fn take(&mut self, run: &mut Run) {
        let sample = run.sample().map(|codes| codes.map(f64::from));
        let (label, trial) = run.presented();
        append(&mut self.streams, label, &trial.to_string(), sample);
    }

    /// The recorded streams.
    pub fn into_streams(self) -> Vec<Stream> {
        self.streams
    }
}

/// Adds a sample, if there is one, to the last stream, or begins one where label or
/// trial is another.
fn append(streams: &mut Vec<Stream>, label: &str, trial: &str, sample: Option<[f64; 2]>) {
    let last = streams.last_mut();
    match last.filter(|last| last.label == label && last.trial == trial) {
        Some(stream) => stream.samples.extend(sample),
        None => streams.push(Stream {
            label: label.to_owned(),
            trial: trial.to_owned(),
            samples: sample.into_iter().collect(),
        }),
    }
}

/// Reads a recording. More columns than the four are ignored, their order is free.
///
/// # Errors
/// [`Error::Input`] names the line and what is wrong with it.
pub fn read(table: impl Read) -> Result<Vec<Stream>, Error> {
    parse(table).map_err(Error::Input)
}

/// Writes a recording.
///
/// # Errors
/// Any error of the writer.
pub fn write(table: impl Write, streams: &[Stream]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(table);
    table.write_record(["label", "trial", "x", "y"])?;
    for stream in streams {
        for [x, y] in &stream.samples {
            table.write_record([&stream.label, &stream.trial, &x.to_string(), &y.to_string()])?;
        }
    }
    table.flush()
}

/// What is wrong with a table as a table.
fn broken(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths {
            pos: Some(at),
            expected_len,
            len,
        } => format!(
            "line {}: {len} cells; the header has {expected_len}",
            at.line()
        ),
        csv::ErrorKind::Utf8 { pos: Some(at), .. } => format!("line {}: not UTF-8", at.line()),
        _ => error.to_string(),
    }
}

fn parse(table: impl Read) -> Result<Vec<Stream>, String> {
    let mut table = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(table);
    let header = table.headers().map_err(|e| broken(&e))?.clone();
    let column = |name: &str| {
        let mut found = header.iter().enumerate().filter(|(_, cell)| *cell == name);
        match (found.next(), found.next()) {
            (Some((place, _)), None) => Ok(place),
            (None, _) => Err(format!(
                "line 1: no column {name:?}; a recording has label,trial,x,y"
            )),
            (Some(_), Some(_)) => Err(format!("line 1: two columns {name:?}")),
        }
    };
    let (label, trial, x, y) = (
        column("label")?,
        column("trial")?,
        column("x")?,
        column("y")?,
    );

    let mut streams: Vec<Stream> = Vec::new();
    let mut record = csv::StringRecord::new();
    while table.read_record(&mut record).map_err(|e| broken(&e))? {
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |place: usize| record.get(place).unwrap_or_default();
        let number = |name: &str, place: usize| -> Result<f64, String> {
            let text = cell(place);
            match text.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(value),
                _ => Err(format!(
                    "line {line}: {name} is {text:?}, not a finite number"
                )),
            }
        };
        let sample = [number("x", x)?, number("y", y)?];
        let (label, trial) = (cell(label), cell(trial));
        if label.is_empty() {
            return Err(format!("line {line}: the label is empty"));
        }
        append(&mut streams, label, trial, Some(sample));
    }
    if streams.is_empty() {
        return Err("no samples".to_owned());
    }
    Ok(streams)
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn rows_that_follow_each_other_are_a_stream() {
        let text = "y,extra,label,x,trial\n1,a,ice,2,1\n3,b,ice,4,1\n5,c,ice,6,2\n7,d,ice,8,1\n";
        let streams = parse(text.as_bytes()).unwrap();
        let shapes: Vec<_> = streams
            .iter()
            .map(|s| (s.trial.as_str(), s.samples.clone()))
            .collect();
        assert_eq!(
            shapes,
            [
                ("1", vec![[2.0, 1.0], [4.0, 3.0]]),
                ("2", vec![[6.0, 5.0]]),
                ("1", vec![[8.0, 7.0]]),
            ]
        );
    }

    #[test]
    fn faults_name_their_line() {
        let fault = |text: &str| parse(text.as_bytes()).unwrap_err();
        assert!(fault("label,trial,x\na,1,2\n").contains("\"y\""));
        assert!(fault("label,trial,x,x,y\na,1,2,2,2\n").contains("two columns"));
        assert!(fault("label,trial,x,y\na,1,2,3\na,1,nan,3\n").starts_with("line 3: x is"));
        assert!(fault("label,trial,x,y\na,1,2,3\na,1,1e999,3\n").starts_with("line 3: x is"));
        assert_eq!(
            fault("label,trial,x,y\na,1,2\n"),
            "line 2: 3 cells; the header has 4"
        );
        assert!(fault("label,trial,x,y\n,1,2,3\n").contains("label is empty"));
        assert_eq!(fault("label,trial,x,y\n"), "no samples");
        assert!(fault("").contains("line 1"));
    }
}
