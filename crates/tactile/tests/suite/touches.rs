//! Models with joint tables, roughness, floors and a rule of touches, against sums
//! worked out by hand.

use crate::common::entry;
use tactile::{
    Axis, Floors, ModelBuf, ModelError, ModelParts, Quantiser, Sequential, TableParts, TableSource,
    Threshold, TouchRule,
};

const BLOCK: u32 = 2;
const LIMIT_BITS: u32 = 2;

/// Two bins an axis over codes 0 to 99.
const AXES: [Axis; 2] = [Axis::new(0, 2, [0, 100]), Axis::new(1, 2, [0, 100])];
/// Smooth below an S of 2⁴ − 1, rough from there on.
const ROUGH: [Axis; 1] = [Axis::new(0, 2, [0, 512])];

/// Two classes: both channels in the same half, or not; smooth, or rough.
fn model(floors: Option<&[Floors]>, touch: Option<TouchRule>) -> ModelBuf {
    let names = ["same".to_owned(), "other".to_owned()];
    let quantiser = Quantiser::of_codes(0, 100);
    let (often, rarely) = (entry(-1.0), entry(-3.0));
    let joint = [
        [often, rarely],
        [rarely, often],
        [rarely, often],
        [often, rarely],
    ]
    .concat();
    let rough = [entry(-1.0), entry(-2.0), entry(-2.0), entry(-1.0)];
    let tables = [
        TableParts {
            source: TableSource::Samples,
            axes: &AXES,
            entries: &joint,
        },
        TableParts {
            source: TableSource::Roughness,
            axes: &ROUGH,
            entries: &rough,
        },
    ];
    ModelBuf::new(&ModelParts {
        names: &names,
        block: BLOCK,
        channels: &[quantiser; 2],
        tables: &tables,
        floors,
        touch,
        opinion: &[],
    })
    .unwrap()
}

fn touch_rule() -> TouchRule {
    TouchRule {
        limit: LIMIT_BITS * 1024,
        gate: 0.05,
        gap: 200,
    }
}

fn classifier(model: ModelBuf, threshold: f64) -> Sequential<Box<[u32]>> {
    let mut classifier = Sequential::new(model, Threshold::new(threshold).unwrap()).unwrap();
    // The delay lines fill.
    for _ in 0..8 {
        classifier.pass(&[10, 10]).unwrap();
    }
    classifier
}

fn posterior(classifier: &Sequential<Box<[u32]>>, class: usize) -> f64 {
    classifier.posteriors().to_f64().nth(class).unwrap()
}

/// 2^bits : 1.
fn odds(bits: f64) -> f64 {
    1.0 / (1.0 + 2.0_f64.powf(-bits))
}

#[test]
fn content_survives() {
    let floors = [
        Floors {
            samples: 7,
            roughness: 8,
        },
        Floors {
            samples: 9,
            roughness: 10,
        },
    ];
    let model = model(Some(&floors), Some(touch_rule()));
    let read = ModelBuf::from_bytes(model.as_bytes()).unwrap();
    assert_eq!(read.touch_rule(), Some(touch_rule()));
    assert_eq!(
        [0, 1, 2].map(|class| read.floors(class)),
        [Some(floors[0]), Some(floors[1]), None]
    );
    assert_eq!(read.names().collect::<Vec<_>>(), ["same", "other"]);
    assert!(read.is_joint(), "it needs the code for all that");
}

/// The mean of two samples' 2 bit, and 1 bit of roughness, a block.
#[test]
fn a_block_weighs_the_mean_of_its_samples_and_its_roughness() {
    let mut c = classifier(model(None, None), 1.0 - 1e-9);
    for _ in 0..2 {
        assert_eq!(c.push(&[10, 10]), Ok(None));
    }
    assert!((posterior(&c, 0) - odds(2.0 + 1.0)).abs() < 1e-4);
    // One sample each way, and a step of 40 that is rough: −1 bit.
    c.push(&[50, 60]).unwrap();
    c.push(&[10, 90]).unwrap();
    assert!((posterior(&c, 0) - odds(3.0 - 1.0)).abs() < 1e-4);
}

