//! `trace.csv`: what a module did, one row for each tick.

mod header;

use std::io::{self, Write};

use crate::cells::{Cells, Line};

pub use header::{FIRST, OF_ELASTIC, OF_RIGHT, OF_WHISKER, SECOND, TraceShape};

/// One tick of a module. Values of a side that does not exist are NaN.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Row {
    /// End of the tick, s; the first row is at 1/tick_hz.
    pub t_s: f64,
    /// θ' of the first whisker of each side, degrees: the setpoint.
    pub theta_deg: [f64; 2],
    /// z of each side.
    pub z: [f64; 2],
    /// g of the first whisker of each side.
    pub g: [f64; 2],
    /// Contact π of each side.
    pub contact: [f64; 2],
    /// Measured angle of the first whisker of each side, degrees.
    pub angle_deg: [f64; 2],
    /// The 14-bit codes of x of the first whisker of each side.
    pub x: [f64; 2],
    /// The 14-bit codes of y of the first whisker of each side.
    pub y: [f64; 2],
    /// The number of the touch of the first whisker of each side; 0 in the air, and where
    /// it is not heard.
    pub touch: [u16; 2],
}

impl Row {
    /// All its values but time and touch, in the order of the columns.
    pub const fn pairs(&self) -> [[f64; 2]; 7] {
        [
            self.theta_deg,
            self.z,
            self.g,
            self.contact,
            self.angle_deg,
            self.x,
            self.y,
        ]
    }
}

/// One whisker after a tick. What it does not have, or is unknown, is NaN.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WhiskerRow {
    /// Setpoint θ', degrees.
    pub theta_deg: f64,
    /// Angle as it is, degrees.
    pub angle_deg: f64,
    /// Speed as it is, degrees a second.
    pub speed_deg_s: f64,
    /// Duty at its driver's pins, -1 to 1.
    pub duty: f64,
    /// The 14-bit codes of x and y.
    pub codes: [f64; 2],
    /// Contact π.
    pub contact: f64,
    /// Number of the fault that holds it; 0: none.
    pub fault: f64,
    /// Where its shaft touches: arc length from the base, m.
    pub touch_at_m: f64,
    /// Where that is on the surface, along its first coordinate, m.
    pub place_m: f64,
}

/// Everything that a trace has of a tick.
#[derive(Debug, Clone, Copy)]
pub struct TraceLine<'a> {
    /// Of sides and their first whiskers.
    pub row: &'a Row,
    /// What a whisker of each side decided.
    pub decisions: [Option<&'a str>; 2],
    /// What is in place, and how often it has been before.
    pub presented: (&'a str, u64),
    /// Every whisker, left side first.
    pub whiskers: &'a [WhiskerRow],
}

impl TraceLine<'_> {
    /// Gives the cells of its row. Nine decimals show the error of the integrators; the cells of
    /// a side that does not exist are none, and that of a decision is empty where none fell.
    pub fn cells(&self, shape: TraceShape, to: &mut impl Cells) {
        to.number(self.row.t_s, 9);
        let pairs = self.row.pairs();
        let (precise, codes) = pairs.as_flattened().split_at(10);
        to.numbers(precise, 9);
        to.numbers(codes, 0);
        let sides = self.row.touch.into_iter().zip(self.decisions);
        for (touch, decision) in sides.take(1 + usize::from(shape.hears_right)) {
            to.number(touch.into(), 0);
            to.text(decision.unwrap_or_default());
        }
        let (label, trial) = self.presented;
        to.text(label);
        to.number(trial as f64, 0);
        let mut sides = self.whiskers.chunks(shape.whiskers_per_side.max(1));
        let first = [sides.next(), sides.next()].map(|side| side.and_then(<[_]>::first));
        let mut pair = |value: fn(&WhiskerRow) -> f64, decimals| {
            to.numbers(
                &first.map(|whisker| whisker.map_or(f64::NAN, value)),
                decimals,
            );
        };
        pair(|whisker| whisker.speed_deg_s, 3);
        pair(|whisker| whisker.duty, 6);
        pair(|whisker| whisker.fault, 0);
        for side in self.whiskers.chunks(shape.whiskers_per_side.max(1)) {
            for whisker in side.iter().skip(1) {
                to.numbers(&[whisker.theta_deg, whisker.angle_deg], 6);
                to.number(whisker.speed_deg_s, 3);
                to.number(whisker.duty, 6);
                to.numbers(&whisker.codes, 0);
                to.number(whisker.contact, 6);
                to.number(whisker.fault, 0);
            }
        }
        for first in first.into_iter().take(shape.elastic_sides()) {
            let touched = first.map(|whisker| [whisker.touch_at_m, whisker.place_m]);
            to.numbers(&touched.unwrap_or([f64::NAN; 2]), 9);
        }
    }
}

