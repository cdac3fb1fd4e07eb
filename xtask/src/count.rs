//! Instructions of every kernel, counted on emulated processors: see
//! `xtask/count` for how.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::figures::{Figure, INSTRUCTIONS, Table};
use crate::run::{Fault, cargo, listing, output, run, target, top};

/// The committed table.
pub(crate) const TABLE: Table = Table {
    file: "docs/measured/instructions.csv",
    header: "kernel,format,target,mean,worst",
    decimals: INSTRUCTIONS,
    slack: 0.05,
    command: "cargo xtask count",
};

/// Programs that are counted where time is short: the parts of a tick, a whole
/// tick, and the classifier.
const SHORT: [&str; 7] = [
    "classifier_push",
    "frame",
    "joint_air",
    "joint_push",
    "parts",
    "tick_1x1",
    "touch",
];

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

/// Counts everything and writes the table (to `csv`, where one is named), or checks
/// that no kernel has become dearer than it says.
pub(crate) fn all(csv: Option<&Path>, check: bool) -> Result<(), Fault> {
    let files = listing(&top().join("xtask/count/src/bin"), "rs")?;
    let names = files.iter().filter_map(|file| file.file_stem()?.to_str());
    let found = count(&PROCESSORS, &names.collect::<Vec<_>>())?;
    TABLE.take(&found, csv, check)
}

/// Checks [`SHORT`] on the first processor.
pub(crate) fn short() -> Result<(), Fault> {
    TABLE.check_part(&count(&PROCESSORS[..1], &SHORT)?)
}

fn count(processors: &[Processor], programs: &[&str]) -> Result<Vec<Figure>, Fault> {
    Command::new(EMULATOR)
        .arg("--version")
        .output()
        .map_err(|error| {
            format!("{EMULATOR} cannot be run ({error}). Install it: apt install qemu-system-arm")
        })?;
    let mut figures = Vec::new();
    for processor in processors {
        let directory = build(processor, programs)?;
        for program in programs {
            let said = output(&mut emulator(processor, &directory.join(program)))?;
            for line in said.lines() {
                figures.push(counted(line, processor.name)?);
            }
        }
    }
    Ok(figures)
}

/// Builds counting programs; gives where they are. Those of more whiskers than a board has
/// are built with room for them, the others without, as a board's.
fn build(processor: &Processor, programs: &[&str]) -> Result<PathBuf, Fault> {
    let build = ["build", "--locked", "--profile", "firmware", "-p", "count"];
    for (is_array, features) in [(false, &[][..]), (true, &["--features", "array"])] {
        let bins = programs
            .iter()
            .filter(|name| name.ends_with("_2x12") == is_array);
        let bins: Vec<&str> = bins.flat_map(|name| ["--bin", name]).collect();
        if !bins.is_empty() {
            run(cargo(&build)
                .args(bins)
                .args(features)
                .args(["--target", processor.target])
                .env("RUSTFLAGS", "-D warnings"))?;
        }
    }
    Ok(target().join(processor.target).join("firmware"))
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
fn counted(line: &str, processor: &str) -> Result<Figure, Fault> {
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
    let key = [kernel, format, processor];
    let mean = sum as f64 / calls as f64;
    Ok(Figure::instructions(&key, mean, worst as f64))
}

#[cfg(test)]
mod tests {
    use super::{Figure, counted};

    #[test]
    fn a_printed_line_becomes_mean_and_worst() {
        let found = counted("drive,f32,1000,21250,22", "cortex-m0");
        let key = ["drive", "f32", "cortex-m0"];
        assert_eq!(found, Ok(Figure::instructions(&key, 21.3, 22.0)));
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
}
