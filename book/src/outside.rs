//! Links to files that are not in the book, which has no code beside it: their names instead.

use std::path::{Path, PathBuf};

use mdbook_driver::book::Book;
use mdbook_driver::errors::Result;
use mdbook_preprocessor::{Preprocessor, PreprocessorContext};

use crate::links::{is_foreign, links, plain};

/// Replaces links out of the folder of the book by what they show and the path of the file.
pub(crate) struct Outside(pub(crate) PathBuf);

impl Preprocessor for Outside {
    fn name(&self) -> &'static str {
        "outside"
    }

    fn run(&self, _: &PreprocessorContext, mut book: Book) -> Result<Book> {
        book.for_each_chapter_mut(|chapter| {
            if let Some(path) = &chapter.source_path {
                chapter.content = named(&chapter.content, &self.0.join(path), &self.0);
            }
        });
        Ok(book)
    }
}

/// The text of `page` with every link out of `src` named, and those to a folder's README to
/// its index, as mdBook calls it.
fn named(text: &str, page: &Path, src: &Path) -> String {
    let mut text = text.to_owned();
    for link in links(&text).into_iter().rev() {
        let path = link.to.split('#').next().unwrap_or_default();
        if is_foreign(&link.to) || path.is_empty() || link.is_image {
            continue;
        }
        let folder = page.parent().unwrap_or(Path::new(""));
        let Some(target) = plain(&folder.join(path)) else {
            continue;
        };
        if target.starts_with(src) {
            if target.file_name().is_some_and(|name| name == "README.md") {
                let index = link.to.replace("README.md", "index.md");
                text.replace_range(link.range, &format!("[{}]({index})", link.shown));
            }
            continue;
        }
        let target = target.display().to_string();
        let shown = link.shown.as_str();
        let is_named = shown.contains(target.trim_end_matches(".md"));
        text.replace_range(
            link.range,
            &match is_named {
                true => shown.to_owned(),
                false => format!("{shown} (`{target}`)"),
            },
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::named;
    use std::path::Path;

    #[test]
    fn a_link_out_of_the_book_becomes_the_name_of_the_file() {
        let text = "[`crates/wire`](../crates/wire), [this](../x/y.rs), [a](b.md), \
                    [c](https://d.org/) and [front](README.md#e)";
        let renamed = named(text, Path::new("docs/page.md"), Path::new("docs"));
        assert_eq!(
            renamed,
            "`crates/wire`, this (`x/y.rs`), [a](b.md), [c](https://d.org/) and [front](index.md#e)"
        );
    }
}
