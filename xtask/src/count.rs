//! Instructions of every kernel, counted on emulated processors: see
//! `xtask/count` for how. The table is committed, so that a kernel cannot
//! become dearer unseen.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::run::{Fault, cargo, output, run, top};

/// The committed table.
const TABLE: &str = "docs/measured/instructions.csv";

const HEADER: &str = "kernel,format,target,mean,worst";

/// By how much a kernel may become dearer before a check fails.
const SLACK: f64 = 0.05;

/// An emulated processor.
struct Processor {
    /// What the table calls it.
    name: &'static str,
    target: &'static str,
    /// What QEMU calls the machine that has one.
    machine: &'static str,
}

const PROCESSORS: [Processor; 2] = [
    Processor {
        name: "cortex-m4f",
        target: "thumbv7em-none-eabihf",
        machine: "mps2-an386",
    },
    Processor {
        name: "cortex-m0",
        target: "thumbv6m-none-eabi",
        machine: "microbit",
    },
];

/// A line of the table.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    /// Kernel, number format, processor.
    key: [String; 3],
    /// Mean instructions a call, to a tenth.
    mean: f64,
    /// Instructions of the dearest call.
    worst: u64,
}

/// Counts everything; writes the table to `csv` (or to the committed one), or
/// checks that no kernel has become dearer than it says.
///
/// # Errors
/// If something cannot be built or run, or, checking, differs.
pub(crate) fn all(csv: Option<&Path>, check: bool) -> Result<(), Fault> {
    let rows = count()?;
    print!("{}", columns(&rows));
    let path = csv.map_or_else(|| top().join(TABLE), Path::to_owned);
    let wrong = |error| format!("{}: {error}", path.display());
    if check {
        let known = fs::read_to_string(&path).map_err(wrong)?;
        return compare(&read(&known)?, &rows);
    }
    fs::write(&path, table(&rows)).map_err(wrong)
}

/// Kernel, number format and processor; mean and worst.
pub(crate) type Known = ([String; 3], f64, f64);

/// The counts of a committed table.
///
/// # Errors
/// If it is none.
pub(crate) fn known(text: &str) -> Result<Vec<Known>, Fault> {
    let known = |row: Row| (row.key, row.mean, row.worst as f64);
    Ok(read(text)?.into_iter().map(known).collect())
}

fn count() -> Result<Vec<Row>, Fault> {
    Command::new(EMULATOR)
        .arg("--version")
        .output()
        .map_err(|error| {
            format!("{EMULATOR} cannot be run ({error}). Install it: apt install qemu-system-arm")
        })?;
    let mut rows = Vec::new();
    for processor in PROCESSORS {
        let directory = build(&processor)?;
        for program in programs()? {
            let said = output(&mut emulator(&processor, &directory.join(program)))?;
            for line in said.lines() {
                rows.push(counted(line, processor.name)?);
            }
        }
    }
    Ok(rows)
}

/// Builds the counting programs; gives where they are.
fn build(processor: &Processor) -> Result<PathBuf, Fault> {
    let build = ["build", "--locked", "--profile", "firmware", "-p", "count"];
    run(cargo(&build)
        .args(["--target", processor.target])
        .env("RUSTFLAGS", "-D warnings"))?;
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| top().join("target"), PathBuf::from);
    Ok(target.join(processor.target).join("firmware"))
}

