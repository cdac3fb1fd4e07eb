//! That tests notice mistakes: each of the kept mutants (`xtask/mutants.toml`) is made in a copy
//! of the tree, and its test must fail.

use std::path::Path;

use serde::Deserialize;

use crate::reproducible::copy;
use crate::run::{Fault, cargo, no_faults, read, run, target, top, write};

#[derive(Deserialize)]
struct Kept {
    mutant: Vec<Mutant>,
}

/// A mistake in one place.
#[derive(Deserialize)]
struct Mutant {
    file: String,
    /// Stands in the file once.
    find: String,
    replace: String,
    /// What `cargo test` is given.
    test: String,
}

fn kept() -> Result<Kept, Fault> {
    let list = read(&top().join("xtask/mutants.toml"))?;
    toml::from_str(&list).map_err(|error| error.to_string())
}

pub(crate) fn all() -> Result<(), Fault> {
    let kept = kept()?;
    let tree = copy(&target().join("mutants"))?;
    let survives = |mutant: &Mutant| {
        let fault = mutant.try_in(&tree).err()?;
        Some(format!("{}: {}: {fault}", mutant.file, mutant.replace))
    };
    let faults: Vec<Fault> = kept.mutant.iter().filter_map(survives).collect();
    let (all, caught) = (kept.mutant.len(), kept.mutant.len() - faults.len());
    println!("{caught} of {all} mutants are caught");
    no_faults(&faults)
}

impl Mutant {
    fn try_in(&self, tree: &Path) -> Result<(), Fault> {
        let file = tree.join(&self.file);
        let whole = self.find_in(&file)?;
        write(&file, whole.replace(&self.find, &self.replace))?;
        let asked = self.ask(tree);
        write(&file, whole)?;
        asked
    }

    fn find_in(&self, file: &Path) -> Result<String, Fault> {
        let whole = read(file)?;
        if whole.matches(&self.find).count() == 1 {
            return Ok(whole);
        }
        Err(format!("{} does not stand there once", self.find))
    }

    /// Whether the test fails; a mutant that does not compile is no mutant.
    fn ask(&self, tree: &Path) -> Result<(), Fault> {
        let test = |last: &[&str]| {
            let mut command = cargo("test --quiet --locked");
            command.args(self.test.split(' ')).args(last);
            // Beside the copy, so that the next night compiles only what has changed.
            command.env("CARGO_TARGET_DIR", target().join("of-mutants"));
            run(command.current_dir(tree))
        };
        test(&["--no-run"])?;
        match test(&[]) {
            Ok(()) => Err("survives".to_owned()),
            Err(_) => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::kept;
    use crate::run::top;

    #[test]
    fn every_mutant_has_its_place() {
        for mutant in kept().unwrap().mutant {
            let found = mutant.find_in(&top().join(&mutant.file));
            assert!(found.is_ok(), "{}: {found:?}", mutant.file);
        }
    }
}
