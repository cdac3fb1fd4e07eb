//! What changes of rigs do to claims: margins beside each other, and the reasons that follow.

use super::variants::{Kind, Variant};
use super::verdicts::{Bodies, Judged, Verdict, judged};
use crate::page::Page;
use anyhow::Result;

/// What came of a change.
#[derive(Debug)]
pub(super) struct Changed {
    pub(super) variant: &'static Variant,
    pub(super) bodies: Bodies,
}

/// A margin and what it means: bold if not met, in brackets if within noise.
fn cell(claim: &Judged) -> String {
    let text = claim.margin_text();
    match claim.verdict() {
        Verdict::Met => text,
        Verdict::NotMet => format!("**{text}**"),
        Verdict::WithinNoise => format!("({text})"),
        Verdict::DoesNotCount => format!("~~{text}~~"),
    }
}

/// What each change of a rig does to the claims that rest on it.
pub(super) fn section(page: &mut Page, claims: &[Judged], changed: &[Changed]) -> Result<()> {
    if changed.is_empty() {
        return Ok(());
    }
    page.heading(2, "What was chosen, and each claim without it");
    let seeds = changed.iter().map(|one| one.bodies.pages.len()).max();
    page.say(format_args!(
        "One thing is changed at a time, {} seeds each: margins of the claims, **bold** where they \
         are not met, (in brackets) within noise, ~~struck out~~ where a placebo is recognised. \
         *Without* undoes what was chosen, mostly after a result had been seen; *cause* changes \
         what might be why a claim is not met. Those with (†) have a placebo of their own.",
        seeds.unwrap_or(0)
    ));
    let mut gains: Vec<(usize, f64, &str)> = Vec::new();
    let mut rest = changed;
    while let Some(first) = rest.first() {
        let of = |one: &Changed| one.variant.dataset() == first.variant.dataset();
        let (group, after) = rest.split_at(rest.iter().take_while(|one| of(one)).count());
        rest = after;
        let mut columns = Vec::new();
        for one in group {
            let variant = one.variant;
            let kind = match variant.kind {
                Kind::Without => "without",
                Kind::Cause => "cause",
            };
            columns.push(judged(&one.bodies.pages, &one.bodies.placebos)?);
            let mark = if variant.has_placebo { " (†)" } else { "" };
            let Variant { name, note, .. } = variant;
            page.say(format_args!("- {name} (*{kind}*){mark}: {note}."));
        }
        let concerned = |claim: &&Judged| {
            columns
                .iter()
                .flatten()
                .any(|other| other.what == claim.what)
        };
        let mut rows = Vec::new();
        for (n, claim) in claims
            .iter()
            .enumerate()
            .filter(|(_, claim)| concerned(claim))
        {
            let mut cells = vec![claim.what.clone(), cell(claim)];
            for (column, one) in columns.iter().zip(group) {
                let other = column.iter().find(|other| other.what == claim.what);
                cells.push(other.map_or("–".to_owned(), cell));
                if let Some(gain) = other.and_then(|other| claim.gain_of(other)) {
                    gains.push((n, gain, &one.variant.name));
                }
            }
            rows.push(cells);
        }
        let names: Vec<&str> = group.iter().map(|one| &*one.variant.name).collect();
        page.table(&format!("claim | as it is | {}", names.join(" | ")), rows);
    }
    reasons(page, claims, &gains);
    Ok(())
}

/// Why claims are not met: the changes that the seeds are sure to help.
fn reasons(page: &mut Page, claims: &[Judged], gains: &[(usize, f64, &str)]) {
    let unmet = |(_, claim): &(usize, &Judged)| claim.verdict() != Verdict::Met;
    page.say(
        "Where a claim is not met, the changes above after which its margin is larger beyond the \
         noise; what is not listed has no reason that was confirmed:",
    );
    for (n, claim) in claims.iter().enumerate().filter(unmet) {
        let mine = gains.iter().filter(|(of, ..)| *of == n);
        let digits = claim.digits();
        let mine: Vec<String> = mine
            .map(|(_, gain, name)| format!("{name} ({gain:+.digits$})"))
            .collect();
        let why = if mine.is_empty() {
            "none".to_owned()
        } else {
            mine.join("; ")
        };
        page.say(format_args!("- *{}*: {why}.", claim.what));
    }
}
