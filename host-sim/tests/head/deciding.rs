//! What boards decide together, beside the one board that has all their whiskers; of a texture that
//! was not trained; and where there is nothing to tell apart.

use std::path::Path;

use host_sim::classifier::Classifier;
use host_sim::commands::record;
use host_sim::progress::Verbosity;
use host_sim::run::Run;
use host_sim::training::{How, Tables};
use tactile::ModelBuf;

use super::{ROOT, scene};

const ALIKE: &str = "plant.textures=[\"p600\"]";

/// A dozen whiskers are a side.
const BOTH_SIDES: [&str; 3] = [
    "head.sides=both",
    "whisking.start=[[1.0, 0.0], [1.0, 0.0]]",
    "plant.obstacle_deg=[100.0, 100.0]",
];

/// What a head decided of textures.
#[derive(Default)]
struct Said {
    decisions: usize,
    /// How many name a class, and how many of these the right one.
    named: usize,
    right: usize,
    /// Decisions of a texture that was not trained, and how many of them name a class.
    untrained: usize,
    named_untrained: usize,
    samples: f64,
}

fn decided(name: &str, model: ModelBuf, overrides: &[&str], missed: f64) -> Said {
    let scene = scene(name, overrides);
    let names: Vec<String> = model.names().map(str::to_owned).collect();
    let classifier = Classifier::of_scene(model, &scene).unwrap();
    let mut run = Run::new(&scene, Some(classifier)).unwrap();
    if let Some(bus) = run.bus() {
        bus.disturb(missed, 0.0, 5);
        bus.repeat(missed / 10.0);
    }
    let mut said = Said::default();
    for _ in 0..run.ticks() {
        run.pass();
        for decided in run.decisions() {
            let is_named = decided.decision != "unknown";
            let is_trained = names.contains(&decided.label);
            said.decisions += 1;
            said.samples += f64::from(decided.samples);
            said.named += usize::from(is_named);
            said.right += usize::from(decided.decision == decided.label);
            said.untrained += usize::from(!is_trained);
            said.named_untrained += usize::from(!is_trained && is_named);
        }
    }
    said
}

pub(super) fn shipped(name: &str) -> ModelBuf {
    let model = Path::new(ROOT).join(format!("models/{name}.model"));
    ModelBuf::from_bytes(&std::fs::read(model).unwrap()).unwrap()
}

/// What so many boards of a whisker each, or one board with as many, decide together in a scene.
fn said(
    (name, model, set): (&str, ModelBuf, &[&str]),
    (boards, has_bus): (usize, bool),
    (missed, seed): (f64, u64),
) -> Said {
    let sides = boards.div_ceil(12);
    let each = format!("head.whiskers_per_side={}", boards / sides);
    let nodes = format!("head.nodes={boards}");
    let seed = format!("seed={seed}");
    let mut overrides = vec![each.as_str(), &seed, "classifier.whiskers=together"];
    if sides > 1 {
        overrides.extend(BOTH_SIDES);
    }
    overrides.extend(set);
    if has_bus {
        overrides.push(&nodes);
    }
    decided(name, model, &overrides, missed)
}

/// In a scene that has a model of its name.
fn together(name: &str, boards: usize, has_bus: bool, (missed, seed): (f64, u64)) -> Said {
    let scene = format!("{name}.toml");
    let of_it = (scene.as_str(), shipped(name), &[][..]);
    said(of_it, (boards, has_bus), (missed, seed))
}

/// Four boards name the right texture as often as one with their whiskers, in the mean by as many
/// samples. What half of the boards misses makes it no worse. Each is a sum over six seeds.
#[test]
fn boards_decide_together() {
    let of = |has_bus: bool, missed: f64| {
        let said = (11..17).map(|seed| together("textures", 4, has_bus, (missed, seed)));
        let said: Vec<Said> = said.collect();
        let sum = |of: fn(&Said) -> usize| said.iter().map(of).sum::<usize>() as f64;
        let counts = [
            sum(|of| of.right),
            sum(|of| of.named),
            sum(|of| of.decisions),
        ];
        (counts, said.iter().map(|of| of.samples).sum::<f64>())
    };
    let ([_, _, of_one], samples_of_one) = of(false, 0.0);
    for missed in [0.0, 0.5] {
        let ([right, named, decisions], samples) = of(true, missed);
        assert!(right > 0.98 * named, "{right} of {named}");
        assert!(named > 0.9 * decisions, "{named} of {decisions}");
        assert!(2.0 * decisions > of_one, "{decisions} of {of_one}");
        let longer = samples / decisions / (samples_of_one / of_one);
        assert!((0.7..1.3).contains(&longer), "{longer}");
    }
}

