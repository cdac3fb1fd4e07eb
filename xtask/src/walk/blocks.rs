//! The command blocks of a page, and what they are shown to print.

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

use crate::run::Fault;

/// When a block is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum When {
    /// `sh`: by CI.
    Always,
    /// `sh nightly`: by the nightly run, as it takes long.
    Nightly,
    /// `sh hardware`: by its reader alone, as it needs a board or a probe.
    Hardware,
}

impl When {
    pub(crate) fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

/// Commands of a page that are done one after the other.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Block {
    pub(crate) when: When,
    /// The line of the page where it begins, from 1.
    pub(crate) line: usize,
    pub(crate) commands: String,
    /// What the `text output` block after it shows that they print.
    pub(crate) shown: Option<String>,
}

/// The command blocks of `text`, in their order. A fault begins with its line.
pub(crate) fn blocks(text: &str) -> Result<Vec<Block>, Fault> {
    let mut found: Vec<Block> = Vec::new();
    let mut events = Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter();
    while let Some((event, range)) = events.next() {
        let Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) = event else {
            continue;
        };
        let line = 1 + text[..range.start].matches('\n').count();
        let mut inside = String::new();
        for (event, _) in events.by_ref() {
            match event {
                Event::Text(part) => inside.push_str(&part),
                Event::End(TagEnd::CodeBlock) => break,
                _ => {}
            }
        }
        let when = match &*info {
            "sh" => When::Always,
            "sh nightly" => When::Nightly,
            "sh hardware" => When::Hardware,
            "text output" => {
                let before = found.last_mut().filter(|block| block.shown.is_none());
                let before = before.ok_or_else(|| format!("{line}: an output of nothing"))?;
                before.shown = Some(inside);
                continue;
            }
            "text" | "toml" | "rust" | "csv" | "python" => continue,
            other => {
                return Err(format!(
                    "{line}: found ```{other}; allowed: sh, sh nightly, sh hardware, \
                     text output, text, toml, rust, csv, python"
                ));
            }
        };
        found.push(Block {
            when,
            line,
            commands: inside,
            shown: None,
        });
    }
    Ok(found)
}

pub(crate) fn pages(summary: &str) -> Vec<String> {
    let links = Parser::new(summary).filter_map(|event| match event {
        Event::Start(Tag::Link { dest_url, .. }) => Some(dest_url.into_string()),
        _ => None,
    });
    links.collect()
}

/// The first line of `shown` that `said` does not hold, after those before it. An ellipsis
/// stands for anything in its line.
pub(crate) fn differs(shown: &str, said: &str) -> Option<String> {
    let mut said = said.lines();
    let mut shown = shown.lines().filter(|line| !line.trim().is_empty());
    let missed = shown.find(|line| !said.any(|said| is_like(line.trim(), said.trim())));
    missed.map(str::to_owned)
}

/// Whether `said` is `shown`, whose ellipses stand for anything.
fn is_like(shown: &str, said: &str) -> bool {
    let mut parts = shown.split('…');
    let Some(rest) = parts.next().and_then(|first| said.strip_prefix(first)) else {
        return false;
    };
    let Some(last) = parts.next_back() else {
        return rest.is_empty();
    };
    let after = parts.try_fold(rest, |rest, part| Some(rest.split_once(part)?.1));
    after.is_some_and(|rest| rest.ends_with(last))
}

#[cfg(test)]
mod tests {
    use super::{Block, When, blocks, differs, pages};

    #[test]
    fn blocks_are_found_with_what_they_print() {
        let text = "```sh\na \\\n  b\n```\nSo:\n```text output\nc\n```\n\n1. x\n   ```sh hardware\n   d\n   ```\n\
                    ```toml\ne\n```\n```sh nightly\nf\n```\n";
        let block = |when, line, commands: &str, shown: Option<&str>| Block {
            when,
            line,
            commands: commands.to_owned(),
            shown: shown.map(str::to_owned),
        };
        let expected = [
            block(When::Always, 1, "a \\\n  b\n", Some("c\n")),
            block(When::Hardware, 11, "d\n", None),
            block(When::Nightly, 17, "f\n", None),
        ];
        assert_eq!(blocks(text).unwrap(), expected);
    }

    #[test]
    fn a_block_that_nothing_would_run_is_refused() {
        for text in [
            "x\n```bash\na\n```\n",
            "x\n```sh nigthly\na\n```\n",
            "x\n```text output\na\n```\n",
        ] {
            let fault = blocks(text).unwrap_err();
            assert!(fault.starts_with("2: "), "{fault}");
        }
    }

    #[test]
    fn what_is_shown_is_compared_line_by_line() {
        let said = "Compiling\nseed 7 took 12 s\nrest\n12 lost\n";
        assert_eq!(differs("seed … took … s\n…\n12 lost\n", said), None);
        for (shown, missed) in [
            ("seed 8 …\n", "seed 8 …"),
            ("12 lost\nrest\n", "rest"),
            ("2 lost\n", "2 lost"),
            ("12 los\n", "12 los"),
            ("seed … took … ms\n", "seed … took … ms"),
        ] {
            assert_eq!(differs(shown, said).as_deref(), Some(missed));
        }
    }

    #[test]
    fn the_pages_of_a_summary_are_its_links() {
        let summary = "# S\n\n[A](a.md)\n\n# Part\n- [B](b.md)\n  - [C](c/d.md)\n";
        assert_eq!(pages(summary), ["a.md", "b.md", "c/d.md"]);
    }
}
