//! Does a test notice when an equation loses a term or a table a bit? Each
//! entry of the list is put into a copy of the workspace, alone, and the tests
//! are run until some fail; which did is written down in docs/mutations.md.
//!
//! It builds anew for each entry and takes an hour or two, so CI does not run
//! it; CI checks that every entry still has its place in the source. What it
//! changes is a copy under target/. The page is written after every entry, so
//! that a run may be cut short and taken up again.

mod list;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::run::{Fault, cargo, top};
use list::{LIST, Mutant};

/// Tests that are asked together.
struct Asked {
    /// Their package.
    package: &'static str,
    /// Where it begins in the workspace, if it knows nothing of what is outside.
    within: &'static str,
    /// Which of its tests.
    tests: &'static [&'static str],
}

/// Who is asked, the quick ones first: what is caught early builds little.
const ASKED: [Asked; 4] = [
    // Not those of the motors, in which no entry is.
    Asked {
        package: "whisking",
        within: "crates/whisking/",
        tests: &[
            "--test",
            "oscillator_terms",
            "--test",
            "module_terms",
            "--test",
            "bits",
        ],
    },
    Asked {
        package: "whisking",
        within: "crates/whisking/",
        tests: &["--lib", "--test", "phase_noise"],
    },
    Asked {
        package: "firmware",
        within: "",
        tests: &["--lib", "--tests"],
    },
    Asked {
        package: "acceptance",
        within: "",
        tests: &[
            "--test",
            "claims",
            "--test",
            "euler_trace",
            "--test",
            "formats",
        ],
    },
];

/// The most tests named for one entry.
const NAMED: usize = 3;

/// What of the list is tried.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Choice {
    /// Only those whose description contains this; replaces their rows
    #[arg(long)]
    only: Option<String>,
    /// Only those without a row in docs/mutations.md
    #[arg(long)]
    missing: bool,
    /// Asks only the tests of the crate that is changed; what they do not
    /// notice gets no row
    #[arg(long)]
    quick: bool,
}

impl Choice {
    /// Whether `asked` is asked.
    fn asks(&self, asked: &Asked) -> bool {
        !(self.quick && asked.within.is_empty())
    }

    fn wants(&self, mutant: &Mutant) -> bool {
        self.only
            .as_ref()
            .is_none_or(|only| mutant.what.contains(only))
    }
}

/// Tries what `choice` says, and puts what was found into the page.
///
/// # Errors
/// If an entry has lost its place, does not compile, or escapes every test.
pub(crate) fn all(choice: &Choice) -> Result<(), Fault> {
    let copy = top().join("target/mutants");
    copy_workspace(&copy)?;
    for asked in ASKED.iter().filter(|asked| choice.asks(asked)) {
        let failed = failed_tests(asked, &copy)?;
        if !failed.is_empty() {
            return Err(format!(
                "even without changes {failed:?} of {} fail",
                asked.package
            ));
        }
    }
    let page = top().join("docs/mutations.md");
    let before = if choice.only.is_some() || choice.missing {
        fs::read_to_string(&page).unwrap_or_default()
    } else {
        String::new()
    };
    let mut rows: Vec<Option<String>> = LIST.iter().map(|m| row_of(m, &before)).collect();
    let mut escaped = 0;
    for (n, mutant) in LIST.iter().enumerate() {
        if !choice.wants(mutant) || (choice.missing && rows[n].is_some()) {
            continue;
        }
        let caught = try_one(mutant, &copy, choice)?;
        escaped += usize::from(caught.is_none());
        let names = caught.as_deref().unwrap_or("**nothing**");
        println!("{}: {names}", mutant.what);
        if choice.quick && caught.is_none() {
            rows[n] = None;
            continue;
        }
        rows[n] = Some(format!("| {} | {names} |\n", mutant.what));
        put(&page, &text(&rows))?;
    }
    match escaped {
        0 => Ok(()),
        n => Err(format!("{n} of them escaped every test")),
    }
}

/// The row of `mutant` in `page`.
fn row_of(mutant: &Mutant, page: &str) -> Option<String> {
    let start = format!("| {} | ", mutant.what);
    let row = page.lines().find(|line| line.starts_with(&start))?;
    Some(format!("{row}\n"))
}

