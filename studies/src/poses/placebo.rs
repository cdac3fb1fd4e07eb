//! Labels that mean nothing: nothing is to be decided.

use anyhow::Result;
use host_sim::recording::Stream;
use host_sim::training::Expected;
use tactile::ModelBuf;

use super::Extent;
use super::asked::{at_most, said};
use super::condition::{Change, SURFACES, Setting, WHISKER};
use super::five::TILTS;
use super::output::{COLUMNS, Output, cells};
use super::tally::Tally;
use super::trained::{Relabel, THRESHOLD, Trained, judge, model};
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
    all: &[(&str, Expected, &Trained<'_>)],
    extent: &Extent,
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
        for &(poses, expect, trained) in all {
            let models = trained.models(expect, relabel)?;
            let tallies = trained.fresh(&models, THRESHOLD)?;
            let name = format!("{name}, {poses}");
            rows.push(line(output, &name, expect, trained, &tallies));
        }
    }
    let (one, five) = (all[0].2, all[2].2);
    let tilts = TILTS.each_ref().map(<[Change; 1]>::as_slice);
    for (poses, trained, settings) in [
        ("one pose", one, &[[].as_slice()][..]),
        ("five poses", five, &tilts),
    ] {
        for (n, (surface, _)) in SURFACES.iter().enumerate().take(extent.surfaces) {
            let first = SEED + 100 * (settings.len() as u64 - 1) + 20 * n as u64;
            let models = twins(surface, settings, first, trained)?;
            let fresh = [one, five].into_iter().flat_map(|trained| &trained.fresh);
            let of_surface = fresh.flatten().filter(|stream| stream.label == *surface);
            let of_surface: Vec<Stream> = of_surface.cloned().collect();
            let tallies = extent.cores.each("placebos", &models, |model| {
                judge(model, THRESHOLD, &of_surface)
            })?;
            let name = format!("{surface} under two names, {poses}");
            rows.push(line(output, &name, Expected::Bench, trained, &tallies));
        }
    }
    output
        .page
        .table(&format!("placebo | {COLUMNS} | decided ≤ {GOAL} % "), rows);
    Ok(())
}

/// A row; what is without a second opinion is shown for comparison.
fn line(
    output: &mut Output,
    name: &str,
    expect: Expected,
    trained: &Trained<'_>,
    tallies: &[Tally],
) -> Vec<String> {
    let is_compared = expect == Expected::Same;
    let model = if is_compared { "same" } else { "bench" };
    output.keep(["placebo", name, model], trained, tallies);
    let tally = Tally::sum(tallies);
    let decided = tally.decided_share();
    let is_met = at_most(decided, GOAL);
    let verdict = said(if is_met { &[] } else { &["decided"] });
    if !is_compared {
        output.goal(
            &format!("placebo: {name}"),
            &format!("decided ≤ {GOAL}"),
            format!("decided {} of {}", percent(decided), tally.presentations),
            verdict.clone(),
        );
    }
    row(name, cells(&tally).into_iter().chain([verdict]))
}

/// Models of one surface alone under two names.
fn twins(
    surface: &str,
    settings: &[&[Change]],
    first: u64,
    trained: &Trained<'_>,
) -> Result<Vec<ModelBuf>> {
    let seeds: Vec<u64> = (first..)
        .step_by(settings.len())
        .take(trained.seeds.len())
        .collect();
    trained.cores.each("placebos", &seeds, |&seed| {
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
