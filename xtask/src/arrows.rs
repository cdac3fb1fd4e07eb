//! Keeps the arrows of the workspace pointing one way.
//!
//! **Between crates** ([`rooms`]) every dependency, those of build scripts and of
//! tests included, points from a row of [`rooms::ROWS`] to a row below it.
//!
//! **Between the files of a crate** no chain of arrows may lead back to where it
//! began. A file has an arrow to another if it names an item that the other defines:
//! by a path in a `use`, a signature, a body, a macro's arguments; an associated
//! item stands where its `impl` stands. `mod` is no arrow, nor is a re-export
//! (`pub use`, also `pub(crate) use`), through which a name is looked up to the file
//! that defines it. Code under `cfg(test)` and the files of `tests/` have none.
//! Of what a macro writes, the items named after `pub` in its call are known. A method
//! called without a path is not seen, nor is what a build script writes.
//!
//! **Names of public types** occur in one library only, so that a search finds one
//! thing (those of the programs above all others apart); [`SHARED`] names are understood within their module.

mod circles;
mod names;
mod paths;
mod rooms;
#[cfg(test)]
mod tests;
mod tree;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::run::{Fault, top};
use circles::{Arrows, circles};
use tree::Tree;

/// Type names that a module of any crate may have.
const SHARED: [&str; 8] = [
    "Command", "Config", "Error", "Fault", "Kind", "Options", "Settings", "State",
];

/// Checks the workspace, or of it the packages `only`.
///
/// # Errors
/// If an arrow points up, arrows form a circle, or a type name is public twice;
/// all are printed first.
pub(crate) fn all(only: &[String]) -> Result<(), Fault> {
    let packages = rooms::packages()?;
    let mut found = rooms::against_the_order(&packages);
    let mut types = BTreeMap::<String, BTreeSet<String>>::new();
    for package in &packages {
        let mut arrows = Arrows::new();
        for target in &package.targets {
            let tree = Tree::read(&target.src_path, &|path| std::fs::read_to_string(path).ok())?;
            paths::arrows(&tree, &mut arrows);
            let is_library = target.kind.iter().any(|kind| kind == "lib");
            if is_library && !rooms::ROWS[0].contains(&package.name.as_str()) {
                for name in tree.public_types() {
                    types.entry(name).or_default().insert(package.name.clone());
                }
            }
        }
        if !only.is_empty() && !only.contains(&package.name) {
            continue;
        }
        for circle in circles(&arrows) {
            found.push(format!(
                "{}: a circle of {} files\n{}",
                package.name,
                circle.len(),
                described(&circle, &arrows)
            ));
        }
    }
    for (name, crates) in types {
        let is_wanted = only.is_empty() || crates.iter().any(|name| only.contains(name));
        if is_wanted && crates.len() > 1 && !SHARED.contains(&name.as_str()) {
            let crates = crates.into_iter().collect::<Vec<_>>().join(", ");
            found.push(format!("the type name {name} is public in {crates}"));
        }
    }
    for fault in &found {
        println!("{fault}");
    }
    match found.len() {
        0 => Ok(()),
        n => Err(format!("{n} faults in the arrows of the workspace")),
    }
}

/// The arrows within a circle, each with the names that draw it.
fn described(circle: &BTreeSet<PathBuf>, arrows: &Arrows) -> String {
    let within = arrows
        .iter()
        .filter(|((from, to), _)| circle.contains(from) && circle.contains(to));
    let lines = within.map(|((from, to), names)| {
        let names = names.iter().map(String::as_str).collect::<Vec<_>>();
        format!("  {} -> {}: {}", short(from), short(to), names.join(", "))
    });
    lines.collect::<Vec<_>>().join("\n")
}

fn short(file: &Path) -> String {
    let file = file.strip_prefix(top()).unwrap_or(file);
    file.display().to_string()
}
