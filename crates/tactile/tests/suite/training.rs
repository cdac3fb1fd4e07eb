//! Training against probabilities worked out by hand, and what it refuses.

use tactile::train::{Options, TrainError, Trainer};
use tactile::{ModelBuf, ModelError, Window};

fn trained(options: Options, samples: &[(&str, f64)]) -> Result<ModelBuf, TrainError> {
    let mut trainer = Trainer::new(1, options)?;
    for (label, x) in samples {
        trainer.add(label, &[*x])?;
    }
    trainer.train()
}

fn options(bins: usize, smooth: f64) -> Options {
    Options {
        bins,
        smooth,
        block: 1,
    }
}

/// Half a table step, in bits.
const ROUNDING: f32 = 1.0 / 2048.0;

#[test]
fn an_unsmoothed_histogram_is_counts_over_their_sum() {
    // Range 0 to 40 in four bins; 40 belongs to the last, 10 to the second.
    let data = [
        ("a", 0.0),
        ("b", 40.0),
        ("a", 10.0),
        ("a", 9.0),
        ("b", 30.0),
        ("a", 29.0),
    ];
    let buf = trained(options(4, 0.0), &data).unwrap();
    let model = buf.view();
    assert_eq!(model.names().collect::<Vec<_>>(), ["a", "b"]);
    let p = [[0.5, 0.25, 0.25, 0.0], [0.0, 0.0, 0.0, 1.0]];
    for (class, p) in p.iter().enumerate() {
        for (bin, p) in p.iter().enumerate() {
            let exact = (p + 1e-6_f64).log2() as f32;
            let found = model.log2_likelihood(0, bin, class).unwrap();
            assert!((found - exact).abs() <= ROUNDING, "{class} {bin}");
        }
    }
}

#[test]
fn smoothing_is_a_gaussian_cut_at_four_and_zero_outside() {
    // All of class a in bin 3 of 40; b spans the range.
    let mut data = vec![("a", 3.5); 7];
    data.extend([("b", 0.0), ("b", 40.0)]);
    let sd = 1.5;
    let buf = trained(options(40, sd), &data).unwrap();
    let model = buf.view();
    let weight = |bin: i32| {
        let d = f64::from(bin - 3);
        if d.abs() <= 4.0 * sd {
            (-d * d / (2.0 * sd * sd)).exp()
        } else {
            0.0
        }
    };
    // What would fall below bin 0 is lost before the normalisation.
    let sum: f64 = (0..40).map(weight).sum();
    for bin in 0..40 {
        let exact = (weight(bin) / sum + 1e-6).log2() as f32;
        let found = model.log2_likelihood(0, bin as usize, 0).unwrap();
        let error = (found - exact).abs();
        assert!(error <= ROUNDING * 1.01, "{bin}: {found} {exact}");
    }
    // The cut: six bins off has weight, seven the floor alone.
    let [last, beyond] = [9, 10].map(|bin| model.log2_likelihood(0, bin, 0).unwrap());
    assert!(last > -15.0 && (beyond + 19.93).abs() < 0.01);
}

#[test]
fn integers_keep_their_codes_and_reals_are_scaled() {
    let q = |samples: &[(&str, f64)], bins| {
        let buf = trained(options(bins, 0.0), samples).unwrap();
        buf.view().quantiser(0).unwrap()
    };
    let codes = q(&[("a", -8192.0), ("b", 8191.0)], 100);
    assert_eq!((codes.low, codes.high, codes.exponent), (-8192, 8191, 0));
    assert!(codes.takes_raw());
    // Fewer codes than bins: the smallest shift that gives over two a bin.
    let few = q(&[("a", 0.0), ("b", 10.0)], 100);
    assert_eq!((few.low, few.high, few.exponent), (0, 320, 5));
    assert!(few.takes_raw() && few.code_from_f64(3.0) == 3 << 5);
    for (low, high) in [
        (0.1, 0.7),
        (-3e-9, 2e-9),
        (1e9 + 0.5, 1e9 + 1.5),
        (-1e200, 1e200),
        (0.0, 1e-250),
        (0.5, 1.0),
    ] {
        let real = q(&[("a", low), ("b", high)], 100);
        let is_fine = real.high > 1 << 18 && real.high <= 1 << 19;
        assert!(is_fine && real.low == 0, "{low} {high}: {}", real.high);
        assert_eq!(real.code_from_f64(low), 0);
        assert_eq!(real.code_from_f64(high), real.high);
    }
}

