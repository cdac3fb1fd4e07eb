//! A robot's vibration over three grounds, by the commands `train` and
//! `classify`: the figures of the data's README, and decision for decision
//! against the independent program in double precision.

use crate::common;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use crate::reference::bayes::{self, Decided, Model};
use crate::reference::recording::{Sample, read_recording};
use host_sim::commands::classify;
use host_sim::commands::train::{self, Arguments};
use host_sim::progress::Verbosity;
use host_sim::recording::CHANNELS;
use host_sim::training::{How, Tables};
use scene::Rule;
use tempfile::TempDir;

struct Terrain {
    folder: TempDir,
    model: PathBuf,
    reference: Model,
    test: Vec<Sample>,
}

fn data(name: &str) -> PathBuf {
    common::project(&format!("tests/data/terrain/{name}"))
}

fn recording(name: &str) -> Vec<Sample> {
    read_recording(&std::fs::read_to_string(data(name)).unwrap()).unwrap()
}

fn terrain() -> Terrain {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("terrain.model");
    let arguments = Arguments {
        data: vec![data("terrain-train.csv")],
        channels: CHANNELS.map(str::to_owned),
        out: model.clone(),
        rate: None,
        unknown: None,
        scene: None,
        plot: None,
        how: How::of(Tables::Single),
    };
    train::train(&arguments).unwrap();
    Terrain {
        folder,
        model,
        reference: bayes::train(&recording("terrain-train.csv"), 100, 5.0, 20),
        test: recording("terrain-test.csv"),
    }
}

/// What the product decides, and what it says about it.
fn decide(terrain: &Terrain, rule: Rule) -> (Vec<Decided>, String) {
    let out = terrain.folder.path().join("decisions.csv");
    let data = data("terrain-test.csv");
    let (model, quiet) = (&terrain.model, Verbosity::Quiet);
    let said = classify::classify(model, &data, CHANNELS, rule, &out, quiet);
    (read_decisions(&out), said.unwrap())
}

fn read_decisions(path: &Path) -> Vec<Decided> {
    let mut table = csv::Reader::from_path(path).unwrap();
    let header: Vec<&str> = table.headers().unwrap().iter().collect();
    let expected = "label,trial,decision,samples,posterior,touch,reason,among";
    assert_eq!(header.join(","), expected);
    table.deserialize().collect::<Result<_, _>>().unwrap()
}

/// The rows of the README's table: threshold, hit rate in %, mean samples and decisions
/// of the sequential rule, window, and hit rate in % of fixed windows.
fn figures() -> Vec<[f64; 6]> {
    let text = std::fs::read_to_string(data("README.md")).unwrap();
    let rows = text.lines().filter_map(|line| {
        let cells = line.strip_prefix('|')?.strip_suffix('|')?.split('|');
        let number = |cell: &str| cell.trim().trim_end_matches(" %").parse::<f64>();
        let cells: Vec<f64> = cells.map(number).collect::<Result<_, _>>().ok()?;
        cells.try_into().ok()
    });
    rows.collect()
}

/// Decisions by stream (label and trial) and the sample after which they fall.
fn by_place(decisions: &[Decided]) -> BTreeMap<(&str, &str, usize), &Decided> {
    let mut ends: HashMap<(&str, &str), usize> = HashMap::new();
    let places = decisions.iter().map(|d| {
        let end = ends.entry((&d.label, &d.trial)).or_default();
        *end += d.samples;
        ((d.label.as_str(), d.trial.as_str(), *end), d)
    });
    let placed: BTreeMap<_, _> = places.collect();
    assert_eq!(placed.len(), decisions.len());
    placed
}

/// The share of decisions that both programs make after the same samples for
/// the same class, and the largest difference of the posterior among those.
fn agreement(a: &[Decided], b: &[Decided]) -> (f64, f64) {
    let (a, b) = (by_place(a), by_place(b));
    let differences = a.iter().filter_map(|(place, a)| {
        let b = b.get(place)?;
        let same = a.decision == b.decision && a.samples == b.samples;
        same.then(|| (a.posterior - b.posterior).abs())
    });
    let differences: Vec<f64> = differences.collect();
    let all = a.len() + b.len() - differences.len();
    let worst = differences.iter().copied().fold(0.0, f64::max);
    (differences.len() as f64 / all as f64, worst)
}

#[track_caller]
fn agree(what: &str, product: &[Decided], reference: &[Decided], within: f64) {
    let (share, worst) = agreement(product, reference);
    println!("{what}: {share:.4} as the reference, posteriors within {worst:.4}");
    assert!(share >= 0.995, "{what}: {share}");
    assert!(worst <= within, "{what}: {worst}");
}

/// Those of both programs, for which the reference stays in memory and the product writes a file.
#[test]
fn decisions_have_the_known_figures_and_agree_with_the_reference() {
    let terrain = terrain();
    assert_eq!(terrain.reference.classes, ["sandy_loam", "ice", "asphalt"]);
    let reference = |rule| bayes::classify(&terrain.reference, &terrain.test, rule);
    let percent = |decisions: &[Decided]| 100.0 * bayes::hit_rate(decisions);
    let figures = figures();
    assert_eq!(figures.len(), 3);
    for [threshold, hits, samples, count, window, window_hits] in figures {
        let (decided, said) = decide(&terrain, Rule::Sequential { threshold });
        let summary = format!(
            "{} decisions, hit rate {hits:.1} % (mean over classes), mean {samples:.0} samples",
            decided.len()
        );
        assert!(said.ends_with(&summary), "{said}");
        let exact = reference(bayes::Rule::Sequential(threshold));
        agree(&format!("threshold {threshold}"), &decided, &exact, 0.003);
        for decisions in [decided, exact] {
            assert_eq!(decisions.len(), count as usize);
            assert!((percent(&decisions) - hits).abs() <= 0.06);
            assert!((bayes::mean_samples(&decisions) - samples).abs() <= 0.5);
            assert!(decisions.iter().all(|d| d.posterior > threshold));
        }

        let samples = window as u32;
        let (decided, _) = decide(&terrain, Rule::Window { samples });
        let exact = reference(bayes::Rule::Window(window as usize));
        assert_eq!(decided.len(), exact.len());
        agree(&format!("window {window}"), &decided, &exact, 0.002);
        for decisions in [decided, exact] {
            assert!((percent(&decisions) - window_hits).abs() <= 0.06);
            assert!(decisions.iter().all(|d| d.samples == window as usize));
        }
    }
}