/// A texture that was not trained is unknown to the boards together too: floors are those of all
/// their whiskers. By its own whiskers alone the board that adds up named it in 9 of 100.
#[test]
fn boards_together_name_no_texture_that_was_not_trained() {
    let said = together("unknown", 8, true, (0.0, 21));
    let (named, all) = (said.named_untrained, said.untrained);
    assert!(all > 200 && named * 50 < all, "{named} of {all}");
}

/// So do two dozen boards, a whisker each.
#[test]
fn a_head_of_two_dozen_boards_names_textures() {
    let set = &["duration_s=10.0"][..];
    let of_it = ("textures.toml", shipped("textures"), set);
    let said = said(of_it, (24, true), (0.0, 31));
    assert!(said.named > 100, "{}", said.named);
    assert!(said.named * 10 > said.decisions * 9, "{}", said.decisions);
    assert!(said.right * 100 > said.named * 97, "{}", said.right);
}

/// A model that was trained to tell a texture from itself; without a second opinion, with which
/// boards do not decide together.
fn placebo() -> ModelBuf {
    let scene = scene("textures.toml", &[ALIKE, "duration_s=60.0", "seed=3"]);
    let mut streams = record::streams(&scene, Verbosity::Quiet).unwrap();
    for (n, stream) in streams.iter_mut().enumerate() {
        ["one", "other"][n % 2].clone_into(&mut stream.label);
    }
    let how = How::of(Tables::Joint).like(&scene);
    let trained = how.train(&[("placebo".to_owned(), streams)], scene.tick_hz);
    let model = trained.unwrap().model;
    model.without_opinion().unwrap_or(model)
}

/// The table of docs/head.md: means of five seeds with their standard errors.
#[test]
#[ignore = "a table: four minutes"]
fn table_of_deciding_together() {
    let mean = |of_seeds: &[Said], value: &dyn Fn(&Said) -> f64| {
        let all: Vec<f64> = of_seeds.iter().map(value).collect();
        let count = all.len() as f64;
        let mean = all.iter().sum::<f64>() / count;
        let square = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
        format!("{mean:.1} ± {:.1}", (square / (count - 1.0) / count).sqrt())
    };
    let share = |part: usize, of: usize| 100.0 * part as f64 / of as f64;
    let placebo = placebo();
    println!(
        "| whiskers | frames missed | decisions a second | named, % | of these right, % | samples \
         | untrained named, % | placebo named a second |\n|---|---|---|---|---|---|---|---|"
    );
    for boards in [2, 4, 12, 24] {
        for (has_bus, missed) in [(false, 0.0), (true, 0.0), (true, 0.5)] {
            let of = |name: &str| -> Vec<Said> {
                let of_seed = |seed| together(name, boards, has_bus, (missed, seed));
                (21..26).map(of_seed).collect()
            };
            let alike = |seed| {
                let of_it = ("textures.toml", placebo.clone(), &[ALIKE][..]);
                said(of_it, (boards, has_bus), (missed, seed))
            };
            let alike: Vec<Said> = (21..26).map(alike).collect();
            let (known, unknown) = (of("textures"), of("unknown"));
            let bus = if has_bus {
                format!("{:.0} %", 100.0 * missed)
            } else {
                "one board".to_owned()
            };
            println!(
                "| {boards} | {bus} | {} | {} | {} | {} | {} | {} |",
                // Forty seconds.
                mean(&known, &|said| said.decisions as f64 / 40.0),
                mean(&known, &|said| share(said.named, said.decisions)),
                mean(&known, &|said| share(said.right, said.named)),
                mean(&known, &|said| said.samples / said.decisions as f64),
                mean(&unknown, &|of| share(of.named_untrained, of.untrained)),
                mean(&alike, &|said| said.named as f64 / 40.0),
            );
        }
    }
}
