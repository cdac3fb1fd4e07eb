use tactile::{
    CRC_BYTES, Deciding, MAX_CHANNELS, Model, ModelBuf, RuleSettings, StreamClassifier, Threshold,
    checksum,
};

/// Samples that a model which is taken classifies at most.
const SAMPLES: usize = 2_000;

/// The reader of model files, and a classifier with what it takes; as the bytes are, and
/// with the sum that belongs to them, without which nearly none would be looked at.
///
/// # Panics
/// If a model that is taken is not made of these bytes, or names what it has not.
pub fn model(data: &[u8]) {
    read(data);
    if let Some(place) = data.len().checked_sub(CRC_BYTES) {
        let content = &data[..place];
        read(&[content, &checksum(content).to_le_bytes()].concat());
    }
}

fn read(bytes: &[u8]) {
    let model = match ModelBuf::from_bytes(bytes) {
        Ok(model) => model,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    assert_eq!(model.as_bytes(), bytes);
    let view = model.view();
    let classes = view.names().count();
    let channels = (0..MAX_CHANNELS)
        .take_while(|n| view.quantiser(*n).is_some())
        .count();
    for class in 0..=classes {
        assert_eq!(view.name(class).is_some(), class < classes);
        let _ = view.floors(class);
    }
    for channel in 0..=channels {
        for bin in 0..view.bins(channel).unwrap_or(0) {
            let _ = view.log2_likelihood(channel, bin, classes - 1);
        }
    }
    let threshold = Threshold::new(0.99).map(RuleSettings::Sequential);
    let rules = threshold.into_iter().chain([RuleSettings::Window(100)]);
    for rule in rules {
        for deciding in [Deciding::First, Deciding::Each, Deciding::Together] {
            classify(model.view(), (rule, deciding), channels, bytes);
        }
    }
}

const WHISKERS: usize = 2;

/// Classifies codes taken from the bytes themselves, with touches and pauses among them.
fn classify(
    model: Model<&[u32]>,
    (rule, deciding): (RuleSettings, Deciding),
    channels: usize,
    bytes: &[u8],
) {
    let Ok(mut classifier) = StreamClassifier::new(model, rule, deciding, WHISKERS) else {
        return;
    };
    let bytes = bytes.iter().rev().cycle();
    let mut bytes = bytes.copied();
    let mut codes = vec![0; channels];
    for number in 0..SAMPLES {
        let whisker = number % classifier.streams();
        for code in &mut codes {
            let word = [(); 4].map(|()| bytes.next().unwrap_or(0));
            let wide = i32::from_le_bytes(word);
            *code = if number % 8 == 0 { wide } else { wide >> 18 };
        }
        if number % 256 < WHISKERS {
            classifier.begin_touch(whisker, (number / 256) as u16);
        }
        let done = match number % 100 {
            90.. => classifier.pass_to(whisker, &codes),
            _ => classifier.push_to(whisker, &codes).map(drop),
        };
        assert!(done.is_ok());
    }
    for whisker in 0..classifier.streams() {
        let sum: f64 = classifier.posteriors(whisker).to_f64().sum();
        assert!((sum - 1.0).abs() < 1e-3, "posteriors sum to {sum}");
    }
    classifier.restart();
}
