//! The text of a scene file: line numbers, excerpts, and the list of problems
//! that gathers while it is read.

use std::ops::Range;

use crate::problem::{Problem, Problems};

/// Longest excerpt of the file that a message quotes, in characters.
const LONGEST_EXCERPT: usize = 60;

/// A file's name and text, with the problems found in it so far.
pub(crate) struct Text<'a> {
    file: &'a str,
    /// The whole file.
    content: &'a str,
    /// Problems with the byte offset they stand at.
    problems: Vec<(usize, Problem)>,
}

impl<'a> Text<'a> {
    pub(crate) fn new(file: &'a str, content: &'a str) -> Self {
        Self {
            file,
            content,
            problems: Vec::new(),
        }
    }

    /// Line of the byte at `offset`, from 1; the last line for offsets beyond.
    pub(crate) fn line(&self, offset: usize) -> usize {
        let before = self.content.bytes().take(offset);
        1 + before.filter(|byte| *byte == b'\n').count()
    }

    /// The text of a span on one line, shortened and without control characters.
    pub(crate) fn excerpt(&self, span: Range<usize>) -> String {
        one_line(self.content.get(span).unwrap_or_default())
    }

    /// The whole line around the byte at `offset`, as an excerpt.
    pub(crate) fn line_at(&self, offset: usize) -> String {
        let line = self.line(offset).saturating_sub(1);
        one_line(self.content.split('\n').nth(line).unwrap_or_default())
    }

    /// Notes a problem at a byte offset.
    pub(crate) fn report(&mut self, offset: usize, key: String, found: String, allowed: String) {
        let problem = Problem {
            file: self.file.to_owned(),
            line: Some(self.line(offset)),
            key,
            found,
            allowed,
        };
        self.problems.push((offset, problem));
    }

    /// Whether no problem was noted.
    pub(crate) fn is_clean(&self) -> bool {
        self.problems.is_empty()
    }

    /// All problems noted, in file order.
    pub(crate) fn into_problems(mut self) -> Problems {
        self.problems.sort_by_key(|(offset, _)| *offset);
        Problems::new(self.problems.into_iter().map(|(_, p)| p).collect())
    }
}

/// Control characters become spaces, runs of space one; long text is cut.
fn one_line(text: &str) -> String {
    let plain: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    let words: Vec<&str> = plain.split_whitespace().collect();
    let line = words.join(" ");
    if line.chars().count() <= LONGEST_EXCERPT {
        return line;
    }
    let start: String = line.chars().take(LONGEST_EXCERPT).collect();
    format!("{start}…")
}
