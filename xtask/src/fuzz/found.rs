//! What a run of libFuzzer came to.

use crate::run::Fault;

/// The columns of its figures, and what libFuzzer says before each: edges are those of the target's
/// program, and each input that is kept goes where no other does.
const FIGURES: [(&str, &str); 6] = [
    ("seconds", " runs in "),
    ("executions", "number_of_executed_units:"),
    ("edges covered", "cov: "),
    ("of", "Loaded 1 modules"),
    ("inputs kept", "corp: "),
    ("MB at most", "peak_rss_mb:"),
];

/// What a target came to without a finding.
pub(super) struct Found {
    name: String,
    figures: [u64; 6],
}

impl Found {
    pub(super) fn read(name: &str, said: &str) -> Result<Self, Fault> {
        let mut figures = [0; 6];
        for (figure, (_, label)) in figures.iter_mut().zip(FIGURES) {
            let found = number(label, said);
            let missing = || format!("{name}: libFuzzer says no number of {label:?}\n{said}");
            *figure = found.ok_or_else(missing)?;
        }
        let name = name.to_owned();
        Ok(Self { name, figures })
    }

    pub(super) fn text(&self) -> String {
        let figures = FIGURES.iter().zip(self.figures);
        let figures = figures.map(|((column, _), figure)| format!("{column} {figure}"));
        let figures = figures.collect::<Vec<_>>().join(", ");
        format!("{}: {figures}, no finding", self.name)
    }

    pub(super) fn row(&self) -> String {
        let figures = self.figures.map(|figure| figure.to_string());
        format!("| {} | {} | 0 |", self.name, figures.join(" | "))
    }
}

/// The first number behind `label` in the last line that has it.
fn number(label: &str, said: &str) -> Option<u64> {
    let mut lines = said.lines().rev();
    let (_, rest) = lines.find_map(|line| line.split_once(label))?;
    let rest = rest.trim_start_matches([' ', '(']);
    rest.split(|c: char| !c.is_ascii_digit())
        .next()?
        .parse()
        .ok()
}
