//! Builds the book from `docs/` in the folder that is named, the top of the workspace, after it
//! has followed every link and image of every page, and of the pages beside the code.

mod links;
mod outside;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use mdbook_driver::MDBook;
use mdbook_driver::errors::Result;

use links::Pages;
use outside::Outside;

/// Pages outside of the book that lead into it, or that it leads to.
const BESIDE: [&str; 3] = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"];

fn main() -> ExitCode {
    let Some(top) = std::env::args_os().nth(1) else {
        eprintln!("book: name the top of the workspace");
        return ExitCode::from(2);
    };
    match build(Path::new(&top)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("book: {error:?}");
            ExitCode::FAILURE
        }
    }
}

/// Builds the book, unless a link is broken; says so then.
fn build(top: &Path) -> Result<bool> {
    let mut book = MDBook::load(top)?;
    let src = book.config.book.src.clone();
    let chapters = book.book.chapters();
    let named = chapters.filter_map(|chapter| chapter.source_path.as_ref());
    let in_book: Vec<PathBuf> = named.map(|path| src.join(path)).collect();
    let pages = Pages::read(top, &src, in_book, &BESIDE)?;
    let faults = pages.faults();
    if !faults.is_empty() {
        for fault in &faults {
            eprintln!("{fault}");
        }
        eprintln!("book: {} broken links", faults.len());
        return Ok(false);
    }
    book.with_preprocessor(Outside(src));
    book.build()?;
    println!(
        "{}",
        book.build_dir_for("html").join("index.html").display()
    );
    Ok(true)
}
