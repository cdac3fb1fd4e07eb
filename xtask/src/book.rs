//! The book of docs/, by the package in `book`.

use crate::run::{Fault, cargo, run, target, top};

/// Follows every link and image, then writes the book to target/book.
pub(crate) fn build() -> Result<(), Fault> {
    let build = [
        "run",
        "--quiet",
        "--locked",
        "--manifest-path",
        "book/Cargo.toml",
    ];
    let mut command = cargo(&build);
    command.arg("--target-dir").arg(target().join("bookbinder"));
    run(command.arg("--").arg(top()))
}

/// The tests of the package, which are not the workspace's.
pub(crate) fn test() -> Result<(), Fault> {
    let test = [
        "test",
        "--quiet",
        "--locked",
        "--manifest-path",
        "book/Cargo.toml",
    ];
    let mut command = cargo(&test);
    run(command.arg("--target-dir").arg(target().join("bookbinder")))
}
