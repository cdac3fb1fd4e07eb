//! The page of all experiments: claims and scores first, then each experiment.

use anyhow::{Context, Result};
use std::fmt::Write;

use super::asked::{Asked, Part};
use super::recording::Recordings;
use super::request::{Arm, Extent, Name, Protocol, Request};
use super::verdicts::{Bodies, Both, Judged, Verdict, all_judged};
use super::{biotact, changes, lep10, lep12, pose, psik, scores};
use crate::page::{Files, Page, beside_others};

pub(super) fn evaluate(request: &Request, recordings: &Recordings) -> Result<Page> {
    let mut body = Page::new("experiments");
    for name in &request.names {
        let evaluate = match name {
            Name::Lep10 => lep10::evaluate,
            Name::Lep12 => lep12::evaluate,
            Name::Biotact => biotact::evaluate,
            Name::Pose => pose::evaluate,
            Name::Psikharpax => psik::evaluate,
        };
        evaluate(&mut body, request, recordings).context(name.text())?;
    }
    Ok(body)
}

/// A part, and what came of it: by arms, and by changes of what is chosen.
pub(super) struct Done {
    pub(super) part: Part,
    pub(super) bodies: Bodies,
    pub(super) changed: Vec<Bodies>,
}

fn texts(pages: &[Page]) -> Vec<&str> {
    pages.iter().map(|page| &*page.text).collect()
}

/// The page of all seeds, and before it the pictures of the first.
pub(super) fn report(asked: &Asked, all: &[Done]) -> Result<Files> {
    let mut page = Page::default();
    let mut claims = Vec::new();
    for done in all {
        claims.extend(all_judged(&done.bodies)?);
    }
    introduction(&mut page, asked, all);
    table_of_claims(&mut page, &claims);
    let rows = all.iter().flat_map(|done| scores::rows(&done.bodies));
    scores::section(&mut page, rows.collect());
    without_choices(&mut page, asked, all);
    for done in all {
        let [main, again] = [Arm::MAIN, Arm::AGAIN].map(|arm| texts(done.bodies.of(arm)));
        let text = beside_others(&main, &again);
        page.text
            .push_str(&text.context("the pages of two seeds differ in words")?);
    }
    let mut files = Files::new();
    for done in all {
        let first = done.bodies.of(Arm::MAIN).first();
        files.extend(first.map_or(&[][..], |page| &page.files).iter().cloned());
    }
    files.push((asked.page.clone(), format!("{}\n", page.text.trim_end())));
    Ok(files)
}

fn command(asked: &Asked) -> String {
    let names = asked.names();
    let name = if names == Name::ALL {
        "all".to_owned()
    } else {
        let names = names.iter().map(|name| name.text());
        names.collect::<Vec<_>>().join(" ")
    };
    let Asked { seed, seeds, .. } = asked;
    let mut said = format!("studies experiment {name} --seed {seed} --seeds {seeds}");
    if asked.quick {
        said.push_str(" --quick");
    }
    // Writing to a string does not fail.
    for short in &asked.short {
        let _ = write!(said, " --short {}", short.text);
    }
    if !asked.quick {
        let _ = write!(said, " --changes {}", asked.changes);
    }
    if let Some(folder) = &asked.rigs {
        let _ = write!(said, " --rigs '{}'", folder.display());
    }
    for setting in &asked.set {
        let _ = write!(said, " --set '{setting}'");
    }
    said
}

fn introduction(page: &mut Page, asked: &Asked, all: &[Done]) {
    page.title("Experiments", "studies experiment");
    page.say(format_args!(
        "The experiments of five papers on simulated rigs, made by `{}`. [How to repeat one, and \
         how to change a rig](../evidence.md). LEP10, LEP12: Lepora et al. 2010 and 2012; \
         BIOTACT: Sullivan et al. 2011; POSE: Evans et al.; PSIK: Psikharpax. Our figures are \
         **bold**: means over the seeds ± their standard error; pictures are of the first seed, as \
         in the paper. No table of results enters the simulation. Every key of \
         `studies/rigs/*.toml` names its source, or says that it was chosen.",
        command(asked)
    ));
    page.say(
        "Each experiment runs by two protocols, whose figures stand beside each other, divided by \
         `/`; one figure stands for both where they are the same. **As in the paper**: a class \
         keeps its spot of the surface, an arm or a table is off by 0.01 mm, and training and \
         validation share a trial where the paper splits one. **Drawn again**: spot and placement \
         are others for each recording, for each half of a trial and for each whisk, as they are \
         for whoever meets a surface again.",
    );
    for done in all {
        let Part {
            names,
            seeds,
            extent,
        } = &done.part;
        if *extent == Extent::Quick {
            let names: Vec<&str> = names.iter().map(|name| name.text()).collect();
            page.say(format_args!(
                "Cut short: {}, to seeds {} to {} and to fewer trials, whisks, contacts, sweeps and \
                 runs than the paper's, on the same physics. Hit rates of these are rough.",
                names.join(" and "),
                seeds.start,
                seeds.end.saturating_sub(1)
            ));
        }
    }
    let is_left_out = |name: &&Name| !all.iter().any(|done| done.part.names.contains(name));
    let left_out: Vec<&str> = Name::ALL
        .iter()
        .filter(is_left_out)
        .map(|name| name.text())
        .collect();
    if !left_out.is_empty() {
        page.say(format_args!("Not in this run: {}.", left_out.join(", ")));
    }
}

