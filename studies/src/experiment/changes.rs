//! The experiments without what is chosen: changes of the rigs (`changes.toml`), each tried by the papers' protocol, cut short, on a few seeds of its own.

use serde::Deserialize;

use super::{Arm, Bodies, Name, Part, digits, margins};
use crate::moments::Summary;
use crate::page::{Claim, Page};
use crate::paper::printed;

#[derive(Deserialize)]
pub(super) struct Change {
    name: String,
    pub(super) keys: Vec<String>,
}

pub(super) fn of(part: &Part) -> Vec<Change> {
    let rig = match part.names[0] {
        Name::Lep10 | Name::Lep12 => "floor",
        Name::Biotact => "head",
        Name::Pose => "table",
        Name::Psikharpax => "pad",
    };
    printed(include_str!("changes.toml"), rig)
}

/// The margins of a part's claims, of `bodies` by changes.
pub(super) fn section(page: &mut Page, changes: &[Change], bodies: &[Bodies]) {
    let all: Vec<&[Page]> = bodies.iter().map(|bodies| bodies.of(Arm::MAIN)).collect();
    let claims = all.first().and_then(|pages| pages.first());
    let claims = claims.map_or(&[][..], |page| &page.claims);
    let is_of_textures = |claim: &&Claim| claim.recognition.is_some();
    let row = |claim: &Claim| {
        let found = all.iter().map(|pages| margins(pages, &claim.what));
        let found: Vec<Summary> = found.collect();
        let usual = found.first().map_or(0, Summary::side);
        let cell = |margin: &Summary| {
            let bold = if margin.side() == usual { "" } else { "**" };
            format!("{bold}{}{bold}", margin.text(digits(claim.unit), true))
        };
        std::iter::once(format!("{}, {}", claim.what, claim.unit))
            .chain(found.iter().map(cell))
            .collect()
    };
    let names: Vec<&str> = changes.iter().map(|change| &*change.name).collect();
    let header = format!("claim, margin in | {}", names.join(" | "));
    page.table(&header, claims.iter().filter(is_of_textures).map(row));
}
