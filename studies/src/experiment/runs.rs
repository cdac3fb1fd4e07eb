//! The runs of what was asked for, and the page of all experiments: claims and scores first, then
//! each experiment.

use anyhow::{Context, Result};
use std::fmt::Write;
use std::path::{Path, PathBuf};

use host_sim::output::write_whole;
use host_sim::progress::{Progress, Verbosity};

use super::recording::{jobs, record};
use super::verdicts::Recognised;
use super::{
    Arm, Asked, Bodies, Both, Extent, Judged, Name, Part, Recordings, Request, VERDICTS,
    all_judged, biotact, changes, data, lep10, lep12, pose, psik, verdicts,
};
use crate::page::{Files, Page, beside_others};

/// A part, and what came of it: by arms, and by changes of what is chosen.
struct Done(Part, Bodies, Vec<Bodies>);

/// Each part's seeds by all arms, then the changes of what is chosen. The page is written of what
/// is done so far, as a run takes hours; data of its figures and recordings where they are asked
/// for. Gives the page's path.
pub(crate) fn run(asked: &Asked, verbosity: Verbosity) -> Result<PathBuf> {
    let write = |folder: &Path, files: &Files| {
        let mut all = files.iter();
        all.try_for_each(|(name, text)| write_whole(&folder.join(name), text.as_bytes()))
    };
    let parts = asked.parts();
    let count = |part: &Part| {
        let runs = part.seeds.end.saturating_sub(part.seeds.start) * asked.arms().len() as u64;
        runs + asked.changes * changes::of(part).len() as u64
    };
    let mut bar = Progress::new(verbosity, "runs", parts.iter().map(count).sum());
    let mut runs = 0;
    let mut ran = || {
        runs += 1;
        bar.set(runs);
    };
    let mut all = Vec::new();
    for part in parts {
        let mut bodies = Bodies::default();
        for seed in part.seeds.clone() {
            for &arm in asked.arms() {
                let request = asked.request(&part, seed, arm, None)?;
                let recordings = record(&request, &jobs(&request))?;
                if let Some(folder) = asked.data.as_ref().filter(|_| asked.recordings)
                    && arm == Arm::MAIN
                {
                    write(folder, &data::recordings(asked, seed, &recordings)?)?;
                }
                bodies.add(arm, evaluate(&request, &recordings)?);
                ran();
            }
        }
        if let Some(folder) = &asked.data {
            write(folder, &data::figures(asked, &part, &bodies)?)?;
        }
        let mut changed = Vec::new();
        for change in changes::of(&part) {
            let mut bodies = Bodies::default();
            for seed in asked.seeds_of_changes() {
                let request = asked.request(&part, seed, Arm::MAIN, Some(&change.keys))?;
                let recordings = record(&request, &jobs(&request))?;
                bodies.add(Arm::MAIN, evaluate(&request, &recordings)?);
                ran();
            }
            changed.push(bodies);
        }
        all.push(Done(part, bodies, changed));
        write(&asked.out, &report(asked, &all)?)?;
    }
    Ok(asked.out.join(&asked.page))
}

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
        evaluate(&mut body, request, recordings).with_context(|| name.text())?;
    }
    Ok(body)
}

fn texts(pages: &[Page]) -> Vec<&str> {
    pages.iter().map(|page| &*page.text).collect()
}

/// The page of all seeds, and before it the pictures of the first.
fn report(asked: &Asked, all: &[Done]) -> Result<Files> {
    let mut page = Page::default();
    let mut claims = Vec::new();
    for done in all {
        claims.extend(all_judged(&done.1)?);
    }
    introduction(&mut page, asked, all);
    table_of_claims(&mut page, &claims);
    let rows = all.iter().flat_map(|done| verdicts::scores(&done.1));
    verdicts::table_of_scores(&mut page, rows.collect());
    without_choices(&mut page, asked, all);
    for done in all {
        let [main, again] = [Arm::MAIN, Arm::AGAIN].map(|arm| texts(done.1.of(arm)));
        let text = beside_others(&main, &again);
        page.text
            .push_str(&text.context("the pages of two seeds differ in words")?);
    }
    let mut files = Files::new();
    for done in all {
        let first = done.1.of(Arm::MAIN).first();
        files.extend(first.map_or(&[][..], |page| &page.files).iter().cloned());
    }
    files.push((asked.page.clone(), format!("{}\n", page.text.trim_end())));
    Ok(files)
}

