//! A page in the making: text, tables, the pictures beside it, and what an
//! experiment claims.

mod figure;

use anyhow::Result;
use std::fmt::{Display, Write};

use tactile::score::Confusion;

use crate::chart::{Panel, draw};
pub(crate) use figure::{figure, joined, joined_beside};

pub(crate) type Files = Vec<(String, String)>;

/// How well classes are recognised, and how well chance does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Recognition {
    /// A hit rate in percent, or κ.
    pub(crate) rate: f64,
    pub(crate) chance: f64,
    /// Chance where textures alone cannot be told; none where no texture is asked for.
    pub(crate) of_textures: Option<f64>,
}

/// Something that must come out of one seed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Claim {
    pub(crate) what: String,
    pub(crate) paper: String,
    pub(crate) ours: String,
    /// By how much it comes out; what is below zero is missing.
    pub(crate) margin: f64,
    pub(crate) unit: &'static str,
    /// What it rests on, where it rests on telling classes apart.
    pub(crate) recognition: Option<Recognition>,
}

impl Claim {
    /// Says on which rate of textures it rests, where chance has that.
    pub(crate) fn rests_on(&mut self, rate: f64, chance: f64) {
        self.rests_on_both(rate, (chance, Some(chance)));
    }

    /// The same of textures and something else, of whose chance `of_textures` is the textures'.
    pub(crate) fn rests_on_both(&mut self, rate: f64, (chance, of_textures): (f64, Option<f64>)) {
        self.recognition = Some(Recognition {
            rate,
            chance,
            of_textures,
        });
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Score {
    pub(crate) classifier: &'static str,
    pub(crate) task: String,
    /// Hit rate, percent.
    pub(crate) recognition: Recognition,
    /// In how many of all cases the product's decides, percent: it may decide nothing.
    pub(crate) decided: Option<f64>,
}

#[derive(Debug, Clone)]
pub(crate) struct Shown {
    /// Of the picture, without its ending.
    pub(crate) name: String,
    pub(crate) panels: Vec<Panel>,
}

/// Begins a paragraph that stands on one page alone of those that are put beside each other.
const ALONE: char = '\u{1}';

/// The texts of some pages and of `others`, which lack what stands [alone](Page::is_alone) on
/// those, as one: figures of both beside each other. None where words differ.
pub(crate) fn beside_others(pages: &[&str], others: &[&str]) -> Option<String> {
    let paragraphs = |text: &&'_ str| text.split("\n\n").map(str::to_owned).collect();
    let all: Vec<Vec<String>> = pages.iter().chain(others).map(paragraphs).collect();
    let (pages, others) = all.split_at(pages.len());
    let mut paragraphs = Vec::new();
    let mut shared = 0;
    for n in 0..pages.first()?.len() {
        let of = |all: &[Vec<String>], n: usize| -> Option<Vec<String>> {
            all.iter().map(|one| one.get(n).cloned()).collect()
        };
        let ours = of(pages, n)?;
        let ours: Vec<&str> = ours.iter().map(String::as_str).collect();
        let text = if ours.first()?.starts_with(ALONE) {
            joined(&ours)?.replace(ALONE, "")
        } else {
            let theirs = of(others, shared)?;
            let theirs: Vec<&str> = theirs.iter().map(String::as_str).collect();
            shared += 1;
            let groups = [&ours[..], &theirs[..]];
            joined_beside(&groups[..if theirs.is_empty() { 1 } else { 2 }])?
        };
        paragraphs.push(text);
    }
    Some(paragraphs.join("\n\n"))
}

#[derive(Debug, Default)]
pub(crate) struct Page {
    /// Whether what is said now stands on this page alone of those beside it.
    pub(crate) is_alone: bool,
    /// Where pictures are, beside the page.
    pub(crate) folder: &'static str,
    pub(crate) text: String,
    pub(crate) files: Files,
    pub(crate) claims: Vec<Claim>,
    pub(crate) scores: Vec<Score>,
    pub(crate) shown: Vec<Shown>,
}

impl Page {
    pub(crate) fn new(folder: &'static str) -> Self {
        Self {
            folder,
            ..Self::default()
        }
    }

    fn begin(&mut self) {
        if self.is_alone {
            self.text.push(ALONE);
        }
    }

    pub(crate) fn say(&mut self, paragraph: impl Display) {
        self.begin();
        // Writing to a string does not fail.
        let _ = write!(self.text, "{paragraph}\n\n");
    }

    pub(crate) fn heading(&mut self, level: usize, heading: &str) {
        self.say(format_args!("{} {heading}", "#".repeat(level)));
    }

    /// A table; `header` cells are divided by `|`.
    pub(crate) fn table(&mut self, header: &str, rows: impl IntoIterator<Item = Vec<String>>) {
        self.begin();
        let columns = header.split('|').count();
        let _ = writeln!(self.text, "| {} |", header.trim());
        let _ = writeln!(self.text, "|{}", "---|".repeat(columns));
        for row in rows {
            let _ = writeln!(self.text, "| {} |", row.join(" | "));
        }
        self.text.push('\n');
    }

    pub(crate) fn picture(&mut self, name: &str, what: &str, svg: String) {
        let path = format!("{}/{name}", self.folder);
        self.say(format_args!("![{what}]({path})"));
        self.files.push((path, svg));
    }

    pub(crate) fn panels(&mut self, name: &str, what: &str, panels: &[Panel]) -> Result<()> {
        self.picture(name, what, draw(panels)?);
        self.shown.push(Shown {
            name: name.trim_end_matches(".svg").to_owned(),
            panels: panels.to_vec(),
        });
        Ok(())
    }

    /// Adds a claim, which does not rest on telling classes apart unless that is said.
    pub(crate) fn claim(
        &mut self,
        what: impl Display,
        paper: impl Display,
        ours: impl Display,
        (margin, unit): (f64, &'static str),
    ) -> &mut Claim {
        self.claims.push(Claim {
            what: what.to_string(),
            paper: paper.to_string(),
            ours: ours.to_string(),
            margin,
            unit,
            recognition: None,
        });
        let last = self.claims.len() - 1;
        &mut self.claims[last]
    }

    /// Adds a classifier's score: its hit rate and that of chance, percent, and the chance where
    /// textures alone cannot be told.
    pub(crate) fn score(
        &mut self,
        classifier: &'static str,
        task: impl Display,
        rate: f64,
        (chance, of_textures): (f64, Option<f64>),
    ) -> &mut Score {
        self.scores.push(Score {
            classifier,
            task: task.to_string(),
            recognition: Recognition {
                rate,
                chance,
                of_textures,
            },
            decided: None,
        });
        let last = self.scores.len() - 1;
        &mut self.scores[last]
    }
}

pub(crate) fn row(name: impl Into<String>, cells: impl IntoIterator<Item = String>) -> Vec<String> {
    std::iter::once(name.into()).chain(cells).collect()
}

pub(crate) fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if (0.1..1000.0).contains(&value.abs()) {
        format!("{value:.2}")
    } else {
        format!("{value:.1e}")
    }
}

pub(crate) fn verdict(met: bool) -> &'static str {
    if met { "met" } else { "**missed**" }
}

/// Percent without a digit behind the point, the paper's beside ours.
pub(crate) fn beside(paper: f64, ours: f64) -> String {
    format!("{paper:.0} / **{}**", figure(ours, 0))
}

/// Percent of the trials of a true class in which `named` was named.
pub(crate) fn percent_of(score: &Confusion, truth: usize, named: usize) -> f64 {
    let sum: u64 = (0..score.classes()).map(|k| score.count(truth, k)).sum();
    100.0 * score.count(truth, named) as f64 / sum.max(1) as f64
}

/// A confusion matrix in percent: a row is the true class, a column what was
/// decided; the paper's `[true][decided]` beside ours.
pub(crate) fn confusion(
    page: &mut Page,
    names: &[&str],
    paper: &dyn Fn(usize, usize) -> f64,
    ours: &Confusion,
) {
    let rows = names.iter().enumerate().map(|(truth, name)| {
        let cell = |named| beside(paper(truth, named), percent_of(ours, truth, named));
        row(*name, (0..names.len()).map(cell))
    });
    let header = format!("true \\ decided | {}", names.join(" | "));
    page.table(&header, rows);
}
