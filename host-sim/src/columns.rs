//! Columns of the files that a program reads: name, unit and meaning, from which both the
//! headers and their page are written.

/// A column of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Its name in the header.
    pub name: &'static str,
    /// The unit of its numbers; empty where there is none.
    pub unit: &'static str,
    /// What it has.
    pub meaning: &'static str,
}

macro_rules! columns {
    ($($name:literal, $unit:literal, $meaning:literal;)+) => {
        [$($crate::columns::Column { name: $name, unit: $unit, meaning: $meaning },)+]
    };
}
pub(crate) use columns;

pub(crate) fn names(columns: &[Column]) -> Vec<&'static str> {
    columns.iter().map(|column| column.name).collect()
}

#[cfg(feature = "cli")]
pub(crate) fn table(columns: &[Column]) -> String {
    use std::fmt::Write as _;

    let mut table = "| column | unit | meaning |\n|---|---|---|\n".to_owned();
    for column in columns {
        let (name, unit, meaning) = (column.name, column.unit, column.meaning);
        // Writing to a string does not fail.
        let _ = writeln!(table, "| `{name}` | {unit} | {meaning} |");
    }
    table
}