#[test]
fn a_channel_that_never_changes_is_allowed_and_says_nothing() {
    let mut trainer = Trainer::new(2, options(10, 2.0)).unwrap();
    for i in 0..20 {
        trainer.add("a", &[f64::from(i), 0.3]).unwrap();
        trainer.add("b", &[f64::from(i) + 10.0, 0.3]).unwrap();
    }
    let buf = trainer.train().unwrap();
    let model = buf.view();
    for bin in 0..10 {
        let [a, b] = [0, 1].map(|class| model.log2_likelihood(1, bin, class));
        assert_eq!(a, b);
    }
    let mut c = Window::new(model, 1).unwrap();
    for (x, class) in [(0.0, 0), (29.0, 1)] {
        let code = model.quantiser(0).unwrap().code_from_f64(x);
        assert_eq!(c.push(&[code, 123_456]).unwrap().unwrap().leader(), class);
    }
}

#[test]
fn bad_input_is_refused() {
    let refused = |samples: &[(&str, f64)]| trained(options(10, 1.0), samples).unwrap_err();
    assert_eq!(refused(&[]), TrainError::NoSamples);
    assert_eq!(refused(&[("a", 1.0)]), TrainError::OneClass);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let channel = 0;
        assert_eq!(refused(&[("a", bad)]), TrainError::NotFinite { channel });
    }
    assert_eq!(refused(&[("", 1.0)]), TrainError::NameEmpty);
    let bytes = 256;
    let long = "n".repeat(bytes);
    assert_eq!(refused(&[(&long, 1.0)]), TrainError::NameTooLong { bytes });
    let names: Vec<String> = (0..33).map(|i| i.to_string()).collect();
    let many: Vec<(&str, f64)> = names.iter().map(|n| (n.as_str(), 1.5)).collect();
    assert!(trained(options(10, 1.0), &many[..32]).is_ok());
    assert_eq!(refused(&many), TrainError::TooManyClasses);
    for range in [[("a", -1e300), ("b", 1e300)], [("a", 0.0), ("b", 1e-300)]] {
        assert_eq!(refused(&range), TrainError::Range { channel: 0 });
    }
    let mut trainer = Trainer::new(2, Options::default()).unwrap();
    let error = trainer.add("a", &[1.0]).unwrap_err();
    let (expected, found) = (2, 1);
    assert_eq!(error, TrainError::Channels { expected, found });
    assert!(trainer.names().is_empty());
}

#[test]
fn option_ranges_are_checked() {
    let refused = |channels, bins, smooth, block| {
        let options = Options {
            bins,
            smooth,
            block,
        };
        Trainer::new(channels, options).err()
    };
    assert_eq!(refused(2, 4096, 4096.0, 10_000), None);
    for (channels, bins, block, error) in [
        (2, 0, 20, ModelError::Bins(0)),
        (2, 4097, 20, ModelError::Bins(4097)),
        (2, 100, 0, ModelError::Block(0)),
        (2, 100, 10_001, ModelError::Block(10_001)),
        (25, 100, 20, ModelError::Channels(25)),
        (7, 100, 10_000, ModelError::BlockTimesChannels(70_000)),
    ] {
        let error = Some(TrainError::Model(error));
        assert_eq!(refused(channels, bins, 5.0, block), error);
    }
    assert_eq!(refused(2, 100, -1.0, 20), Some(TrainError::Smooth(-1.0)));
    assert!(refused(2, 100, f64::NAN, 20).is_some());
}
