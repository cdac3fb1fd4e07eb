//! The classifier's arithmetic, chosen from measured error: widths of the
//! likelihood table and of the evidence, and the exponential of the posterior,
//! each against double precision.
//!
//! # Glossary
//!
//! - **entry**: log2 of a likelihood as the table has it, an integer.
//! - **deficit**: by how much a class's evidence lies behind the leader's.
//! - **variant**: one choice of entry, deficit and exponential.
//! - **product**: what the module runs, the crate `tactile` itself.
//! - **yardstick**: `tactile::reference`, double precision throughout.
//! - **open loop**: evidence starts again where the yardstick's does, so that
//!   posteriors of the same samples are compared.
//! - **closed loop**: everyone decides for himself, as on a module.

mod chosen;
mod data;
mod evidence;
mod ground;
mod likelihoods;
mod listeners;
mod measure;
mod model;
mod plot;
#[cfg(test)]
mod tests;
mod text;

use super::counts::Counts;
use super::page::Page;
use host_sim::Error;

/// Appends the section to `out`. Returns its pictures, to be put beside the
/// page: path and SVG.
///
/// # Errors
/// [`Error::Input`] if the recordings of the checkout cannot be read,
/// [`Error::Work`] if nothing can be learnt from them or the picture fails.
pub(crate) fn section(out: &mut String) -> Result<Vec<(String, String)>, Error> {
    let study = measure::Study::new(&data::recordings()?)?;
    let counts = Counts::read(&data::checkout().join("docs/instructions.csv"));
    let mut page = Page::default();
    text::write(&mut page, &study, &counts);
    page.picture(
        "classifier.svg",
        "bytes against the largest error of the log posterior, for each exponential and deficit",
        plot::work_precision(&study)?,
    );
    out.push_str(&page.text);
    Ok(page.files)
}
