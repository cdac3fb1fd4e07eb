//! The variants against the product, the yardstick against an independent
//! program, and the order that the widths must have.

mod parts;

use std::sync::LazyLock;

use tactile::{SequentialEvidence, State};

use super::data::{CHANNELS, Recording, recordings};
use super::evidence::Sums;
use super::ground::{Ground, closed_loop};
use super::listeners::{Integers, Product, Yardstick};
use super::measure::{Errors, Row, Same, Study, columns};
use super::model::{Deficit, Entry, Exponential, Variant};

static RECORDINGS: LazyLock<[Recording; 2]> = LazyLock::new(|| recordings().unwrap());
static STUDY: LazyLock<Study> = LazyLock::new(|| Study::new(&RECORDINGS).unwrap());

fn with_entry(entry: Entry) -> &'static Row {
    let variant = Variant {
        entry,
        ..Variant::PRODUCT
    };
    STUDY.of(variant).unwrap()
}

fn with_exponential(exponential: Exponential) -> &'static Row {
    let variant = Variant {
        exponential,
        ..Variant::PRODUCT
    };
    STUDY.of(variant).unwrap()
}

fn with_deficit(deficit: Deficit) -> &'static Row {
    let variant = Variant {
        deficit,
        ..Variant::PRODUCT
    };
    STUDY.of(variant).unwrap()
}

#[test]
fn the_products_variant_has_the_products_table() {
    for recording in RECORDINGS.iter() {
        let model = recording.parsed().unwrap();
        let mut p = recording.likelihoods.iter();
        for bin in 0..model.bins() {
            for channel in 0..CHANNELS {
                for class in 0..recording.classes {
                    let found = Entry::Product.of(*p.next().unwrap());
                    let bits = model.log2_likelihood(channel, bin, class).unwrap();
                    assert_eq!(found, ((bits + 20.0) * 1024.0) as i64);
                }
            }
        }
        assert!(p.next().is_none());
    }
}

#[test]
fn the_products_variant_decides_as_the_product() {
    for recording in RECORDINGS.iter() {
        let model = recording.parsed().unwrap();
        let sums = Sums::new(recording, Entry::Product);
        for rule in columns().concat() {
            let mut product = Product::new(recording, &model, Some(rule)).unwrap();
            let mut variant = Integers::new(recording, &sums, Variant::PRODUCT, Some(rule));
            let expected = closed_loop(recording, &mut product);
            assert_eq!(closed_loop(recording, &mut variant), expected);
            assert!(expected.len() > 50, "{rule:?}: {}", expected.len());
        }
    }
}

#[test]
fn the_products_variant_errs_as_the_product() {
    let (product, variant) = (&STUDY.product.errors, &with_entry(Entry::Product).errors);
    // The variant rounds x to 2⁻²⁰ bit, 3.3e-7 of a term. The product tells
    // posteriors to 2⁻³², so to 2.3e-4 of 1e-6.
    let pairs = [
        (product.leader.largest, variant.leader.largest, 1e-6),
        (product.leader.mean(), variant.leader.mean(), 1e-6),
        (product.posterior.largest, variant.posterior.largest, 1e-6),
        (product.all.largest, variant.all.largest, 2.4e-4),
    ];
    for (product, variant, bound) in pairs {
        assert!((product - variant).abs() < bound, "{product} {variant}");
    }
    // In the open loop nobody decided, so nothing was left out.
    assert_eq!(product.leader.count(), variant.leader.count());
}

#[test]
fn the_product_keeps_its_bounds() {
    let product = &STUDY.product;
    // An entry is 2^-11 bit off at most. A block adds one of each channel to both
    // of two classes that are compared, so the largest error counts blocks, and
    // these brackets are of what the textures' recording gives: it is the module's
    // own, and another whenever a last bit of its tick is.
    let posterior = product.errors.posterior.largest;
    assert!((5e-3..=0.015).contains(&posterior), "{posterior}");
    let leader = product.errors.leader;
    assert!((1e-2..=0.03).contains(&leader.largest), "{leader:?}");
    assert!((2.5e-4..=7.5e-4).contains(&leader.mean()), "{leader:?}");
    // Nothing is further off than the evidence that decides: with p (1 − p) ≤ 1/4,
    // of both classes.
    assert!(posterior <= leader.largest / 2.0 + 1e-3, "{posterior}");
    let terrain = [product.restarted(0).share(), product.running(0).share()];
    assert!(terrain.iter().all(|share| *share >= 0.995), "{terrain:?}");
    // On the textures posteriors creep past the thresholds. See the report.
    let textures = [product.restarted(1).share(), product.running(1).share()];
    assert!((0.96..=0.985).contains(&textures[0]), "{textures:?}");
    assert!((0.8..=0.87).contains(&textures[1]), "{textures:?}");
    for (decisions, reference) in product.decisions.iter().zip(STUDY.reference) {
        for (decisions, rate) in decisions.iter().zip(reference) {
            assert!((decisions.hit_rate - rate).abs() <= 0.005);
        }
    }
}

