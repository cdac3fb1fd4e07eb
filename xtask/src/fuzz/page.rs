//! What a run of libFuzzer came to, and the page of it.

use std::fmt::Write as _;
use std::process::Command;

use crate::run::{self, Fault, output, top};

/// The page.
const PAGE: &str = "docs/measured/fuzz.md";

/// What a target came to without a finding.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Found {
    name: String,
    executions: u64,
    /// Edges of its program, and those that were gone over.
    edges: u64,
    covered: u64,
    /// Inputs that are kept, each of which goes where no other does.
    kept: u64,
    /// The most memory, in megabytes.
    memory: u64,
    seconds: u64,
}

impl Found {
    /// From what libFuzzer says.
    pub(super) fn read(name: &str, said: &str) -> Result<Self, Fault> {
        // The first number behind `label` in the last line that has it.
        let number = |label: &str| -> Result<u64, Fault> {
            let mut lines = said.lines().rev();
            let rest = lines.find_map(|line| Some(line.split_once(label)?.1));
            let rest = rest.map(|rest| rest.trim_start_matches([' ', '(']));
            let digits = rest.and_then(|rest| rest.split(|c: char| !c.is_ascii_digit()).next());
            let number = digits.and_then(|digits| digits.parse().ok());
            number.ok_or_else(|| format!("{name}: libFuzzer says no number of {label:?}\n{said}"))
        };
        Ok(Self {
            name: name.to_owned(),
            executions: number("number_of_executed_units:")?,
            edges: number("Loaded 1 modules")?,
            covered: number("cov: ")?,
            kept: number("corp: ")?,
            memory: number("peak_rss_mb:")?,
            seconds: number(" runs in ")?,
        })
    }

    /// A line for a person to read.
    pub(super) fn text(&self) -> String {
        let Self {
            name,
            executions,
            edges,
            covered,
            kept,
            memory,
            seconds,
        } = self;
        format!(
            "{name}: {executions} executions in {seconds} s, {covered} of {edges} edges, {kept} \
             inputs kept, {memory} MB at most, no finding"
        )
    }
}

/// Writes the page.
pub(super) fn write(found: &[Found]) -> Result<(), Fault> {
    let mut text = format!(
        "<!-- written by cargo xtask fuzz --page -->\n\
         # Untrusted input\n\n\
         Frames, configurations, models, recordings, scenes and the tables of a campaign's shards \
         that libFuzzer made, fed to their readers (`fuzz/src`) with checks of overflow and of \
         ranges on: no panic, no input that takes more than 10 s or 256 MB at once. The sums of a \
         configuration and of a model are made to fit; by a configuration that is taken a module \
         ticks; a model that is taken classifies 2000 samples; of a scene that is taken \
         configurations are made, and it is simulated for its first ticks; tables that are taken \
         are written and read again, merged, and made a page of. Inputs that were kept before, \
         from earlier runs here, are fed again first. `cargo xtask nightly` feeds each target for \
         an hour. Coverage counts the edges of the whole program that was fed, with its libraries \
         and with what no input reaches. {}.\n\n\
         | target | seconds | executions | edges covered | of | inputs kept | MB at most | findings |\n\
         |---|---|---|---|---|---|---|---|\n",
        compiler()?
    );
    for found in found {
        let Found {
            name,
            executions,
            edges,
            covered,
            kept,
            memory,
            seconds,
        } = found;
        let _ = writeln!(
            text,
            "| {name} | {seconds} | {executions} | {covered} | {edges} | {kept} | {memory} | 0 |"
        );
    }
    run::write(&top().join(PAGE), text)
}

/// What the compiler says it is.
fn compiler() -> Result<String, Fault> {
    output(Command::new("rustc").arg("--version")).map(|said| said.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::Found;

    const SAID: &str = "\
INFO: Loaded 1 modules   (61442 inline 8-bit counters): 61442 [0x5, 0x6), 
#9\tNEW    cov: 160 ft: 161 corp: 2/13b lim: 4 exec/s: 0 rss: 43Mb
#4194304\tDONE   cov: 177 ft: 356 corp: 22/1Kb lim: 4096 exec/s: 1398101 rss: 461Mb
Done 4194304 runs in 3 second(s)
stat::number_of_executed_units: 4194304
stat::average_exec_per_sec:     1398101
stat::peak_rss_mb:              461
";

    #[test]
    fn the_last_figures_are_read() {
        let found = Found::read("frame", SAID).unwrap();
        let expected = Found {
            name: "frame".to_owned(),
            executions: 4_194_304,
            edges: 61_442,
            covered: 177,
            kept: 22,
            memory: 461,
            seconds: 3,
        };
        assert_eq!(found, expected);
        assert!(Found::read("frame", "Done 3 runs").is_err());
    }
}
