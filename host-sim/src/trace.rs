//! `trace.csv`: what a module did, one row for each tick.

mod decimals;

use std::io::{self, Write};

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

/// The columns in order. The first nine are fixed: other programs read them.
pub const HEADER: &str = "t_s,theta_left_deg,theta_right_deg,z_left,z_right,g_left,g_right,\
contact_left,contact_right,angle_left_deg,angle_right_deg,x_left,x_right,y_left,y_right,touch,\
decision";

/// Further columns where whiskers of the right side are heard: `touch` and `decision` are
/// then of the left side.
pub const OF_RIGHT: &str = ",touch_right,decision_right";

/// Writes rows to `W`, which should be buffered.
#[derive(Debug)]
pub struct TraceWriter<W> {
    table: W,
    /// How many sides are heard.
    sides: usize,
    line: Vec<u8>,
}

impl<W: Write> TraceWriter<W> {
    /// Writes the header; `hears_right`: whether whiskers of the right side are heard.
    ///
    /// # Errors
    /// Any error of the writer.
    pub fn new(mut table: W, hears_right: bool) -> io::Result<Self> {
        let more = if hears_right { OF_RIGHT } else { "" };
        writeln!(table, "{HEADER}{more}")?;
        Ok(Self {
            table,
            sides: 1 + usize::from(hears_right),
            line: Vec::new(),
        })
    }

    /// One row, with the name of what a whisker of each side decided in its tick. Nine
    /// decimals show the error of the integrators; the cells of a side that does not exist
    /// are empty, and so is that of a decision where none fell.
    ///
    /// # Errors
    /// Any error of the writer.
    pub fn row(&mut self, row: &Row, decisions: [Option<&str>; 2]) -> io::Result<()> {
        let line = &mut self.line;
        line.clear();
        decimals::append(line, row.t_s, 9);
        let pairs = row.pairs();
        let (precise, codes) = pairs.as_flattened().split_at(10);
        for value in precise {
            cell(line, *value, 9);
        }
        for value in codes {
            cell(line, *value, 0);
        }
        let sides = row.touch.into_iter().zip(decisions);
        for (touch, decision) in sides.take(self.sides) {
            cell(line, touch.into(), 0);
            line.push(b',');
            text(line, decision.unwrap_or_default());
        }
        line.push(b'\n');
        self.table.write_all(line)
    }

    /// The writer.
    pub fn into_inner(self) -> W {
        self.table
    }
}

fn cell(line: &mut Vec<u8>, value: f64, decimals: u32) {
    line.push(b',');
    if !value.is_nan() {
        decimals::append(line, value, decimals);
    }
}

/// A text, in quotes where a table asks for them.
fn text(line: &mut Vec<u8>, text: &str) {
    if text.contains([',', '"', '\n', '\r']) {
        line.push(b'"');
        line.extend(text.replace('"', "\"\"").bytes());
        line.push(b'"');
    } else {
        line.extend(text.bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::{HEADER, OF_RIGHT, Row, TraceWriter};

    #[test]
    fn rows_have_as_many_cells_as_the_header_and_the_fixed_ones_first() {
        let mut table = TraceWriter::new(Vec::new(), false).unwrap();
        let row = Row {
            t_s: 0.0005,
            theta_deg: [50.0, f64::NAN],
            z: [0.25, f64::NAN],
            g: [1.0, f64::NAN],
            contact: [0.0, f64::NAN],
            angle_deg: [50.5, f64::NAN],
            x: [8192.0, f64::NAN],
            y: [8191.0, f64::NAN],
            touch: [7, 0],
        };
        for decision in [None, Some("unknown"), Some("sand, \"wet\"")] {
            table.row(&row, [decision, None]).unwrap();
        }
        let text = String::from_utf8(table.into_inner()).unwrap();
        let lines: Vec<_> = text.lines().collect();
        assert!(HEADER.starts_with(
            "t_s,theta_left_deg,theta_right_deg,z_left,z_right,g_left,g_right,\
             contact_left,contact_right"
        ));
        assert_eq!(lines[0], HEADER);
        assert_eq!(
            lines[1],
            "0.000500000,50.000000000,,0.250000000,,1.000000000,,0.000000000,,\
             50.500000000,,8192,,8191,,7,"
        );
        assert!(lines[2].ends_with(",7,unknown"));
        assert!(lines[3].ends_with(",7,\"sand, \"\"wet\"\"\""));
    }

    #[test]
    fn the_right_side_has_cells_of_its_own_where_it_is_heard() {
        let mut table = TraceWriter::new(Vec::new(), true).unwrap();
        let row = Row {
            touch: [7, 9],
            ..Row::default()
        };
        table.row(&row, [None, Some("ice")]).unwrap();
        table.row(&row, [Some("loam"), None]).unwrap();
        let text = String::from_utf8(table.into_inner()).unwrap();
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines[0], format!("{HEADER}{OF_RIGHT}"));
        assert!(lines[1].ends_with(",7,,9,ice") && lines[2].ends_with(",7,loam,9,"));
    }
}
