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
    /// The number of the touch of the module's first whisker; 0 in the air.
    pub touch: u16,
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

/// Writes rows to `W`, which should be buffered.
#[derive(Debug)]
pub struct TraceWriter<W> {
    table: W,
    line: Vec<u8>,
}

impl<W: Write> TraceWriter<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// Any error of the writer.
    pub fn new(mut table: W) -> io::Result<Self> {
        writeln!(table, "{HEADER}")?;
        Ok(Self {
            table,
            line: Vec::new(),
        })
    }

    /// One row, with the name of what was decided in its tick. Nine decimals show the
    /// error of the integrators; the cells of a side that does not exist are empty, and
    /// so is that of a decision where none fell.
    ///
    /// # Errors
    /// Any error of the writer.
    pub fn row(&mut self, row: &Row, decision: Option<&str>) -> io::Result<()> {
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
        cell(line, row.touch.into(), 0);
        line.push(b',');
        text(line, decision.unwrap_or_default());
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
    use super::{HEADER, Row, TraceWriter};

    #[test]
    fn rows_have_as_many_cells_as_the_header_and_the_fixed_ones_first() {
        let mut table = TraceWriter::new(Vec::new()).unwrap();
        let row = Row {
            t_s: 0.0005,
            theta_deg: [50.0, f64::NAN],
            z: [0.25, f64::NAN],
            g: [1.0, f64::NAN],
            contact: [0.0, f64::NAN],
            angle_deg: [50.5, f64::NAN],
            x: [8192.0, f64::NAN],
            y: [8191.0, f64::NAN],
            touch: 7,
        };
        for decision in [None, Some("unknown"), Some("sand, \"wet\"")] {
            table.row(&row, decision).unwrap();
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
}
