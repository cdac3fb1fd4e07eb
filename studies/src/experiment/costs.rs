//! Every classifier's hit rate beside what it costs on a Cortex-M4F.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;
use tactile::{Sequential, Window};

use super::verdicts::Bodies;
use crate::classifiers::stationary::Stationary;
use crate::moments::Summary;
use crate::page::{Page, Score};
use crate::paper::printed;

/// The product's kernels, as `cargo xtask count` left them.
const COUNTED: &str = include_str!("../../../docs/measured/instructions.csv");

/// What a classifier's board form consists of.
#[derive(Deserialize)]
struct Form {
    /// The classifier, as in its score.
    classifier: String,
    /// Kernels, and how often each runs a sample: so many times in so many.
    kernels: Vec<(String, f64, f64)>,
    /// Bytes of state and of tables in flash.
    bytes: (State, usize),
    /// What is to be said of it.
    #[serde(default)]
    note: String,
}

/// Bytes of state: so many, or those of naive Bayes under a rule.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum State {
    Sequential,
    Window,
    Stationary,
    #[serde(untagged)]
    Bytes(usize),
}

impl State {
    const fn bytes(&self) -> usize {
        match self {
            Self::Sequential => <Sequential>::STATE_BYTES,
            Self::Window => <Window>::STATE_BYTES,
            Self::Stationary => <Stationary>::STATE_BYTES,
            Self::Bytes(bytes) => *bytes,
        }
    }
}

const COSTS: &str = include_str!("costs.toml");

static FORMS: LazyLock<Vec<Form>> = LazyLock::new(|| printed(COSTS, "forms"));

/// Kernels that were counted once.
static ONCE: LazyLock<BTreeMap<String, f64>> = LazyLock::new(|| printed(COSTS, "counted"));

/// Mean instructions of a kernel on a Cortex-M4F, in the first format counted.
fn counted(kernel: &str) -> Option<f64> {
    if let Some(count) = ONCE.get(kernel) {
        return Some(*count);
    }
    let mut rows = csv::Reader::from_reader(COUNTED.as_bytes());
    let mut found = rows.records().filter_map(Result::ok);
    let row = found.find(|row| row.get(0) == Some(kernel) && row.get(2) == Some("cortex-m4f"))?;
    row.get(3)?.parse().ok()
}

impl Form {
    fn instructions(&self) -> Option<f64> {
        let parts = self
            .kernels
            .iter()
            .map(|(kernel, times, of)| Some(times / of * counted(kernel)?));
        parts.sum()
    }
}

/// The same score of every page, of those in which there is one.
fn hits(pages: &[Page], n: usize) -> String {
    let scores = || pages.iter().filter_map(|page| page.scores.get(n));
    let hits = scores().map(|score| score.recognition.rate);
    let hits: Vec<f64> = hits.filter(|hit| hit.is_finite()).collect();
    let decided = scores().filter_map(|score| score.product);
    let decided: Vec<f64> = decided.map(|product| product.decided).collect();
    let share = if decided.is_empty() {
        String::new()
    } else {
        format!(" of {} decided", Summary::of(&decided).text(0, false))
    };
    if hits.is_empty() {
        return "nothing decided".to_owned();
    }
    format!("{}{share}", Summary::of(&hits).text(1, false))
}

/// Bytes of a classifier's tables: of the model, or by its form.
fn tables(score: &Score, form: Option<&Form>) -> Option<usize> {
    let of_model = score.product.map(|product| product.bytes);
    of_model.or(form.map(|form| form.bytes.1))
}

/// The table of the scores.
pub(super) fn section(page: &mut Page, bodies: &Bodies) {
    let scores = bodies.pages.first().map_or(&[][..], |page| &page.scores);
    let row = |(n, score): (usize, &Score)| {
        let form = FORMS
            .iter()
            .find(|form| form.classifier == score.classifier);
        let instructions = form.and_then(Form::instructions);
        let cell = |text: Option<String>| text.unwrap_or_else(|| "not counted".to_owned());
        vec![
            // |DFT| must not end the cell.
            score.classifier.replace('|', "\\|"),
            score.task.clone(),
            format!("**{}**", hits(&bodies.pages, n)),
            hits(&bodies.placebos, n),
            format!("{:.1}", score.recognition.chance),
            cell(instructions.map(|n| format!("{n:.0}"))),
            cell(form.map(|form| form.bytes.0.bytes().to_string())),
            cell(tables(score, form).map(|bytes| bytes.to_string())),
            form.map_or("", |form| &form.note).to_owned(),
        ]
    };
    let rows: Vec<Vec<String>> = scores.iter().enumerate().map(row).collect();
    if rows.is_empty() {
        return;
    }
    page.heading(2, "Every classifier: how well, and at what cost");
    page.say(
        "Hit rate, instructions a sample on a Cortex-M4F (mean, without reading the sensor; \
         composed of kernels, the product's as `cargo xtask count` counts them, the others of \
         [record 39](../decisions.md#39-what-the-papers-classifiers-would-cost-on-a-board)), bytes of state and of tables. \
         The placebo is recognised by the same classifier.",
    );
    page.table(
        "classifier | on | hit rate, % | placebo, % | chance, % | instructions a sample | state, bytes | tables, bytes | ",
        rows,
    );
}