#[test]
fn error_falls_with_the_width_of_the_entries() {
    let rows = [
        Entry::Full(8),
        Entry::Full(12),
        Entry::Product,
        Entry::Full(16),
    ]
    .map(with_entry);
    for pair in rows.windows(2) {
        let [wide, narrow] = [&pair[1].errors, &pair[0].errors];
        // Units are 17, 5 and 3.2 times as fine.
        assert!(wide.leader.mean() < 0.5 * narrow.leader.mean());
        assert!(wide.leader.largest < 0.7 * narrow.leader.largest);
        assert!(wide.all.mean() < 0.5 * narrow.all.mean());
        for recording in [0, 1] {
            let [wide, narrow] = [&pair[1], &pair[0]].map(|row| row.restarted(recording).share());
            assert!(wide >= narrow, "{wide} {narrow}");
        }
    }
    let eight = rows[0].restarted(1).share();
    assert!(eight < 0.8, "{eight}");
}

#[test]
fn deficits_of_64_bits_change_nothing_and_of_16_lose_the_far_ones() {
    let [narrow, product, wide] = Deficit::ALL.map(with_deficit);
    let (a, b) = (&product.errors, &wide.errors);
    assert_eq!(a.leader.largest.to_bits(), b.leader.largest.to_bits());
    assert_eq!(a.all.mean().to_bits(), b.all.mean().to_bits());
    assert!(narrow.errors.all.largest > 10.0 * a.all.largest);
    assert!(narrow.errors.leader.largest < 1.5 * a.leader.largest);
}

#[test]
fn exponentials_matter_only_once_they_are_coarser_than_the_table() {
    let [exact, lines128, lines16, micromath, shift] = Exponential::ALL.map(with_exponential);
    let leader = |row: &Row| row.errors.leader.mean();
    for row in [lines128, lines16, micromath] {
        let ratio = leader(row) / leader(exact);
        assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    }
    assert!(leader(shift) > 50.0 * leader(exact));
    assert!(shift.restarted(1).share() < 0.5);
}

#[test]
fn bytes_are_those_of_the_product() {
    let product = Variant::PRODUCT;
    let state = size_of::<State<SequentialEvidence<4>, 4>>();
    assert_eq!(product.state_bytes(20, 4), state);
    // The file without its header, quantisers, names and checksum.
    for (recording, names) in RECORDINGS.iter().zip([
        "-sandy_loam-asphalt-ice".len().next_multiple_of(4),
        "-smooth-p600-p240-carpet".len().next_multiple_of(4),
    ]) {
        let table = recording.model.as_bytes().len() - 16 - 2 * 20 - names - 4;
        let constants = product.constant_bytes(100, recording.classes);
        assert_eq!(constants - product.exponential.bytes(), table);
    }
    let twelve = Variant {
        entry: Entry::Full(12),
        exponential: Exponential::Exact,
        ..product
    };
    assert_eq!(twelve.constant_bytes(100, 3), 900);
}

#[test]
fn the_yardstick_gives_the_known_figures_and_agrees_with_itself() {
    let known = [0.799, 0.860, 0.871];
    for (found, known) in STUDY.reference[0].iter().zip(known) {
        assert!((found - known).abs() <= 0.0006, "{found} {known}");
    }
    let recording = &RECORDINGS[1];
    let ground = Ground::new(recording);
    let mut errors = Errors::default();
    ground.errors(&mut Yardstick::new(recording, None), &mut errors);
    assert_eq!(errors.all.largest, 0.0);
    assert!(errors.leader.count() > 3000);
    let decisions = ground.decisions(|rule| Ok(Yardstick::new(recording, Some(rule))));
    for decisions in decisions.unwrap() {
        let Same { same, of } = decisions.running;
        assert!(same == of && of > 50);
        assert_eq!(decisions.restarted, decisions.running);
    }
}

#[test]
fn the_section_is_whole_and_the_same_again() {
    let make = || {
        let mut text = String::new();
        let files = super::section(&mut text).unwrap();
        (text, files)
    };
    let (text, files) = make();
    assert_eq!(make(), (text.clone(), files.clone()));
    let [(name, svg)] = &files[..] else {
        panic!("one picture");
    };
    assert!(text.contains(&format!("]({name})")) && svg.starts_with("<svg"));
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    let product = text
        .lines()
        .filter(|line| line.starts_with("| **16 (1024)**"));
    assert_eq!(product.count(), 3);
    let twelve = text.lines().filter(|line| line.starts_with("| 12 (204)"));
    assert_eq!(twelve.count(), 3);
}
