//! The cells of a table's row, whatever they become.

mod decimals;

use std::io::{self, Write};

/// Takes the cells of a row in the order of its columns.
pub trait Cells {
    /// A number, as text with so many decimals; not a number: none.
    fn number(&mut self, value: f64, decimals: u32);
    /// A text.
    fn text(&mut self, text: &str);

    /// Numbers with as many decimals each.
    fn numbers(&mut self, values: &[f64], decimals: u32) {
        for value in values {
            self.number(*value, decimals);
        }
    }
}

#[derive(Debug, Default)]
pub(crate) struct Line(Vec<u8>);

impl Line {
    pub(crate) fn write(&mut self, table: &mut impl Write) -> io::Result<()> {
        // In place of the comma behind the last cell.
        self.0.pop();
        self.0.push(b'\n');
        let written = table.write_all(&self.0);
        self.0.clear();
        written
    }
}

impl Cells for Line {
    fn number(&mut self, value: f64, decimals: u32) {
        if !value.is_nan() {
            decimals::append(&mut self.0, value, decimals);
        }
        self.0.push(b',');
    }

    /// In quotes where a table asks for them.
    fn text(&mut self, text: &str) {
        if text.contains([',', '"', '\n', '\r']) {
            self.0.push(b'"');
            self.0.extend(text.replace('"', "\"\"").bytes());
            self.0.push(b'"');
        } else {
            self.0.extend(text.bytes());
        }
        self.0.push(b',');
    }
}
