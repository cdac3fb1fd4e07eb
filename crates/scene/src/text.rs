//! The text of a scene file: line numbers, excerpts, and the list of problems
//! that gathers while it is read.

use std::ops::Range;

use tactile::name::Shown;

use crate::overriding::Override;
use crate::problem::{Problem, Problems};

/// Longest excerpt of the file that a message quotes, in characters.
const LONGEST_EXCERPT: usize = 60;

/// Most problems that are reported singly; the others are counted.
const MOST_PROBLEMS: usize = 100;

/// A file's name and text, with the problems found in it so far. What is given beside the
/// file follows it, so that an offset says where in either something stands.
pub(crate) struct Text<'a> {
    file: &'a str,
    /// The whole file, then a line for each key beside it.
    content: String,
    /// Where each of these begins, and what messages call it.
    beside: Vec<(usize, &'a str)>,
    /// Where the lines of both end, in order.
    ends: Vec<usize>,
    /// Problems with the byte offset they stand at.
    problems: Vec<(usize, Problem)>,
    /// How many more there are.
    more: usize,
}

impl<'a> Text<'a> {
    pub(crate) fn new(file: &'a str, content: &str, overrides: &'a [Override]) -> Self {
        let mut content = content.to_owned();
        let mut beside = Vec::with_capacity(overrides.len());
        for one in overrides {
            content.push('\n');
            beside.push((content.len(), one.source()));
            content.push_str(&one.toml());
        }
        let ends = content.match_indices('\n').map(|(at, _)| at).collect();
        Self {
            file,
            content,
            beside,
            ends,
            problems: Vec::new(),
            more: 0,
        }
    }

    /// Line of the byte at `offset`, from 1; the last line for offsets beyond.
    pub(crate) fn line(&self, offset: usize) -> usize {
        1 + self.ends.partition_point(|end| *end < offset)
    }

    /// What stands at `offset`: the file, with the line, or what is beside it.
    fn place(&self, offset: usize) -> (&'a str, Option<usize>) {
        let mut beside = self.beside.iter().rev();
        match beside.find(|(start, _)| *start <= offset) {
            Some((_, name)) => (name, None),
            None => (self.file, Some(self.line(offset))),
        }
    }

    pub(crate) fn place_in_words(&self, offset: usize) -> String {
        match self.place(offset) {
            (name, Some(line)) => format!("{name}:{line}"),
            (name, None) => name.to_owned(),
        }
    }

    /// The text of a span on one line, shortened and without control characters.
    pub(crate) fn excerpt(&self, span: Range<usize>) -> String {
        one_line(self.content.get(span).unwrap_or_default())
    }

    pub(crate) fn line_at(&self, offset: usize) -> String {
        let line = self.line(offset) - 1;
        let before = line.checked_sub(1).and_then(|last| self.ends.get(last));
        let start = before.map_or(0, |end| end + 1);
        let end = self.ends.get(line).copied().unwrap_or(self.content.len());
        self.excerpt(start..end)
    }

    pub(crate) fn report(&mut self, offset: usize, key: String, found: String, allowed: String) {
        if self.is_full() {
            return self.count();
        }
        let (file, line) = self.place(offset);
        let problem = Problem {
            file: file.to_owned(),
            line,
            key,
            found,
            allowed,
        };
        self.problems.push((offset, problem));
    }

    /// One more, of which nothing else is said.
    pub(crate) fn count(&mut self) {
        self.more += 1;
    }

    /// Whether further problems are only counted.
    pub(crate) fn is_full(&self) -> bool {
        self.problems.len() >= MOST_PROBLEMS
    }

    pub(crate) fn is_clean(&self) -> bool {
        self.problems.is_empty()
    }

    pub(crate) fn into_problems(mut self) -> Problems {
        self.problems.sort_by_key(|(offset, _)| *offset);
        let list = self.problems.into_iter().map(|(_, p)| p).collect();
        Problems::new(list, self.more)
    }

    /// How much of the text is the file, bytes.
    fn in_file(&self) -> usize {
        let first = self.beside.first();
        first.map_or(self.content.len(), |(start, _)| start - 1)
    }

    /// The documents to be parsed, each preceded by as many spaces as put its bytes where
    /// they are in the whole text: the file, then what is beside it.
    pub(crate) fn documents(&self) -> Vec<String> {
        let file = self.in_file();
        let ends = self.beside.iter().skip(1).map(|(start, _)| start - 1);
        let ends = ends.chain([self.content.len()]);
        let beside = self.beside.iter().zip(ends);
        let beside = beside.map(|((start, _), end)| {
            let line = self.content.get(*start..end).unwrap_or_default();
            format!("{:start$}{line}", "")
        });
        let file = self.content.get(..file).unwrap_or_default();
        std::iter::once(file.to_owned()).chain(beside).collect()
    }
}
/// Runs of space become one, what else is not to be seen is shown escaped; long text is cut.
fn one_line(text: &str) -> String {
    // No word of what lies beyond is shown.
    let words = text.split_whitespace().take(LONGEST_EXCERPT + 1);
    let words: Vec<&str> = words.collect();
    let line = Shown(&words.join(" ")).to_string();
    if line.chars().count() <= LONGEST_EXCERPT {
        return line;
    }
    let start: String = line.chars().take(LONGEST_EXCERPT).collect();
    format!("{start}…")
}
