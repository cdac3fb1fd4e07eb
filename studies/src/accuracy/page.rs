//! A page in the making: text, tables and the pictures beside it.

use std::fmt::{Display, Write};

/// Markdown and the files that it shows, by name.
#[derive(Debug, Default)]
pub(crate) struct Page {
    pub(crate) text: String,
    pub(crate) files: Vec<(String, String)>,
}

impl Page {
    /// A paragraph.
    pub(crate) fn say(&mut self, paragraph: impl Display) {
        // Writing to a string does not fail.
        let _ = write!(self.text, "{paragraph}\n\n");
    }

    /// A heading of its level.
    pub(crate) fn heading(&mut self, level: usize, heading: &str) {
        self.say(format_args!("{} {heading}", "#".repeat(level)));
    }

    /// A table; `header` cells are divided by `|`.
    pub(crate) fn table(&mut self, header: &str, rows: impl IntoIterator<Item = Vec<String>>) {
        let columns = header.split('|').count();
        let _ = writeln!(self.text, "| {} |", header.trim());
        let _ = writeln!(self.text, "|{}", "---|".repeat(columns));
        for row in rows {
            let _ = writeln!(self.text, "| {} |", row.join(" | "));
        }
        self.text.push('\n');
    }

    /// A picture in the folder `accuracy` beside the page.
    pub(crate) fn picture(&mut self, name: &str, what: &str, svg: String) {
        self.picture_in("accuracy", name, what, svg);
    }

    /// A picture in a folder beside the page.
    pub(crate) fn picture_in(&mut self, folder: &str, name: &str, what: &str, svg: String) {
        self.say(format_args!("![{what}]({folder}/{name})"));
        self.files.push((format!("{folder}/{name}"), svg));
    }
}

/// Two digits and an exponent.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if (0.1..1000.0).contains(&value.abs()) {
        format!("{value:.2}")
    } else {
        format!("{value:.1e}")
    }
}

/// A cell for a goal.
pub(crate) fn verdict(met: bool) -> &'static str {
    if met { "met" } else { "**missed**" }
}

#[cfg(test)]
mod tests {
    use super::{Page, short};

    #[test]
    fn a_table_has_a_rule_of_its_width() {
        let mut page = Page::default();
        page.table("a | b", [vec!["1".to_owned(), short(2.5e-4)]]);
        assert_eq!(page.text, "| a | b |\n|---|---|\n| 1 | 2.5e-4 |\n\n");
    }
}