/// How many claims have which verdict by a protocol.
fn counts(claims: &[Both], protocol: Protocol) -> String {
    let by = || claims.iter().filter_map(|claim| claim.by(protocol));
    let count = |verdict| by().filter(|judged| judged.verdict() == verdict).count();
    format!(
        "{}, of {} claims {} are met, {} are not met, {} are within noise, and {} do not count",
        protocol.text(),
        by().count(),
        count(Verdict::Met),
        count(Verdict::NotMet),
        count(Verdict::WithinNoise),
        count(Verdict::DoesNotCount),
    )
}

fn table_of_claims(page: &mut Page, claims: &[Both]) {
    page.heading(2, "What must come out");
    let kept = counts(claims, Protocol::AsInPaper);
    page.say(format_args!(
        "A{}; {}. A claim is met or not met if zero is outside the 95 % interval of its margin's \
         mean (Student's t).",
        kept.strip_prefix('a').unwrap_or(&kept),
        counts(claims, Protocol::DrawnAgain)
    ));
    page.say(
        "Three placebos; chance is in brackets. **Labels**, by either protocol: one texture at one \
         place under all labels; a claim whose labels are recognised otherwise than by chance \
         (99 %; bold) does not count. **Spots**: one texture under all labels, each label at a spot \
         of its own that it keeps, everything else as in the paper. Bold are spots that are told \
         apart as well as textures are (no worse, on the same seeds, by the 95 % interval). Claims \
         without a placebo do not rest on telling textures apart, or are of PSIK's maze, which runs \
         once.",
    );
    let are_spots: Vec<&Both> = claims
        .iter()
        .filter(|claim| claim.may_be_the_spot())
        .collect();
    let tested = claims.iter().filter(|claim| claim.spots.is_some()).count();
    let are_told = claims.iter().filter_map(|claim| claim.spots.as_ref());
    let are_told = are_told.filter(|spots| !spots.is_at_chance()).count();
    page.say(format_args!(
        "Of {tested} claims on textures, spots of one texture are told apart in {are_told}, and in \
         {} as well as textures are. There our figure as in the paper may be recognition of the spot \
         and not of the texture. That holds for our rigs: whether the papers' surfaces were met at \
         one spot, they do not say.",
        are_spots.len()
    ));
    let judged = |judged: Option<&Judged>| {
        let ours = judged.map_or("–".to_owned(), |judged| judged.ours.clone());
        [ours, judged.map_or("–".to_owned(), Judged::margin_text)]
    };
    let labels = |judged: Option<&Judged>| {
        let labels = judged.and_then(|judged| judged.labels.as_ref());
        labels.map_or("–".to_owned(), |found| found.text(!found.is_at_chance()))
    };
    page.table(
        "claim | paper | as in the paper | margin | drawn again | margin | labels | spots | labels, \
         drawn again | as in the paper | drawn again",
        claims.iter().map(|claim| {
            let again = claim.again.as_ref();
            let spots = claim.spots.as_ref();
            let verdict = |judged: &Judged| judged.verdict().text().to_owned();
            let mut cells = vec![claim.what.clone(), claim.paper.clone()];
            cells.extend(judged(Some(&claim.kept)));
            cells.extend(judged(again));
            cells.extend([
                labels(Some(&claim.kept)),
                spots.map_or("–".to_owned(), |spots| spots.text(claim.may_be_the_spot())),
                labels(again),
                verdict(&claim.kept),
                again.map_or("–".to_owned(), verdict),
            ]);
            cells
        }),
    );
}

fn without_choices(page: &mut Page, asked: &Asked, all: &[Done]) {
    let seeds = asked.seeds_of_changes();
    if seeds.is_empty() {
        return;
    }
    page.heading(2, "Without what is chosen");
    page.say(format_args!(
        "Margins of the claims on textures, as in the paper, with one change of the rig at a time: \
         cut short (two trials, four whisks, every third angle and speed, eight sweeps), seeds {} \
         to {}. Bold: another verdict than as it is.",
        seeds.start,
        seeds.end.saturating_sub(1)
    ));
    for done in all {
        changes::section(page, changes::of(&done.part), &done.changed);
    }
}
