//! The runs of what was asked for, and the page of all experiments: claims and scores first, then
//! each experiment.

use anyhow::{Context, Result};
use std::fmt::Write;
use std::path::{Path, PathBuf};

use host_sim::output::write_whole;
use host_sim::progress::{Progress, Verbosity};

use super::recording::{jobs, record};
use super::{
    Arm, Asked, Bodies, Both, Extent, Judged, Name, Part, Recordings, Request, Verdict, all_judged,
    biotact, changes, data, lep10, lep12, pose, psik, verdicts,
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
                let request = asked.request(&part, seed, arm)?;
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
                let request = asked.changed(&part, seed, &change.keys)?;
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
        evaluate(&mut body, request, recordings).context(name.text())?;
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
    let names: Vec<&str> = names.into_iter().map(Name::text).collect();
    let name = if is_all {
        "all".to_owned()
    } else {
        names.join(" ")
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
        } = &done.0;
        if *extent == Extent::QUICK {
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
    let is_left_out = |name: &&Name| !all.iter().any(|done| done.0.names.contains(name));
    let left_out = Name::ALL.iter().filter(is_left_out);
    let left_out: Vec<&str> = left_out.map(|name| name.text()).collect();
    if !left_out.is_empty() {
        page.say(format_args!("Not in this run: {}.", left_out.join(", ")));
    }
}

/// How many claims have which verdict.
fn counts(judged: &[&Judged]) -> String {
    let all = [
        Verdict::Met,
        Verdict::NotMet,
        Verdict::WithinNoise,
        Verdict::DoesNotCount,
    ];
    let [met, not_met, within_noise, do_not_count] =
        all.map(|verdict| judged.iter().filter(|of| of.verdict() == verdict).count());
    format!(
        "of {} claims {met} are met, {not_met} are not met, {within_noise} are within noise, and \
         {do_not_count} do not count",
        judged.len()
    )
}

fn table_of_claims(page: &mut Page, claims: &[Both]) {
    page.heading(2, "What must come out");
    let kept: Vec<&Judged> = claims.iter().map(|claim| &claim.kept).collect();
    let again: Vec<&Judged> = claims
        .iter()
        .filter_map(|claim| claim.again.as_ref())
        .collect();
    page.say(format_args!(
        "As in the paper, {}; drawn again, {}. A claim is met or not met if zero is outside the \
         95 % interval of its margin's mean (Student's t).",
        counts(&kept),
        counts(&again)
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
        changes::section(page, &changes::of(&done.0), &done.2);
    }
}
