//! Labels that mean nothing, of which nothing is to be decided, and a texture that the model does not
//! know.

use anyhow::Result;
use host_sim::recording::Stream;
use host_sim::training::Expected;
use tactile::ModelBuf;

use super::{
    Change, Extent, Output, Relabel, SURFACES, Setting, THRESHOLD, TILTS, Tally, Trained, WHISKER,
    cells, judge, missed, model, said,
};
use crate::decisions::{percent, permuted};
use crate::page::row;
use crate::rigs::Chance;

/// The most presentations in which a class may be named, percent.
const GOAL: f64 = 1.0;
const SEED: u64 = 8501;

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
    output.table("placebo", &format!("decided ≤ {GOAL} % "), rows);
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
    let verdict = said(&missed([("decided", 100.0 * decided.low > GOAL)]));
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
    let seeds = (first..).step_by(settings.len());
    let seeds: Vec<u64> = seeds.take(trained.seeds.len()).collect();
    trained.cores.each("placebos", &seeds, |&seed| {
        let recordings = settings.iter().zip(seed..).map(|(changes, seed)| {
            let setting = Setting {
                textures: Some(&[surface]),
                ..Setting::of(WHISKER, changes)
            };
            let mut streams = setting.record(seed)?;
            for (n, stream) in streams.iter_mut().enumerate() {
                stream.label.push_str(["-a", "-b"][n % 2]);
            }
            Ok((seed.to_string(), streams))
        });
        model(&recordings.collect::<Result<_>>()?, Expected::Bench)
    })
}

/// The least of decisions on what is unknown that are to name none, and the most on what is
/// known, percent.
const REFUSED: f64 = 65.0;
const FALSE: f64 = 6.0;

pub(super) fn unknown(
    output: &mut Output,
    all: &[(&str, Expected, &Trained<'_>)],
    extent: &Extent,
) -> Result<()> {
    output.page.heading(2, "Unknown textures");
    output.page.say(
        "Each texture in turn is left out of the training and presented all the same. Refused: \
         of decisions, those that named none, whatever the reason; of presentations, those in \
         which none was named. Known: the other three.",
    );
    let mut rows = Vec::new();
    for (poses, expect, trained) in all {
        let mut sums = [Tally::default(); 2];
        for (left_out, _) in SURFACES.iter().take(extent.surfaces) {
            let without = |streams: &mut Vec<Stream>, _: u64| {
                streams.retain(|stream| stream.label != *left_out);
            };
            let models = trained.models(*expect, &without)?;
            let is_unknown = |stream: &Stream| stream.label == *left_out;
            let unknown = trained.fresh_of(&models, is_unknown)?;
            let known = trained.fresh_of(&models, |stream| !is_unknown(stream))?;
            let setting = format!("without {left_out}; {poses}");
            output.keep(["unknown", &setting, "unknown"], trained, &unknown);
            output.keep(["unknown", &setting, "known"], trained, &known);
            let both = [Tally::sum(&unknown), Tally::sum(&known)];
            sums = [0, 1].map(|n| Tally::sum([&sums[n], &both[n]]));
            rows.push(row(format!("{poses}: {left_out}"), refused(&both)));
        }
        rows.push(row(format!("{poses}: all"), refused(&sums)));
        if *expect == Expected::Same {
            continue;
        }
        let [unknown, known] = sums.map(|tally| tally.refused_share());
        let is_missed = [
            ("refused", 100.0 * unknown.high < REFUSED),
            ("false", 100.0 * known.low > FALSE),
        ];
        let [unknown, known] = [unknown, known].map(percent);
        let [of_unknown, of_known] = sums.map(|tally| percent(tally.undecided_share()));
        output.goal(
            &format!("unknown texture: {poses}"),
            &format!("refused ≥ {REFUSED} of decisions, of known ≤ {FALSE}"),
            format!(
                "refused {unknown}, of known {known}; of presentations {of_unknown} and {of_known}"
            ),
            said(&missed(is_missed)),
        );
    }
    output.page.table(
        "trained: left out | refused, of decisions | of presentations | presentations | known: \
         refused, of decisions | of presentations | presentations",
        rows,
    );
    Ok(())
}

fn refused(both: &[Tally; 2]) -> Vec<String> {
    let cells = both.iter().flat_map(|tally| {
        [
            percent(tally.refused_share()),
            percent(tally.undecided_share()),
            tally.presentations.to_string(),
        ]
    });
    cells.collect()
}
