//! Faults that a module tells of, with their cause and remedy.

use std::fmt::Write as _;

use firmware::faults::{FaultRow, TABLE};

/// A fault that was told of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    /// When, where and which.
    pub(crate) what: String,
    pub(crate) cause: &'static str,
    pub(crate) remedy: String,
}

/// What the table of faults says of a number that a line of the log tells of.
pub(super) fn fault(number: u8, place: &str, text: &str) -> Fault {
    let row: Option<&FaultRow> = TABLE.iter().find(|row| row.number == number);
    let Some(row) = row else {
        return Fault {
            what: format!("{place}{text}"),
            cause: "not in this program's table",
            remedy: "a newer version of this program".to_owned(),
        };
    };
    let kind = text.split(' ').next().unwrap_or("fault");
    Fault {
        what: format!("{place}{kind} {number}: {}", row.name),
        cause: row.causes,
        remedy: plain(row.check),
    }
}

/// A row of the table of faults in plain text.
fn plain(markdown: &str) -> String {
    let mut text = String::new();
    let mut rest = markdown;
    while let Some((before, link)) = rest.split_once('[') {
        text.push_str(before);
        let Some((words, more)) = link.split_once("](") else {
            rest = link;
            continue;
        };
        let (target, more) = more.split_once(')').unwrap_or((more, ""));
        // Writing to a string does not fail.
        let _ = write!(text, "{words} (docs/{target})");
        rest = more;
    }
    text.push_str(rest);
    text.replace(['`', '*'], "")
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn links_and_marks_become_plain() {
        let text = plain("as 20; [every frame](troubleshooting.md#the-sensor), `x` and *y*");
        assert_eq!(
            text,
            "as 20; every frame (docs/troubleshooting.md#the-sensor), x and y"
        );
        assert_eq!(plain("a [b"), "a b");
    }
}
