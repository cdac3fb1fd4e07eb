//! Links and images of pages, and whether what they lead to is there.

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use mdbook_driver::errors::{Error, Result};
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// A link or an image of a page, where it stands.
pub(crate) struct Link {
    /// The bytes of the page that are the link.
    pub(crate) range: Range<usize>,
    /// Where it leads, as written.
    pub(crate) to: String,
    pub(crate) is_image: bool,
    /// What it is shown as, in Markdown.
    pub(crate) shown: String,
}

/// Links and images of `text`, in their order.
pub(crate) fn links(text: &str) -> Vec<Link> {
    let mut found: Vec<Link> = Vec::new();
    let mut open: Vec<(usize, Option<Range<usize>>)> = Vec::new();
    for (event, range) in parse(text) {
        match event {
            Event::Start(tag @ (Tag::Link { .. } | Tag::Image { .. })) => {
                let is_image = matches!(tag, Tag::Image { .. });
                let (Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) = tag else {
                    continue;
                };
                open.push((found.len(), None));
                found.push(Link {
                    range,
                    to: dest_url.into_string(),
                    is_image,
                    shown: String::new(),
                });
            }
            Event::End(TagEnd::Link | TagEnd::Image) => {
                if let Some((index, Some(inside))) = open.pop() {
                    found[index].shown = text[inside].to_owned();
                }
            }
            _ => {
                for (_, inside) in &mut open {
                    let before = inside.take().unwrap_or(range.clone());
                    *inside = Some(before.start..before.end.max(range.end));
                }
            }
        }
    }
    found
}

/// The anchors of the headings of `text`: as GitHub and mdBook make them.
fn anchors(text: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut heading: Option<String> = None;
    for (event, _) in parse(text) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                let anchor = heading.take().unwrap_or_default();
                let times = seen.entry(anchor.clone()).or_default();
                found.push(match times {
                    0 => anchor,
                    ref times => format!("{anchor}-{times}"),
                });
                *times += 1;
            }
            Event::Text(text) | Event::Code(text) => {
                if let Some(anchor) = &mut heading {
                    let kept = text.to_lowercase();
                    let kept = kept.chars().filter_map(|letter| match letter {
                        ' ' => Some('-'),
                        '-' | '_' => Some(letter),
                        _ => letter.is_alphanumeric().then_some(letter),
                    });
                    anchor.extend(kept);
                }
            }
            _ => {}
        }
    }
    found
}

fn parse(text: &str) -> impl Iterator<Item = (Event<'_>, Range<usize>)> {
    Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter()
}

pub(crate) fn is_foreign(to: &str) -> bool {
    to.contains("://") || to.starts_with("mailto:")
}

/// A path without `.` and `..`; none, if it leads above its start.
pub(crate) fn plain(path: &Path) -> Option<PathBuf> {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => plain.push(name),
            Component::CurDir => {}
            Component::ParentDir => {
                if !plain.pop() {
                    return None;
                }
            }
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(plain)
}

/// The pages of the book, and those beside it, by their paths from the top of the workspace.
pub(crate) struct Pages<'a> {
    top: &'a Path,
    src: &'a Path,
    in_book: Vec<PathBuf>,
    texts: BTreeMap<PathBuf, String>,
}

impl<'a> Pages<'a> {
    pub(crate) fn read(
        top: &'a Path,
        src: &'a Path,
        in_book: Vec<PathBuf>,
        beside: &[&str],
    ) -> Result<Self> {
        let mut texts = BTreeMap::new();
        for path in in_book
            .iter()
            .cloned()
            .chain(beside.iter().map(PathBuf::from))
        {
            let text = fs::read_to_string(top.join(&path))
                .map_err(|error| Error::msg(format!("{}: {error}", path.display())))?;
            texts.insert(path, text);
        }
        Ok(Self {
            top,
            src,
            in_book,
            texts,
        })
    }

