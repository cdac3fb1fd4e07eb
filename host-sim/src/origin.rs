//! Lines above a table that say where it comes from: `# key = value`, one each.

use std::fmt::Display;
use std::io::{self, Write};

/// What such a line begins with, before a space or its end: a column may be called `#`.
const MARK: &str = "#";

/// What Windows writes before a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// The key of ticks a second: a sample, or a record, is one of a tick.
pub const TICK_HZ: &str = "tick_hz";

/// Where a table comes from.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Origin(Vec<(String, String)>);

impl Origin {
    /// Says one thing more. What is not to be seen, such as an end of a line, becomes a space.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Display) -> Self {
        let value = value.to_string().replace(tactile::name::is_hidden, " ");
        let key = key.replace(tactile::name::is_hidden, " ");
        self.0.push((key, value));
        self
    }

    /// What it says of `key`; the first, if it says it twice.
    pub fn get(&self, key: &str) -> Option<&str> {
        let (_, value) = self.0.iter().find(|(of, _)| of == key)?;
        Some(value)
    }

    /// The ticks a second that it says.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn tick_hz(&self) -> Result<Option<u32>, String> {
        let wrong = |text: &str| format!("{TICK_HZ} is {text:?}, not a whole number above 0");
        let number = |text: &str| text.parse().ok().filter(|hz| *hz > 0);
        let mut said = self.iter().filter(|(key, _)| *key == TICK_HZ);
        let first = said.next().map(|(_, text)| text);
        if let Some((_, other)) = said.find(|(_, text)| Some(*text) != first) {
            let first = first.unwrap_or_default();
            return Err(format!("{TICK_HZ} is {first:?}, and {other:?} below"));
        }
        first
            .map(|text| number(text).ok_or_else(|| wrong(text)))
            .transpose()
    }

    /// What it says, in order: keys and values.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(key, value)| (&**key, &**value))
    }

    /// Writes its lines.
    ///
    /// # Errors
    /// Any of the writer.
    pub fn write(&self, mut to: impl Write) -> io::Result<()> {
        for (key, value) in &self.0 {
            writeln!(to, "{MARK} {key} = {value}")?;
        }
        Ok(())
    }
}

/// Takes the lines that begin with `# ` from the top of a file. Returns what they say, how many
/// there are, and the table below them. A line without `=` is a remark, which says nothing, as a
/// blank one. What a spreadsheet adds is left out: a byte-order mark, quotation marks, and commas
/// behind the text.
pub fn split(file: &[u8]) -> (Origin, u64, &[u8]) {
    let file = file.strip_prefix(BYTE_ORDER_MARK).unwrap_or(file);
    let (mut origin, mut lines, mut rest) = (Origin::default(), 0, file);
    loop {
        let end = rest.iter().position(|byte| *byte == b'\n');
        let (line, below) = rest.split_at(end.map_or(rest.len(), |end| end + 1));
        let line = String::from_utf8_lossy(line);
        let line = line.trim_end().trim_end_matches(',').trim_end();
        let quoted = line
            .strip_prefix('"')
            .and_then(|line| line.strip_suffix('"'));
        let line = quoted.map_or(line.to_owned(), |line| line.replace("\"\"", "\""));
        if line.is_empty() && !below.trim_ascii().is_empty() {
            (lines, rest) = (lines + 1, below);
            continue;
        }
        let Some(said) = line.strip_prefix(MARK) else {
            break;
        };
        if !said.starts_with(' ') && !said.is_empty() {
            break;
        }
        // Others write a colon; of a remark it says nothing.
        let of_rate = |(key, _): &(&str, &str)| key.trim() == TICK_HZ;
        let said = said
            .split_once('=')
            .or(said.split_once(':').filter(of_rate));
        if let Some((key, value)) = said {
            origin = origin.with(key.trim(), value.trim());
        }
        (lines, rest) = (lines + 1, below);
    }
    (origin, lines, rest)
}

/// What is wrong with a file whose table is in a form that no reader here takes: the encoding or
/// what stands between columns.
pub fn foreign(file: &[u8]) -> Option<String> {
    let is_wide = file.starts_with(&[0xff, 0xfe]) || file.starts_with(&[0xfe, 0xff]);
    if is_wide {
        return Some("line 1: the text is in UTF-16; save it as CSV in UTF-8".to_owned());
    }
    let (_, above, table) = split(file);
    let header = table.split(|byte| *byte == b'\n').next()?;
    let (name, _) = [("semicolons", b';'), ("tabs", b'\t')]
        .into_iter()
        .find(|(_, byte)| header.contains(byte) && !header.contains(&b','))?;
    Some(format!(
        "line {}: {name} stand between the columns; allowed: commas, and points in numbers",
        above + 1
    ))
}

#[cfg(test)]
mod tests {
    use super::{Origin, split};

    #[test]
    fn what_is_written_is_read() {
        let origin = Origin::default()
            .with("scene", "my = scene")
            .with("tick_hz", 2000);
        let mut file = Vec::new();
        origin.write(&mut file).unwrap();
        file.extend(b"a,b\n#1,2\n");
        let (read, lines, table) = split(&file);
        assert_eq!((read, lines, table), (origin, 2, &b"a,b\n#1,2\n"[..]));
    }

    #[test]
    fn what_a_spreadsheet_adds_is_left_out() {
        let file = "\u{feff}# tick_hz = 2000,,,,\r\n\"# scene = a,\"\"b\"\"\",,\r\n#,,\r\na,b\r\n";
        let (origin, lines, table) = split(file.as_bytes());
        assert_eq!(origin.get("tick_hz"), Some("2000"));
        assert_eq!(origin.get("scene"), Some("a,\"b\""));
        assert_eq!((lines, table), (3, &b"a,b\r\n"[..]));
    }

    #[test]
    fn remarks_and_a_file_of_nothing_else_are_taken() {
        for rate in ["tick_hz=100", "tick_hz: 100"] {
            let file = format!("# recorded at 10:30\n# {rate}\r\n#");
            let (origin, lines, table) = split(file.as_bytes());
            assert_eq!(origin, Origin::default().with("tick_hz", 100));
            assert_eq!((lines, table), (3, &b""[..]));
        }
        for table in [&b"a\n"[..], b"#,label\n1,a\n", b""] {
            assert_eq!(split(table), (Origin::default(), 0, table));
        }
    }
}
