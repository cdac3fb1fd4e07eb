//! A robot's vibration over three grounds: the fixed-point classifier gives the
//! figures of an independent program, and agrees with double precision stream
//! by stream.

use tactile::reference::{Reference, ReferenceDecision, ReferenceRule};
use tactile::train::{Options, Trainer};
use tactile::{
    Decision, DecisionRule, ModelBuf, NaiveBayes, SequentialRule, Threshold, WindowRule,
};

type Row = (String, String, [f64; 2]);

fn rows(file: &str) -> Vec<Row> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/terrain/");
    let text = std::fs::read_to_string(format!("{folder}{file}")).unwrap();
    text.lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |i: usize| fields[i].parse().unwrap();
            (fields[0].into(), fields[1].into(), [number(2), number(3)])
        })
        .collect()
}

struct Terrain {
    trainer: Trainer,
    model: ModelBuf,
    test: Vec<Row>,
}

fn terrain() -> Terrain {
    let mut trainer = Trainer::new(2, Options::default()).unwrap();
    for (label, _, sample) in rows("terrain-train.csv") {
        trainer.add(&label, &sample).unwrap();
    }
    let model = trainer.train().unwrap();
    let test = rows("terrain-test.csv");
    Terrain {
        trainer,
        model,
        test,
    }
}

/// A decision of the fixed-point classifier and one of the reference after
/// the same sample, each where there is one, with the true class.
type Pair = (usize, Option<Decision>, Option<ReferenceDecision>);

fn classify<R: DecisionRule>(
    terrain: &Terrain,
    settings: R::Settings,
    rule: ReferenceRule,
) -> Vec<Pair> {
    let model = terrain.model.view();
    let mut fixed = NaiveBayes::<R, _>::new(model, settings).unwrap();
    let reference = Reference::train(&terrain.trainer).unwrap();
    let mut exact = reference.stream(rule);
    let quantisers = [0, 1].map(|c| model.quantiser(c).unwrap());
    let mut pairs = Vec::new();
    let mut stream = None;
    for (label, trial, sample) in &terrain.test {
        if stream != Some((label, trial)) {
            assert!(fixed.finish().is_none());
            exact.finish();
            stream = Some((label, trial));
        }
        let codes = [0, 1].map(|c| quantisers[c].code_from_f64(sample[c]));
        let pair = (fixed.push(&codes).unwrap(), exact.push(sample));
        if pair != (None, None) {
            let class = model.names().position(|n| n == label).unwrap();
            pairs.push((class, pair.0, pair.1));
        }
    }
    pairs
}

/// Mean over classes of the hit rate in percent, mean samples, decisions.
fn score(pairs: &[Pair]) -> (f64, f64, usize) {
    let mut hits = [0.0; 3];
    let mut all = [0.0; 3];
    let mut samples = 0.0;
    for (class, decision, _) in pairs {
        if let Some(d) = decision {
            all[*class] += 1.0;
            hits[*class] += f64::from(d.class() == *class);
            samples += f64::from(d.samples());
        }
    }
    let count: f64 = all.iter().sum();
    let rates = hits.iter().zip(all).map(|(h, a)| h / a);
    (
        rates.sum::<f64>() / 3.0 * 100.0,
        samples / count,
        count as usize,
    )
}

/// The share of decisions that fall after the same sample, for the same class;
/// and the largest difference of the posterior among them.
fn agreement(pairs: &[Pair]) -> (f64, f64) {
    let mut same = 0.0;
    let mut worst = 0.0_f64;
    for (_, fixed, exact) in pairs {
        if let (Some(f), Some(e)) = (fixed, exact)
            && f.class() == e.class
            && u64::from(f.samples()) == e.samples
        {
            same += 1.0;
            worst = worst.max((f.posterior().to_f64() - e.posterior).abs());
        }
    }
    (same / pairs.len() as f64, worst)
}

#[test]
fn sequential_rule_gives_the_known_figures() {
    let terrain = terrain();
    let known = [
        (0.9, 79.9, 116.0, 488),
        (0.99, 86.0, 205.0, 245),
        (0.999, 87.1, 253.0, 185),
    ];
    for (theta, rate, samples, decisions) in known {
        let threshold = Threshold::new(theta).unwrap();
        let exact = ReferenceRule::Sequential(theta);
        let pairs = classify::<SequentialRule>(&terrain, threshold, exact);
        let found = score(&pairs);
        let (same, worst) = agreement(&pairs);
        println!("{theta}: {found:?}, same {same}, posterior within {worst:e}");
        assert!(
            (found.0 - rate).abs() <= 0.06,
            "{theta}: hit rate {}",
            found.0
        );
        assert!(
            (found.1 - samples).abs() <= 1.0,
            "{theta}: samples {}",
            found.1
        );
        assert_eq!(found.2, decisions, "{theta}");
        assert!(same >= 0.995, "{theta}: {same}");
        assert!(worst <= 0.003, "{theta}: {worst}");
        for (_, fixed, _) in &pairs {
            assert!(fixed.is_none_or(|d| d.posterior().to_f64() > theta));
        }
    }
}

#[test]
fn window_rule_gives_the_known_figures() {
    let terrain = terrain();
    for (window, rate) in [(120, 59.3), (200, 59.6), (260, 60.6)] {
        let exact = ReferenceRule::Window(u64::from(window));
        let pairs = classify::<WindowRule>(&terrain, window, exact);
        let found = score(&pairs);
        let (same, worst) = agreement(&pairs);
        println!("{window}: {found:?}, same {same}, posterior within {worst:e}");
        assert!((found.0 - rate).abs() <= 0.06, "{window}: {}", found.0);
        assert!((found.1 - f64::from(window)).abs() < 1e-9);
        assert!(same >= 0.995, "{window}: {same}");
        assert!(worst <= 0.002, "{window}: {worst}");
    }
}