    /// What is broken: a line each, with file and line. A page that the book leaves out is
    /// one, too.
    pub(crate) fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (page, text) in &self.texts {
            for link in links(text) {
                if let Some(fault) = self.fault(page, &link) {
                    let line = 1 + text[..link.range.start].matches('\n').count();
                    faults.push(format!("{}:{line}: {}: {fault}", page.display(), link.to));
                }
            }
        }
        faults.extend(self.left_out());
        faults
    }

    fn fault(&self, page: &Path, link: &Link) -> Option<String> {
        if is_foreign(&link.to) {
            return None;
        }
        let (path, anchor) = link.to.split_once('#').unwrap_or((&link.to, ""));
        let target = match path {
            "" => Some(page.to_owned()),
            path => plain(&page.parent().unwrap_or(Path::new("")).join(path)),
        };
        let Some(target) = target.filter(|target| self.top.join(target).exists()) else {
            return Some("there is no such file".to_owned());
        };
        let from_book = self.in_book.iter().any(|known| known == page);
        if from_book && link.is_image && !target.starts_with(self.src) {
            return Some(format!(
                "an image of the book belongs into {}",
                self.src.display()
            ));
        }
        if from_book && target.starts_with(self.src) && self.top.join(&target).is_dir() {
            return Some("a folder; a book leads to pages".to_owned());
        }
        if anchor.is_empty() {
            return None;
        }
        let Ok(text) = fs::read_to_string(self.top.join(&target)) else {
            return Some("no text, so that it has no heading".to_owned());
        };
        let known = anchors(&text);
        let is_there = known.iter().any(|known| known == anchor);
        (!is_there).then(|| format!("no such heading; there are {}", known.join(", ")))
    }

    fn left_out(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut folders = vec![self.top.join(self.src)];
        while let Some(folder) = folders.pop() {
            let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
            for path in entries.map(|entry| entry.path()) {
                let name = path.strip_prefix(self.top).unwrap_or(&path).to_owned();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "md")
                    && !name.ends_with("SUMMARY.md")
                    && !self.in_book.contains(&name)
                {
                    found.push(format!("{}: not named in SUMMARY.md", name.display()));
                }
            }
        }
        found.sort();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::{Pages, anchors, links};
    use std::fs;
    use std::path::{Path, PathBuf};

    #[test]
    fn links_are_found_with_what_they_are_shown_as() {
        let text = "See [the `a` b](c.md#d), ![e](f.svg) and [g].\n\n```sh\n[no](no.md)\n```\n\n[g]: h.rs\n";
        let found = links(text);
        let parts = found
            .iter()
            .map(|link| (link.to.as_str(), link.shown.as_str(), link.is_image));
        let parts: Vec<_> = parts.collect();
        assert_eq!(
            parts,
            [
                ("c.md#d", "the `a` b", false),
                ("f.svg", "e", true),
                ("h.rs", "g", false)
            ]
        );
        assert_eq!(&text[found[2].range.clone()], "[g]");
    }

    #[test]
    fn anchors_are_githubs() {
        let text = "# Motor, `[motor] driver = \"six-step\"`\n## What is x?\n## What is x?\n";
        assert_eq!(
            anchors(text),
            ["motor-motor-driver--six-step", "what-is-x", "what-is-x-1"]
        );
    }

    #[test]
    fn each_broken_link_is_named_with_its_line() {
        let top = std::env::temp_dir().join(format!("whisker-book-{}", std::process::id()));
        fs::create_dir_all(top.join("docs/sub")).unwrap();
        let page = "# A\n[ok](#a) [ok](b.md#b-c) [ok](../code.rs) [ok](https://x.org)\n\
                    [x](#b) [x](no.md)\n![x](no.svg) [x](sub) ![x](../code.rs) [x](../../up.md)\n";
        fs::write(top.join("docs/a.md"), page).unwrap();
        fs::write(top.join("docs/b.md"), "# B C\n").unwrap();
        fs::write(top.join("docs/sub/lost.md"), "").unwrap();
        fs::write(top.join("code.rs"), "").unwrap();
        let in_book = ["docs/a.md", "docs/b.md"].map(PathBuf::from).to_vec();
        let pages = Pages::read(&top, Path::new("docs"), in_book, &[]).unwrap();
        let faults = pages.faults();
        fs::remove_dir_all(&top).unwrap();
        let begins = [
            "docs/a.md:3: #b: no such heading",
            "docs/a.md:3: no.md: there is no such file",
            "docs/a.md:4: no.svg: there is no such file",
            "docs/a.md:4: sub: a folder",
            "docs/a.md:4: ../code.rs: an image",
            "docs/a.md:4: ../../up.md: there is no such file",
            "docs/sub/lost.md: not named",
        ];
        assert_eq!(faults.len(), begins.len(), "{faults:#?}");
        for (fault, begin) in faults.iter().zip(begins) {
            assert!(fault.starts_with(begin), "{fault}");
        }
    }
}
