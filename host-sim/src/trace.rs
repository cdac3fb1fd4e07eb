//! `trace.csv`: what a module did, a row a tick.

mod decimals;

use std::io::Write;
use std::path::Path;

use crate::{Error, output::Output};

/// One tick of a module. Values of a side that is not there are not a number.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Row {
    /// End of the tick, s; the first row is at 1/tick_hz.
    pub t_s: f64,
    /// θ' of the first whisker of each side, degrees: where it should be.
    pub theta_deg: [f64; 2],
    /// z of each side.
    pub z: [f64; 2],
    /// g of the first whisker of each side.
    pub g: [f64; 2],
    /// Contact π of each side.
    pub contact: [f64; 2],
    /// Where the first whisker of each side is, degrees.
    pub angle_deg: [f64; 2],
    /// The 14-bit codes of x of the first whisker of each side.
    pub x: [f64; 2],
    /// The 14-bit codes of y of the first whisker of each side.
    pub y: [f64; 2],
}

/// The columns in order. The first nine are fixed: other programs read them.
pub const HEADER: &str = "t_s,theta_left_deg,theta_right_deg,z_left,z_right,g_left,g_right,\
contact_left,contact_right,angle_left_deg,angle_right_deg,x_left,x_right,y_left,y_right";

/// Writes rows; nothing is left of a trace that is not finished.
#[derive(Debug)]
pub struct TraceFile {
    output: Output,
    line: Vec<u8>,
}

impl TraceFile {
    /// Begins a trace.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn create(path: &Path) -> Result<Self, Error> {
        let mut output = Output::create(path)?;
        writeln!(output, "{HEADER}").map_err(|source| output.failed(source))?;
        Ok(Self {
            output,
            line: Vec::new(),
        })
    }

    /// One row. Nine decimals show the error of the integrators; the cells of
    /// a side that is not there are empty.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn row(&mut self, row: &Row) -> Result<(), Error> {
        let line = &mut self.line;
        line.clear();
        decimals::append(line, row.t_s, 9);
        let precise = [row.theta_deg, row.z, row.g, row.contact, row.angle_deg];
        for value in precise.as_flattened() {
            cell(line, *value, 9);
        }
        for value in [row.x, row.y].as_flattened() {
            cell(line, *value, 0);
        }
        line.push(b'\n');
        self.output
            .write_all(line)
            .map_err(|source| self.output.failed(source))
    }

    /// Puts the trace in its place.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn finish(self) -> Result<(), Error> {
        self.output.finish()
    }
}

fn cell(line: &mut Vec<u8>, value: f64, decimals: u32) {
    line.push(b',');
    if !value.is_nan() {
        decimals::append(line, value, decimals);
    }
}

#[cfg(test)]
mod tests {
    use super::{HEADER, Row, TraceFile};

    #[test]
    fn rows_have_as_many_cells_as_the_header_and_the_fixed_ones_first() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trace.csv");
        let mut file = TraceFile::create(&path).unwrap();
        file.row(&Row {
            t_s: 0.0005,
            theta_deg: [50.0, f64::NAN],
            z: [0.25, f64::NAN],
            g: [1.0, f64::NAN],
            contact: [0.0, f64::NAN],
            angle_deg: [50.5, f64::NAN],
            x: [8192.0, f64::NAN],
            y: [8191.0, f64::NAN],
        })
        .unwrap();
        file.finish().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<_> = text.lines().collect();
        assert!(HEADER.starts_with(
            "t_s,theta_left_deg,theta_right_deg,z_left,z_right,g_left,g_right,\
             contact_left,contact_right"
        ));
        assert_eq!(lines[0], HEADER);
        assert_eq!(
            lines[1],
            "0.000500000,50.000000000,,0.250000000,,1.000000000,,0.000000000,,\
             50.500000000,,8192,,8191,"
        );
    }
}
