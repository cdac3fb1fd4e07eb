//! The accuracy report: `docs/measured/accuracy.md` and its pictures, generated.
//!
//! Each section is a module that measures and appends its text, tables and
//! pictures. All of it is the same, byte for byte, in every run.

mod contact;
mod integrators;
mod reference;
pub(crate) mod schemes;

use anyhow::Result;
use std::path::Path;

use crate::page::{Files, Page};
use reference::{Case, Truth};
use schemes::{Counts, Format, Scheme, TARGETS, cell};

/// Measures everything. `docs` is the folder whose table of instructions is read.
pub(crate) fn report(docs: &Path) -> Result<Files> {
    let counts = Counts::read(&docs.join("instructions.csv"))?;
    let near = integrators::measure(&integrators::NEAR)?;

    let mut page = Page::new("accuracy");
    introduction(&mut page);
    integrators::choice(&mut page, &near, &counts)?;
    integrators::section(&mut page, &near, &counts)?;
    contact::section(&mut page, &contact::measure()?)?;

    Ok(page.into_files())
}

fn introduction(page: &mut Page) {
    page.title("Accuracy", "cargo xtask docs");
    page.say(
        "How far each integrator and number format is from the truth, and what it costs. Every number and picture here is measured by `studies report` with the \
         code that runs on a module.",
    );
    page.heading(2, "How to read this, and which integrator to take");
    page.say(
        "Each diagram sets the error against the work of one second, both in powers of ten. Down \
         is more accurate, left is cheaper: a curve below and left of another is better at \
         everything. Find the panel of your whisk frequency, go down to the error that you can \
         live with (a motor's encoder resolves about 0.06 degrees), and take the leftmost point \
         below it: its curve is the integrator and number format, its place on the curve the \
         tick. Full dots are the exact integrator, rings are the papers' forward Euler.",
    );
    page.say(
        "Truth is the continuous equations, solved with 40,000 Runge-Kutta steps a whisk, within \
         1e-10 degrees of an independent solver of eighth order. Forward Euler is the papers' \
         integrator and reproduces their figures, but its limit cycle is too wide. Where curves \
         of f32 and fixed flatten, rounding has taken over, and a shorter tick does not help.",
    );
}