fn command(asked: &Asked) -> String {
    let names = asked.names();
    let is_all = names == Name::ALL;
    let names: Vec<String> = names.into_iter().map(Name::text).collect();
    let name = if is_all { "all" } else { &names.join(" ") };
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
        } = &done.0;
        if *extent == Extent::QUICK {
            let names: Vec<String> = names.iter().map(|name| name.text()).collect();
            page.say(format_args!(
                "Cut short: {}, to seeds {} to {} and to fewer trials, whisks, contacts, sweeps and \
                 runs than the paper's, on the same physics. Hit rates of these are rough.",
                names.join(" and "),
                seeds.start,
                seeds.end.saturating_sub(1)
            ));
        }
    }
    let is_left_out = |name: &&Name| !all.iter().any(|done| done.0.names.contains(name));
    let left_out = Name::ALL.iter().filter(is_left_out);
    let left_out: Vec<String> = left_out.map(|name| name.text()).collect();
    if !left_out.is_empty() {
        page.say(format_args!("Not in this run: {}.", left_out.join(", ")));
    }
}

/// How many claims have which verdict.
fn counts(judged: &[&Judged]) -> String {
    let [met, not_met, within_noise, do_not_count] =
        VERDICTS.map(|verdict| judged.iter().filter(|of| of.verdict() == verdict).count());
    format!(
        "of {} claims {met} are met, {not_met} are not met, {within_noise} are within noise, and \
         {do_not_count} do not count",
        judged.len()
    )
}

fn table_of_claims(page: &mut Page, claims: &[Both]) {
    page.heading(2, "What must come out");
    let kept: Vec<&Judged> = claims.iter().map(|claim| &claim.kept).collect();
    let again: Vec<&Judged> = claims.iter().flat_map(|claim| &claim.again).collect();
    let [kept, again] = [kept, again].map(|judged| counts(&judged));
    page.say(format_args!(
        "As in the paper, {kept}; drawn again, {again}. A claim is met or not met if zero is outside \
         the 95 % interval of its margin's mean (Student's t)."
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
    let are_spots = claims.iter().filter(|claim| claim.may_be_the_spot());
    let are_spots = are_spots.count();
    let spots = || claims.iter().flat_map(|claim| &claim.spots);
    let are_told = spots().filter(|spots| !spots.is_at_chance()).count();
    let tested = spots().count();
    page.say(format_args!(
        "Of {tested} claims on textures, spots of one texture are told apart in {are_told}, and in \
         {are_spots} as well as textures are. There our figure as in the paper may be recognition of \
         the spot and not of the texture. That holds for our rigs: whether the papers' surfaces were \
         met at one spot, they do not say."
    ));
    let none = || "–".to_owned();
    let judged = |judged: Option<&Judged>| {
        let Some(judged) = judged else {
            return [(); 4].map(|()| none());
        };
        let labels = judged.labels.as_ref();
        let labels = labels.map_or_else(none, |found| found.text(!found.is_at_chance()));
        let verdict = judged.verdict().to_owned();
        [judged.ours.clone(), judged.margin_text(), labels, verdict]
    };
    let line = |claim: &Both| {
        let [ours, margin, labels, verdict] = judged(Some(&claim.kept));
        let [again, margin_again, labels_again, verdict_again] = judged(claim.again.as_ref());
        let text = |spots: &Recognised| spots.text(claim.may_be_the_spot());
        let spots = claim.spots.as_ref().map_or_else(none, text);
        let (what, paper) = (claim.what.clone(), claim.paper.clone());
        let found = [ours, margin, again, margin_again];
        let placebos = [labels, spots, labels_again];
        let verdicts = [verdict, verdict_again];
        [&[what, paper][..], &found, &placebos, &verdicts].concat()
    };
    page.table(
        "claim | paper | as in the paper | margin | drawn again | margin | labels | spots | labels, \
         drawn again | as in the paper | drawn again",
        claims.iter().map(line),
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
        changes::section(page, &changes::of(&done.0), &done.2);
    }
}