/// The page of `rows`, of which those not tried are missing.
fn text(rows: &[Option<String>]) -> String {
    let tried: Vec<&str> = rows.iter().flatten().map(String::as_str).collect();
    let count = match rows.len() - tried.len() {
        0 => format!("All {} entries have been tried.", rows.len()),
        left => format!("{left} of {} entries have not been tried yet.", rows.len()),
    };
    format!("{HEADER}{count}\n\n{TABLE}{}", tried.concat())
}

const HEADER: &str = "# Mutations\n\n\
     <!-- Generated by `cargo xtask mutants`; do not edit by hand. -->\n\n\
     One term of an equation left out or one bit of a table turned round, one at a time, in a \
     copy of\nthe workspace; and the tests that noticed (the first three by name). The tests of \
     `whisking` are asked\nfirst, those of `firmware` where `whisking`'s notice nothing, then the \
     quick ones of `acceptance`.\n`cargo xtask mutants` makes this page anew; it takes an hour or \
     two, so CI does not.\n\n";

const TABLE: &str = "| what is missing or wrong | noticed by |\n|---|---|\n";

/// The tests that fail with `mutant` in `copy`; `None` if none does.
fn try_one(mutant: &Mutant, copy: &Path, choice: &Choice) -> Result<Option<String>, Fault> {
    let path = copy.join(mutant.file);
    let sound = fs::read_to_string(top().join(mutant.file))
        .map_err(|error| format!("{}: {error}", mutant.file))?;
    put(&path, &mutant.applied(&sound)?)?;
    let mut caught = None;
    let about = |asked: &&Asked| mutant.file.starts_with(asked.within) && choice.asks(asked);
    for asked in ASKED.iter().filter(about) {
        let failed =
            failed_tests(asked, copy).map_err(|fault| format!("{}: {fault}", mutant.what))?;
        if !failed.is_empty() {
            let names: Vec<&str> = failed.iter().map(String::as_str).take(NAMED).collect();
            let more = match failed.len().saturating_sub(NAMED) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            let package = asked.package;
            caught = Some(format!("{package}: `{}`{more}", names.join("`, `")));
            break;
        }
    }
    put(&path, &sound)?;
    Ok(caught)
}

fn put(path: &Path, text: &str) -> Result<(), Fault> {
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// The names of the tests in `asked` that fail in `copy`.
fn failed_tests(asked: &Asked, copy: &Path) -> Result<Vec<String>, Fault> {
    let mut command: Command = cargo(&["test", "-p", asked.package, "--no-fail-fast"]);
    command
        .args(asked.tests)
        .current_dir(copy)
        .env("CARGO_TARGET_DIR", copy.join("target"))
        // What one entry fails on is not tried on the next.
        .env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "1")
        .env("RUST_BACKTRACE", "0");
    let output = command.output().map_err(|error| error.to_string())?;
    let errors = String::from_utf8_lossy(&output.stderr);
    if errors.contains("could not compile") {
        return Err(format!("does not compile:\n{errors}"));
    }
    let said = String::from_utf8_lossy(&output.stdout);
    let names = said.lines().filter_map(|line| {
        line.strip_prefix("test ")?
            .strip_suffix(" ... FAILED")
            .map(str::to_owned)
    });
    let names: Vec<String> = names.collect();
    if names.is_empty() && !output.status.success() {
        return Err(format!("no test failed, and yet:\n{errors}"));
    }
    Ok(names)
}

/// The files of the workspace that git knows or would add, to `copy`; what is
/// there already and the same stays untouched, so that cargo builds no more
/// than it must.
fn copy_workspace(copy: &Path) -> Result<(), Fault> {
    let listed = Command::new("git")
        .args([
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .current_dir(top())
        .output()
        .map_err(|error| format!("git ls-files: {error}"))?;
    for name in String::from_utf8_lossy(&listed.stdout).split_terminator('\0') {
        let (from, to): (PathBuf, PathBuf) = (top().join(name), copy.join(name));
        let Ok(bytes) = fs::read(&from) else { continue };
        if fs::read(&to).is_ok_and(|there| there == bytes) {
            continue;
        }
        let done =
            fs::create_dir_all(to.parent().unwrap_or(copy)).and_then(|()| fs::write(&to, bytes));
        done.map_err(|error| format!("{}: {error}", to.display()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{LIST, top};

    #[test]
    fn every_entry_has_its_place_in_the_source() {
        for mutant in LIST {
            let text = std::fs::read_to_string(top().join(mutant.file)).unwrap();
            mutant.applied(&text).unwrap();
        }
    }
}
