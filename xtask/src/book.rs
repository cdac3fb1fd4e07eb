//! The book of docs/, by the package in `book`.

use crate::run::{Fault, cargo_apart, run, top};

/// Follows every link and image, then writes the book to target/book.
pub(crate) fn build() -> Result<(), Fault> {
    let mut build = cargo_apart("run", "book", "bookbinder");
    run(build.arg("--").arg(top()))
}

pub(crate) fn test() -> Result<(), Fault> {
    run(&mut cargo_apart("test", "book", "bookbinder"))
}
