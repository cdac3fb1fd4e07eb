//! docs/measured/cost.md, and the table for a person to read.

use std::fmt::Write as _;

use super::stages::{Stage, beside, reasons, stages};
use crate::figures::{Figure, INSTRUCTIONS};
use crate::run::Fault;
use crate::size;

/// Mean and worst of `what` in `what,mean,worst` lines, as they stand there.
fn cells<'t>(said: &'t str, what: &str) -> Result<[&'t str; 2], Fault> {
    let of = |line: &'t str| line.strip_prefix(what)?.strip_prefix(',')?.split_once(',');
    let found = said.lines().find_map(of).map(<[&str; 2]>::from);
    found.ok_or_else(|| format!("the board does not tell its {what}"))
}

fn number(what: &str, text: &str) -> Result<f64, Fault> {
    text.parse().map_err(|_| format!("{what}: {text}"))
}

/// The same as numbers.
pub(super) fn figures(said: &str, what: &str) -> Result<[f64; 2], Fault> {
    let [mean, worst] = cells(said, what)?;
    Ok([number(what, mean)?, number(what, worst)?])
}

/// The goals for the mean and for the worst, as far as there are any.
fn goals(goal: &str) -> Vec<f64> {
    goal.split(|c: char| !c.is_ascii_digit())
        .filter_map(|number| number.parse().ok())
        .collect()
}

/// Whether the mean, and the worst where that has a goal, are within the goal;
/// `None` without one.
fn met(numbers: &[f64], goal: &str) -> Option<bool> {
    let goals = goals(goal);
    let within = |(goal, found): (&f64, &f64)| found <= goal;
    (!goals.is_empty()).then(|| goals.iter().zip(numbers).all(within))
}

fn verdict(numbers: &[f64], goal: &str) -> &'static str {
    match met(numbers, goal) {
        None => "",
        Some(true) => "met",
        Some(false) => "**missed**",
    }
}

/// Goal, verdict and peers beside a stage.
pub(super) fn note(stage: &Stage, numbers: &[f64]) -> String {
    let Stage { goal, others, .. } = stage;
    let verdict = verdict(numbers, goal).trim_matches('*');
    format!("{goal:>16}  {verdict:6}  {others}")
}

/// What misses its goal and why; to miss one without a reason is a fault.
fn missed(stages: &[Stage], figures: &[Figure]) -> Result<String, Fault> {
    let goal = |figure: &Figure| beside(stages, figure)[0];
    let mut missed: Vec<&Figure> = figures.iter().collect();
    missed.retain(|figure| met(&figure.numbers, goal(figure)) == Some(false));
    let mut text = String::new();
    for reason in reasons()? {
        let lines = missed.extract_if(.., |figure| reason.stages.contains(&figure.key[0]));
        let lines = lines.map(|figure| {
            let times = figure.numbers[0] / goals(goal(figure))[0];
            format!("{}, {times:.2} times the goal", figure.key.join(" on "))
        });
        let lines: Vec<String> = lines.collect();
        if !lines.is_empty() {
            let _ = write!(text, "\n- *{}*: {}\n", lines.join("; "), reason.why);
        }
    }
    match missed.first() {
        None => Ok(text),
        Some(figure) => Err(format!(
            "{} misses its goal: say why in xtask/src/cost/reasons.toml",
            figure.key.join(" on ")
        )),
    }
}

pub(super) fn page(figures: &[Figure], deadlines: &str, sizes: &[Figure]) -> Result<String, Fault> {
    let stages = stages()?;
    let rows = figures.iter().map(|figure| {
        let [goal, others] = beside(&stages, figure);
        let [key, numbers] = [figure.key.join(" | "), figure.text(INSTRUCTIONS, " | ")];
        let verdict = verdict(&figure.numbers, goal);
        format!("| {key} | {numbers} | {goal} | {verdict} | {others} |")
    });
    let deadline = |line: &str| format!("| {} |", line.replace(',', " | "));
    let shown: Vec<String> = deadlines.lines().skip(1).map(deadline).collect();
    let stack = "bytes of stack by its paint";
    let [_, used] = cells(deadlines, stack)?;
    let used = number(stack, used)?;
    let mut full = sizes.iter();
    let full = full.find(|size| size.key == ["full", "nucleo-f446re"]);
    if full.is_some_and(|size| used > size.numbers[2]) {
        let fault = format!("{used} bytes of stack were used: its bound is wrong");
        return Err(fault);
    }
    Ok(format!(
        include_str!("page.md.in"),
        stages = rows.collect::<Vec<_>>().join("\n"),
        reasons = missed(&stages, figures)?.trim_end(),
        deadlines = shown.join("\n"),
        limits = size::limits(),
        sizes = size::beside_goals(sizes)?,
    ))
}