/// Writes rows to `W`, which should be buffered.
#[derive(Debug)]
pub struct TraceWriter<W> {
    table: W,
    shape: TraceShape,
    line: Line,
}

impl<W: Write> TraceWriter<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// Any error of the writer.
    pub fn new(mut table: W, shape: TraceShape) -> io::Result<Self> {
        writeln!(table, "{}", shape.names().join(","))?;
        let line = Line::default();
        Ok(Self { table, shape, line })
    }

    /// One line; the cells of what is none are empty.
    ///
    /// # Errors
    /// Any error of the writer.
    pub fn line(&mut self, of: &TraceLine<'_>) -> io::Result<()> {
        of.cells(self.shape, &mut self.line);
        self.line.write(&mut self.table)
    }

    /// The writer, for who takes out of it what was written.
    pub const fn inner_mut(&mut self) -> &mut W {
        &mut self.table
    }

    /// The writer.
    pub fn into_inner(self) -> W {
        self.table
    }
}

#[cfg(test)]
mod tests {
    use super::{
        FIRST, OF_ELASTIC, OF_WHISKER, Row, SECOND, TraceLine, TraceShape, TraceWriter, WhiskerRow,
    };

    fn whisker(n: f64) -> WhiskerRow {
        WhiskerRow {
            theta_deg: 50.0 + n,
            angle_deg: 60.0 + n,
            speed_deg_s: -7.5,
            duty: 0.25,
            codes: [8192.0, 8190.0],
            contact: 0.125,
            fault: n,
            touch_at_m: 0.1,
            place_m: f64::NAN,
        }
    }

    fn written<'t>(
        shape: TraceShape,
        lines: impl IntoIterator<Item = TraceLine<'t>>,
    ) -> Vec<String> {
        let mut table = TraceWriter::new(Vec::new(), shape).unwrap();
        for line in lines {
            table.line(&line).unwrap();
        }
        let text = String::from_utf8(table.into_inner()).unwrap();
        text.lines().map(str::to_owned).collect()
    }

    /// Elastic whiskers end their rows with where they touch.
    #[test]
    fn every_whisker_of_both_sides_has_cells_of_its_own() {
        let shape = TraceShape {
            sides: 2,
            whiskers_per_side: 2,
            hears_right: true,
            is_elastic: true,
        };
        let row = Row {
            touch: [7, 9],
            ..Row::default()
        };
        let whiskers = [0.0, 1.0, 2.0, 3.0].map(whisker);
        let ticks =
            [[None, Some("ice, \"wet\"")], [Some("loam"), None]].map(|decisions| TraceLine {
                row: &row,
                decisions,
                presented: ("free", 0),
                whiskers: &whiskers,
            });
        let lines = written(shape, ticks);
        let header: Vec<&str> = lines[0].split(',').collect();
        let elastic = OF_ELASTIC.map(|column| column.name);
        let count = FIRST.len() + 2 + SECOND.len() + 2 * OF_WHISKER.len() + elastic.len();
        assert_eq!(header.len(), count);
        let heard = ["touch", "decision", "touch_right", "decision_right"];
        assert_eq!(header[15..19], heard);
        assert_eq!(header[27..29], ["theta_left_2_deg", "angle_left_2_deg"]);
        assert_eq!(header[34..36], ["fault_left_2", "theta_right_2_deg"]);
        assert_eq!(header[42..], [&["fault_right_2"][..], &elastic].concat());
        assert_eq!(lines[2].split(',').count(), count, "{}", lines[2]);
        for (line, heard) in lines[1..]
            .iter()
            .zip([",7,,9,\"ice, \"\"wet\"\"\",", ",7,loam,9,,"])
        {
            assert!(line.contains(heard), "{line}");
            let more = "free,0,-7.500,-7.500,0.250000,0.250000,0,2,\
                        51.000000,61.000000,-7.500,0.250000,8192,8190,0.125000,1,\
                        53.000000,63.000000,-7.500,0.250000,8192,8190,0.125000,3,\
                        0.100000000,,0.100000000,";
            assert!(line.ends_with(more), "{line}");
        }
        let one_side = TraceShape { sides: 1, ..shape };
        assert_eq!(one_side.names()[35..], elastic[..2]);
    }
}
