//! Names of classes, and of all else that goes into tables and onto lines: what none may have.
//!
//! A line's end in a name could forge a line on the serial port, an escape sequence could
//! write over a terminal, and a formula would run in a spreadsheet.

use core::fmt;

/// Why a name is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say it")]
pub enum NameError {
    #[error("has the character {0:?}, which is not to be seen")]
    Hidden(char),
    #[error("begins with {0:?}, as a formula of a spreadsheet does")]
    Formula(char),
}

/// Whether a letter is not to be seen, or changes how others are: control characters, ends of
/// lines and paragraphs, and marks that turn, join or part text without a place of their own.
pub const fn is_hidden(letter: char) -> bool {
    matches!(
        letter,
        '\0'..='\u{1f}'
            | '\u{7f}'..='\u{9f}'
            | '\u{ad}'
            | '\u{61c}'
            | '\u{180e}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{feff}'
            | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e007f}'
    )
}

/// Checks a name.
///
/// # Errors
/// The first thing found wrong.
pub fn check(name: &str) -> Result<(), NameError> {
    if let Some(letter) = name.chars().find(|letter| is_hidden(*letter)) {
        return Err(NameError::Hidden(letter));
    }
    let mut letters = name.chars();
    match letters.next() {
        Some(first @ ('=' | '@')) => Err(NameError::Formula(first)),
        // A number with its sign is one in a spreadsheet too.
        Some(first @ ('+' | '-')) if !letters.all(|c| c.is_ascii_digit() || c == '.') => {
            Err(NameError::Formula(first))
        }
        _ => Ok(()),
    }
}

/// Text whose hidden letters are shown as escapes, such as `\u{1b}`: for messages about what
/// others wrote.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'t>(pub &'t str);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use fmt::Write as _;

        self.0.chars().try_for_each(|letter| match letter {
            '\n' | '\r' | '\t' => letter.escape_default().fmt(f),
            _ if is_hidden(letter) => letter.escape_unicode().fmt(f),
            _ => f.write_char(letter),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{NameError, Shown, check};

    #[test]
    fn names_are_what_can_be_seen() {
        for name in [
            "",
            "ice",
            "rough carpet",
            "sand, wet",
            "Kork-Teppich",
            "毛布",
            "-5",
            "+0.5",
        ] {
            assert_eq!(check(name), Ok(()), "{name:?}");
        }
        let hidden = "\n \r \t \0 \u{1b} \u{7f} \u{85} \u{9b} \u{ad} \u{200b} \u{200d} \u{2028} \
                      \u{2029} \u{202e} \u{2066} \u{feff}";
        for letter in hidden.split(' ').flat_map(str::chars) {
            for name in [format!("{letter}ice"), format!("ice{letter}")] {
                assert_eq!(check(&name), Err(NameError::Hidden(letter)), "{name:?}");
            }
        }
    }

    #[test]
    fn no_name_is_a_formula() {
        for name in [
            "=cmd|' /C calc'!A0",
            "@SUM(1)",
            "+a",
            "-2+3",
            "-ice",
            "=",
            "-1e5",
        ] {
            assert!(matches!(check(name), Err(NameError::Formula(_))), "{name}");
        }
    }

    #[test]
    fn what_is_hidden_is_shown_escaped() {
        let text = "a\u{1b}[31m b\n\u{202e}ä\u{9b}";
        assert_eq!(Shown(text).to_string(), r"a\u{1b}[31m b\n\u{202e}ä\u{9b}");
    }
}
