//! Models with joint tables, roughness, floors and a rule of touches, against sums
//! worked out by hand.

use crate::common::{TOUCHES, entry, of_two, threshold};
use tactile::{
    Axis, Floors, ModelBuf, ModelError, ModelParts, Quantiser, Sequential, TableParts, TableSource,
    TouchRule,
};

const BLOCK: u32 = 2;
/// Of a touch, as [`TOUCHES`] has it.
const LIMIT: f64 = 2.0;

/// Two bins an axis over codes 0 to 99.
const AXES: [Axis; 2] = [Axis::new(0, 2, [0, 100]), Axis::new(1, 2, [0, 100])];
/// Smooth below an S of 2⁴ − 1, rough from there on.
const ROUGH: Axis = Axis::new(0, 2, [0, 512]);

fn rough<'a>(axis: &'a [Axis; 1], entries: &'a [u16]) -> TableParts<'a> {
    TableParts {
        source: TableSource::Roughness,
        axes: axis,
        entries,
    }
}

/// Two classes: both channels in the same half, or not; smooth, or rough.
fn model(floors: Option<&[Floors]>, touch: Option<TouchRule>) -> ModelBuf {
    let (often, rarely) = (entry(-1.0), entry(-3.0));
    let (alike, unlike) = ([often, rarely], [rarely, often]);
    let both = TableParts {
        source: TableSource::Samples,
        axes: &AXES,
        entries: &[alike, unlike, unlike, alike].concat(),
    };
    let of_roughness = [-1.0, -2.0, -2.0, -1.0].map(entry);
    let rest = ModelParts {
        block: BLOCK,
        tables: &[both, rough(&[ROUGH], &of_roughness)],
        floors,
        touch,
        ..ModelParts::default()
    };
    of_two(&["same", "other"], rest)
}

fn classifier(model: ModelBuf, theta: f64) -> Sequential<Box<[u32]>> {
    let mut classifier = Sequential::new(model, threshold(theta)).unwrap();
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
    let floors = [(7, 8), (9, 10)].map(|(samples, roughness)| Floors { samples, roughness });
    let model = model(Some(&floors), Some(TOUCHES));
    let read = ModelBuf::from_bytes(model.as_bytes()).unwrap();
    assert_eq!(read.touch_rule(), Some(TOUCHES));
    let expected = [Some(floors[0]), Some(floors[1]), None];
    assert_eq!([0, 1, 2].map(|class| read.floors(class)), expected);
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
    let mut c = classifier(model(None, Some(TOUCHES)), 1.0 - 1e-9);
    for _ in 0..5 {
        c.push(&[10, 10]).unwrap();
    }
    assert!(
        posterior(&c, 0) > 0.98,
        "two blocks, and a sample of a third"
    );
    let mut papers = classifier(model(None, None), 1.0 - 1e-9);
    for _ in 0..4 {
        papers.push(&[10, 10]).unwrap();
    }
    let before = papers.posteriors();
    papers.touch(1);
    assert_eq!(papers.posteriors(), before, "it knows no touches");
    c.touch(1);
    assert!((posterior(&c, 0) - odds(LIMIT)).abs() < 1e-4);
    // The sample before the touch would have ended the block with this one.
    c.push(&[10, 10]).unwrap();
    assert!((posterior(&c, 0) - odds(LIMIT)).abs() < 1e-4);
    c.push(&[10, 10]).unwrap();
    assert!((posterior(&c, 0) - odds(5.0)).abs() < 1e-4);
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
        let mut c = classifier(model(Some(&[floors; 2]), Some(TOUCHES)), 0.9);
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
    let mut c = classifier(model(Some(&floors), Some(TOUCHES)), 0.9);
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
    let refused = |channel| {
        let axis = [Axis { channel, ..ROUGH }];
        let of_samples = TableParts::of_channel(&AXES[0], &[1; 4]);
        let parts = ModelParts {
            names: &["same".to_owned(), "other".to_owned()],
            block: BLOCK,
            channels: &[Quantiser::of_codes(0, 100); 3],
            tables: &[of_samples, rough(&axis, &[1; 4])],
            ..ModelParts::default()
        };
        ModelBuf::new(&parts).err()
    };
    assert_eq!([1, 2].map(refused), [None, Some(ModelError::Axes)]);
}
