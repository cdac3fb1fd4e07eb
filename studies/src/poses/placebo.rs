//! Labels that mean nothing: nothing is to be decided.

use anyhow::Result;
use host_sim::progress::Verbosity;
use host_sim::recording::Stream;
use host_sim::training::Expected;
use tactile::ModelBuf;

use super::asked::{at_most, said};
use super::condition::{Change, SURFACES, Setting, WHISKER};
use super::extent::Extent;
use super::five::{Five, TILTS};
use super::one::One;
use super::output::{COLUMNS, Output, cells};
use super::tally::Tally;
use super::trained::{Relabel, THRESHOLD, judge, model};
use crate::cores::each;
use crate::decisions::figures::percent;
use crate::decisions::placebo::permuted;
use crate::page::row;
use crate::rigs::Chance;

/// The most presentations in which a class may be named, percent.
const GOAL: f64 = 1.0;
const SEED: u64 = 7501;

fn permute(streams: &mut [Stream], seed: u64) {
    let mut labels: Vec<String> = streams.iter().map(|stream| stream.label.clone()).collect();
    Chance::new(seed).shuffle(&mut labels);
    for (stream, label) in streams.iter_mut().zip(labels) {
        stream.label = label;
    }
}

fn turn(streams: &mut [Stream]) {
    let names = SURFACES.map(|(name, _)| name);
    for stream in streams {
        stream.label = permuted(&names, &stream.label, stream.trial.parse().unwrap_or(0));
    }
}

fn name_twice(streams: &mut [Stream]) {
    for (n, stream) in streams.iter_mut().enumerate() {
        stream.label.push_str(["-a", "-b"][n % 2]);
    }
}

pub(super) fn section(
    output: &mut Output,
    (one, five): (&One, &Five),
    extent: &Extent,
    verbosity: Verbosity,
) -> Result<()> {
    output.page.heading(2, "Placebos");
    output.page.say(format_args!(
        "Labels that mean nothing: permuted among the presentations of each recording; every \
         texture under every name in turn (classes that are alike); one surface alone, every \
         second presentation of it under a second name. Whatever is named is named wrongly: at \
         most {GOAL} % of presentations may be. Of labels permuted right is what chance gives, \
         of two names nothing is right, as what is presented has neither."
    ));
    let mut rows = Vec::new();
    let relabels: [(&str, Relabel<'_>); 2] = [
        ("labels permuted", &|streams, seed| permute(streams, seed)),
        ("classes alike", &|streams, _| turn(streams)),
    ];
    for (name, relabel) in relabels {
        for (poses, expect, trained) in [
            ("one pose", Expected::Bench, &one.trained),
            ("one pose, `same`", Expected::Same, &one.trained),
            ("five poses", Expected::Bench, &five.trained),
        ] {
            let models = trained.models(expect, relabel, verbosity)?;
            let tallies = trained.fresh(&models, THRESHOLD)?;
            let name = format!("{name}, {poses}");
            let kind = if expect == Expected::Same {
                "same"
            } else {
                "bench"
            };
            output.keep(["placebo", &name, kind], &trained.seeds, &tallies);
            rows.push(line(output, &name, &Tally::sum(&tallies), expect));
        }
    }
    for (poses, trained, settings) in [
        ("one pose", &one.trained, &[[].as_slice()][..]),
        (
            "five poses",
            &five.trained,
            &TILTS.each_ref().map(<[Change; 1]>::as_slice),
        ),
    ] {
        for (n, (surface, _)) in SURFACES.iter().enumerate().take(extent.surfaces) {
            let first = SEED + 100 * (settings.len() as u64 - 1) + 20 * n as u64;
            let models = twins(surface, settings, first, trained.seeds.len(), verbosity)?;
            let fresh = [&one.trained, &five.trained].map(|trained| &trained.fresh);
            let of_surface: Vec<Stream> = fresh
                .into_iter()
                .flatten()
                .flatten()
                .filter(|stream| stream.label == *surface)
                .cloned()
                .collect();
            let tallies = each(verbosity, "placebos", &models, |model| {
                judge(model, THRESHOLD, &of_surface)
            })?;
            let name = format!("{surface} under two names, {poses}");
            output.keep(["placebo", &name, "bench"], &trained.seeds, &tallies);
            rows.push(line(output, &name, &Tally::sum(&tallies), Expected::Bench));
        }
    }
    output
        .page
        .table(&format!("placebo | {COLUMNS} | decided ≤ {GOAL} % "), rows);
    Ok(())
}

/// A row; what is without a second opinion is shown for comparison.
fn line(output: &mut Output, name: &str, tally: &Tally, expect: Expected) -> Vec<String> {
    let is_met = at_most(tally.decided_share(), GOAL);
    let verdict = said(if is_met { &[] } else { &["decided"] });
    if expect != Expected::Same {
        output.goal(
            &format!("placebo: {name}"),
            &format!("decided ≤ {GOAL}"),
            format!(
                "decided {} of {}",
                percent(tally.decided_share()),
                tally.presentations
            ),
            verdict.clone(),
        );
    }
    row(name, cells(tally).into_iter().chain([verdict]))
}

/// Models of one surface alone under two names.
fn twins(
    surface: &str,
    settings: &[&[Change]],
    first: u64,
    trainings: usize,
    verbosity: Verbosity,
) -> Result<Vec<ModelBuf>> {
    let seeds: Vec<u64> = (first..).step_by(settings.len()).take(trainings).collect();
    each(verbosity, "placebos", &seeds, |&seed| {
        let recordings = settings.iter().zip(seed..).map(|(changes, seed)| {
            let setting = Setting {
                textures: Some(&[surface]),
                ..Setting::of(WHISKER, changes)
            };
            let mut streams = setting.record(seed)?;
            name_twice(&mut streams);
            Ok((seed.to_string(), streams))
        });
        model(&recordings.collect::<Result<_>>()?, Expected::Bench)
    })
}
