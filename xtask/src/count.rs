//! Instructions of every kernel, counted on emulated processors: see
//! `xtask/count` for how.

use std::path::Path;

use crate::figures::{Figure, INSTRUCTIONS, Table};
use crate::firmware::Board;
use crate::run::{self, Fault, cargo, emulator, output};

/// Processors, as the table calls them, and the board that has one. A Cortex-M0 has the instructions
/// of a Cortex-M0+.
const PROCESSORS: [(&str, &str); 2] = [
    ("cortex-m4f", "nucleo-f446re"),
    ("cortex-m0", "nucleo-g071rb"),
];

pub(crate) const TABLE: Table = Table {
    file: "docs/measured/instructions.csv",
    header: "kernel,format,target,mean,worst",
    decimals: INSTRUCTIONS,
    slack: 0.05,
    command: "cargo xtask count",
};

const PROGRAMS: [&str; 5] = ["computation", "functions", "integers", "parts", "whisking"];

/// Counts everything and writes the table (to `csv`, where one is named), or checks
/// that no kernel has become dearer than it says.
pub(crate) fn all(csv: Option<&Path>, check: bool) -> Result<(), Fault> {
    let mut found = Vec::new();
    for processor in PROCESSORS {
        found.extend(count(processor, &PROGRAMS, &[])?);
    }
    // Of twenty-four whiskers too, where there is an FPU.
    let array = ["--features", "array"];
    found.extend(count(PROCESSORS[0], &["computation"], &array)?);
    TABLE.take(&found, csv, check)
}

fn count(
    (processor, board): (&str, &str),
    programs: &[&str],
    features: &[&str],
) -> Result<Vec<Figure>, Fault> {
    let target = Board::named(board)?.target;
    let mut build = cargo("build --locked --profile firmware -p count");
    build.args(programs.iter().flat_map(|name| ["--bin", name]));
    build.args(features).args(["--target", target]);
    run::run(build.env("RUSTFLAGS", "-D warnings"))?;
    let folder = run::target().join(target).join("firmware");
    let mut figures = Vec::new();
    for program in programs {
        let mut count = emulator("count");
        let said = output(count.arg(folder.join(program)).args(["--board", board]))?;
        for line in said.lines() {
            figures.push(counted(line, processor)?);
        }
    }
    Ok(figures)
}

/// A line of the emulator: kernel, format, mean, worst.
fn counted(line: &str, processor: &str) -> Result<Figure, Fault> {
    let wrong = || format!("the emulator printed {line:?}");
    let fields: Vec<&str> = line.split(',').collect();
    let [kernel, format, mean, worst] = fields[..] else {
        return Err(wrong());
    };
    let number = |text: &str| text.parse::<f64>().map_err(|_| wrong());
    let key = [kernel, format, processor];
    Ok(Figure::instructions(&key, number(mean)?, number(worst)?))
}