/// Names of the counting programs.
fn programs() -> Result<Vec<String>, Fault> {
    let directory = top().join("xtask/count/src/bin");
    let wrong = |error| format!("{}: {error}", directory.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(&directory).map_err(wrong)? {
        let path = entry.map_err(wrong)?.path();
        names.extend(
            path.file_stem()
                .map(|name| name.to_string_lossy().into_owned()),
        );
    }
    names.sort();
    Ok(names)
}

const EMULATOR: &str = "qemu-system-arm";

/// Every instruction takes 2^10 ns of the machine's time, however long the
/// emulator takes.
fn emulator(processor: &Processor, program: &Path) -> Command {
    let mut command = Command::new(EMULATOR);
    command
        .args(["-M", processor.machine, "-icount", "shift=10,sleep=off"])
        .args(["-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(program);
    command
}

/// A line that a program printed: kernel, format, calls, their sum, the worst.
fn counted(line: &str, processor: &str) -> Result<Row, Fault> {
    let wrong = || format!("a counting program printed {line:?}");
    let fields: Vec<&str> = line.split(',').collect();
    let [kernel, format, calls, sum, worst] = fields[..] else {
        return Err(wrong());
    };
    let number = |text: &str| text.parse::<u64>().map_err(|_| wrong());
    let (calls, sum, worst) = (number(calls)?, number(sum)?, number(worst)?);
    if calls == 0 || sum < calls || sum > calls * worst {
        return Err(wrong());
    }
    Ok(Row {
        key: [kernel, format, processor].map(str::to_owned),
        mean: (sum as f64 / calls as f64 * 10.0).round() / 10.0,
        worst,
    })
}

/// The table as it is committed.
fn table(rows: &[Row]) -> String {
    let mut text = format!("{HEADER}\n");
    for row in rows {
        let key = row.key.join(",");
        let _ = writeln!(text, "{key},{:.1},{}", row.mean, row.worst);
    }
    text
}

fn read(text: &str) -> Result<Vec<Row>, Fault> {
    let mut lines = text.lines();
    if lines.next() != Some(HEADER) {
        return Err(format!("{TABLE} does not begin with {HEADER}"));
    }
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [kernel, format, processor, mean, worst] = fields[..] else {
            return None;
        };
        Some(Row {
            key: [kernel, format, processor].map(str::to_owned),
            mean: mean.parse().ok()?,
            worst: worst.parse().ok()?,
        })
    };
    lines
        .map(|line| row(line).ok_or_else(|| format!("{TABLE} has a line {line:?}")))
        .collect()
}

/// The table for a person to read.
fn columns(rows: &[Row]) -> String {
    let width = |field: usize| {
        rows.iter()
            .map(|row| row.key[field].len())
            .max()
            .unwrap_or(0)
    };
    let [kernel, format, processor] = [0, 1, 2].map(width);
    let mut text = String::new();
    for row in rows {
        let [k, f, p] = &row.key;
        let _ = writeln!(
            text,
            "{k:kernel$}  {f:format$}  {p:processor$}  {:>9.1}  {:>7}",
            row.mean, row.worst
        );
    }
    text
}

/// Names every kernel that is dearer than it was, new or gone.
fn compare(known: &[Row], found: &[Row]) -> Result<(), Fault> {
    let mut faults = String::new();
    let find = |rows: &[Row], key: &[String; 3]| rows.iter().find(|r| &r.key == key).cloned();
    for row in found {
        let key = row.key.join(",");
        let Some(was) = find(known, &row.key) else {
            let _ = writeln!(faults, "{key} is not in the table");
            continue;
        };
        let dearer = |now: f64, was: f64| now > was * (1.0 + SLACK);
        if dearer(row.mean, was.mean) || dearer(row.worst as f64, was.worst as f64) {
            let _ = writeln!(
                faults,
                "{key}: mean {} was {}, worst {} was {}",
                row.mean, was.mean, row.worst, was.worst
            );
        }
    }
    for row in known {
        if find(found, &row.key).is_none() {
            let _ = writeln!(faults, "{} is no longer counted", row.key.join(","));
        }
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(format!(
            "{faults}If that is meant: cargo xtask count, and commit {TABLE}"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::{Row, columns, compare, counted, read, table};

    fn row(kernel: &str, mean: f64, worst: u64) -> Row {
        Row {
            key: [kernel, "f32", "cortex-m0"].map(str::to_owned),
            mean,
            worst,
        }
    }

    #[test]
    fn a_printed_line_becomes_mean_and_worst() {
        let found = counted("drive,f32,1000,21250,22", "cortex-m0");
        assert_eq!(found, Ok(row("drive", 21.3, 22)));
    }

    #[test]
    fn what_no_program_can_have_counted_is_refused() {
        for line in [
            "",
            "drive,f32,1000,21000",
            "drive,f32,1000,21000,21,0",
            "drive,f32,0,0,0",
            "drive,f32,1000,x,21",
            "drive,f32,1000,-1,21",
            // The mean below one instruction, or above the worst.
            "drive,f32,1000,999,21",
            "drive,f32,1000,21001,21",
        ] {
            assert!(counted(line, "cortex-m0").is_err(), "{line:?}");
        }
    }

    #[test]
    fn a_table_is_read_back_as_it_was_written() {
        let rows = [row("drive", 21.0, 21), row("unit", 33.5, 40)];
        assert_eq!(read(&table(&rows)), Ok(rows.to_vec()));
        assert!(read("kernel,mean\n").is_err());
        assert!(read(&(table(&rows) + "drive,f32\n")).is_err());
        assert_eq!(columns(&rows).lines().count(), 2);
    }

    #[test]
    fn five_per_cent_are_borne_and_no_more() {
        let known = [row("a", 100.0, 200)];
        assert_eq!(compare(&known, &[row("a", 105.0, 210)]), Ok(()));
        assert_eq!(compare(&known, &[row("a", 50.0, 100)]), Ok(()));
        assert!(compare(&known, &[row("a", 105.1, 200)]).is_err());
        assert!(compare(&known, &[row("a", 100.0, 211)]).is_err());
    }

    #[test]
    fn new_and_lost_kernels_are_named() {
        let (a, b) = (row("a", 1.0, 1), row("b", 1.0, 1));
        let fault = compare(&[a], &[b]).unwrap_err();
        assert!(fault.contains("b,f32,cortex-m0 is not in the table"));
        assert!(fault.contains("a,f32,cortex-m0 is no longer counted"));
    }
}