#[test]
fn a_touch_limits_what_came_before_and_drops_the_open_block() {
    let mut c = classifier(model(None, Some(touch_rule())), 1.0 - 1e-9);
    for _ in 0..5 {
        c.push(&[10, 10]).unwrap();
    }
    assert!(
        posterior(&c, 0) > 0.98,
        "two blocks, and a sample of a third"
    );
    c.touch(1);
    assert!((posterior(&c, 0) - odds(f64::from(LIMIT_BITS))).abs() < 1e-4);
    // The sample before the touch would have ended the block with this one.
    c.push(&[10, 10]).unwrap();
    assert!((posterior(&c, 0) - odds(f64::from(LIMIT_BITS))).abs() < 1e-4);
    c.push(&[10, 10]).unwrap();
    assert!((posterior(&c, 0) - odds(5.0)).abs() < 1e-4);
}

#[test]
fn the_papers_models_know_no_touches() {
    let mut c = classifier(model(None, None), 1.0 - 1e-9);
    for _ in 0..4 {
        c.push(&[10, 10]).unwrap();
    }
    let before = posterior(&c, 0);
    c.touch(3);
    assert_eq!(posterior(&c, 0), before);
}

#[test]
fn a_decision_tells_its_touch_and_what_is_below_a_floor_is_unknown() {
    // Between the entries of likely and unlikely cells.
    let floor = |samples: f64, roughness: f64| Floors {
        samples: entry(samples),
        roughness: entry(roughness),
    };
    for (floors, known) in [
        (floor(-1.5, -1.5), true),
        (floor(-0.5, -1.5), false),
        (floor(-1.5, -0.5), false),
        (floor(-1.0, -1.0), true),
    ] {
        let mut c = classifier(model(Some(&[floors; 2]), Some(touch_rule())), 0.9);
        c.touch(41);
        for _ in 0..3 {
            assert_eq!(c.push(&[10, 10]), Ok(None));
        }
        let decision = c.push(&[10, 10]).unwrap().unwrap();
        assert_eq!((decision.leader(), decision.touch()), (0, 41));
        assert_eq!(decision.class(), known.then_some(0), "{floors:?}");
        assert_eq!(decision.samples(), 4);
        // Either way from the prior again.
        assert!((posterior(&c, 0) - 0.5).abs() < 1e-6);
    }
}

/// Blocks below a floor count against those above it until the next touch.
#[test]
fn floors_look_back_to_the_onset_of_the_touch() {
    let floors = [Floors {
        samples: entry(-1.4),
        roughness: 0,
    }; 2];
    let mut c = classifier(model(Some(&floors), Some(touch_rule())), 0.9);
    let decide = |c: &mut Sequential<Box<[u32]>>| {
        let mut decisions = (0..100).filter_map(|_| c.push(&[10, 10]).unwrap());
        decisions.next().unwrap().class()
    };
    c.touch(1);
    // −3 bit for the later leader; every other sample −1 bit.
    c.push(&[10, 90]).unwrap();
    // A mean of −1.5 over four samples, −1.25 over eight.
    assert_eq!([decide(&mut c), decide(&mut c)], [None, Some(0)]);
    c.touch(2);
    assert_eq!(decide(&mut c), Some(0));
}

#[test]
fn roughness_is_of_the_first_two_channels() {
    let quantiser = model(None, None).quantiser(0).unwrap();
    let refused = |channel| {
        let rough = [Axis {
            channel,
            ..ROUGH[0]
        }];
        let tables = [
            TableParts::of_channel(&AXES[0], &[1; 4]),
            TableParts {
                source: TableSource::Roughness,
                axes: &rough,
                entries: &[1; 4],
            },
        ];
        let parts = ModelParts {
            names: &["same".to_owned(), "other".to_owned()],
            block: BLOCK,
            channels: &[quantiser; 3],
            tables: &tables,
            ..ModelParts::default()
        };
        ModelBuf::new(&parts).err()
    };
    assert_eq!([1, 2].map(refused), [None, Some(ModelError::Axes)]);
}
