//! Tables of measured figures: as they are committed, for a person to read, and
//! compared, so that nothing can become dearer unseen.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::run::{Fault, read, top, write};

/// A line of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Figure {
    pub(crate) key: Vec<String>,
    /// How much, in one number for each of the table's decimals.
    pub(crate) numbers: Vec<f64>,
    /// What a person reads beside it, and no file has.
    pub(crate) note: String,
}

impl Figure {
    pub(crate) fn new(key: &[&str], numbers: &[f64]) -> Self {
        Self {
            key: key.iter().map(|&field| field.to_owned()).collect(),
            numbers: numbers.to_vec(),
            note: String::new(),
        }
    }

    /// Instructions: the mean, to a tenth, and the most.
    pub(crate) fn instructions(key: &[&str], mean: f64, worst: f64) -> Self {
        Self::new(key, &[(mean * 10.0).round() / 10.0, worst])
    }

    pub(crate) fn text(&self, decimals: &[usize], separator: &str) -> String {
        let numbers = self.numbers.iter().zip(decimals);
        let numbers = numbers.map(|(number, &decimals)| format!("{number:.decimals$}"));
        numbers.collect::<Vec<_>>().join(separator)
    }
}

/// Decimals of mean and worst.
pub(crate) const INSTRUCTIONS: &[usize] = &[1, 0];

pub(crate) struct Table {
    /// Seen from the top of the workspace.
    pub(crate) file: &'static str,
    pub(crate) header: &'static str,
    /// Of the numbers, which stand in the last columns.
    pub(crate) decimals: &'static [usize],
    /// By how much a number may become dearer before a check fails.
    pub(crate) slack: f64,
    pub(crate) command: &'static str,
}

impl Table {
    pub(crate) fn read(&self, csv: Option<&Path>) -> Result<Vec<Figure>, Fault> {
        self.parse(&read(&self.place(csv))?)
    }

    /// Prints all `found` and writes it, to `csv` or to the table's own file, or, checking,
    /// compares it; for a `csv` of `-` prints the table alone.
    pub(crate) fn take(
        &self,
        found: &[Figure],
        csv: Option<&Path>,
        check: bool,
    ) -> Result<(), Fault> {
        if csv == Some(Path::new("-")) {
            print!("{}", self.text(found));
            return Ok(());
        }
        print!("{}", self.lines(found));
        if check {
            return self.compare(&self.read(csv)?, found, true);
        }
        write(&self.place(csv), self.text(found))
    }

    pub(crate) fn check_part(&self, found: &[Figure]) -> Result<(), Fault> {
        print!("{}", self.lines(found));
        self.compare(&self.read(None)?, found, false)
    }

    fn place(&self, csv: Option<&Path>) -> PathBuf {
        csv.map_or_else(|| top().join(self.file), Path::to_owned)
    }

    fn text(&self, figures: &[Figure]) -> String {
        let mut text = format!("{}\n", self.header);
        for figure in figures {
            let numbers = figure.text(self.decimals, ",");
            let _ = writeln!(text, "{},{numbers}", figure.key.join(","));
        }
        text
    }

    fn parse(&self, text: &str) -> Result<Vec<Figure>, Fault> {
        let mut lines = text.lines();
        if lines.next() != Some(self.header) {
            return Err(format!("{} does not begin with {}", self.file, self.header));
        }
        let width = self.header.split(',').count();
        let figure = |line: &str| {
            let fields: Vec<&str> = line.split(',').collect();
            let (key, numbers) = fields.split_at_checked(width - self.decimals.len())?;
            let numbers: Option<Vec<f64>> = numbers.iter().map(|n| n.parse().ok()).collect();
            let figure = Figure::new(key, &numbers?);
            (fields.len() == width).then_some(figure)
        };
        lines
            .map(|line| figure(line).ok_or_else(|| format!("{} has a line {line:?}", self.file)))
            .collect()
    }

    fn lines(&self, figures: &[Figure]) -> String {
        let mut text = format!("{}\n", self.header);
        for figure in figures {
            let (key, numbers) = (figure.key.join(", "), figure.text(self.decimals, "  "));
            let _ = writeln!(text, "{key:60}{numbers:>20}  {}", figure.note);
        }
        text
    }

    /// Names everything in `found` that has become dearer than `known` says or is
    /// new there; where `found` `is_all`, also what is gone.
    fn compare(&self, known: &[Figure], found: &[Figure], is_all: bool) -> Result<(), Fault> {
        let mut faults = String::new();
        for now in found {
            let name = now.key.join(",");
            let Some(was) = known.iter().find(|was| was.key == now.key) else {
                let _ = writeln!(faults, "{name} is not in the table");
                continue;
            };
            // A count of board and emulator has tenths that depend on the scene's end.
            let mut numbers = now.numbers.iter().zip(&was.numbers);
            if numbers.any(|(now, was)| *now > was * (1.0 + self.slack) + 0.05) {
                let [now, was] = [now, was].map(|figure| figure.text(self.decimals, ","));
                let _ = writeln!(faults, "{name}: {now} was {was}");
            }
        }
        for was in known {
            if is_all && !found.iter().any(|now| now.key == was.key) {
                let _ = writeln!(faults, "{} is no longer measured", was.key.join(","));
            }
        }
        if faults.is_empty() {
            return Ok(());
        }
        let Self { file, command, .. } = self;
        Err(format!(
            "{faults}If that is meant: {command}, and commit {file}"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::{Figure, INSTRUCTIONS, Table};

    const TABLE: Table = Table {
        file: "a.csv",
        header: "kernel,format,mean,worst",
        decimals: INSTRUCTIONS,
        slack: 0.05,
        command: "count",
    };

    fn figure(name: &str, mean: f64, worst: f64) -> Figure {
        Figure::instructions(&[name, "f32"], mean, worst)
    }

    #[test]
    fn five_per_cent_are_borne_and_no_more() {
        let known = [figure("a", 100.0, 200.0)];
        let check = |mean, worst| TABLE.compare(&known, &[figure("a", mean, worst)], true);
        assert_eq!(check(105.0, 210.0), Ok(()));
        assert_eq!(check(50.0, 100.0), Ok(()));
        assert!(check(105.2, 200.0).is_err());
        assert!(check(100.0, 211.0).is_err());
    }

    #[test]
    fn what_is_new_or_gone_is_named() {
        let (a, b) = ([figure("a", 1.0, 1.0)], [figure("b", 1.0, 1.0)]);
        let fault = TABLE.compare(&a, &b, true).unwrap_err();
        assert!(fault.contains("b,f32 is not in the table"));
        assert!(fault.contains("a,f32 is no longer measured"));
        assert_eq!(TABLE.compare(&[a, b.clone()].concat(), &b, false), Ok(()));
    }
}
