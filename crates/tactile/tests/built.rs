//! A program refuses what it was built without, and decides by all else.

use tactile::{
    Axis, Deciding, Decision, JOINT, ModelBuf, ModelParts, Quantiser, RuleSettings, SetupError,
    StreamClassifier, TableParts, TableSource, Threshold, TouchRule,
};

/// Two classes that differ by two bits a sample.
fn model(touch: Option<TouchRule>) -> ModelBuf {
    let axis = [Axis {
        channel: 0,
        bins: 1,
        low: 0,
        high: 0,
    }];
    let quantiser = Quantiser {
        origin: 0.0,
        exponent: 0,
        low: 0,
        high: 0,
    };
    ModelBuf::new(&ModelParts {
        names: &["a", "b"].map(str::to_owned),
        block: 1,
        channels: &[quantiser],
        tables: &[TableParts {
            source: TableSource::Samples,
            axes: &axis,
            entries: &[18_000, 18_000 + 2 * 1024],
        }],
        floors: None,
        touch,
        opinion: &[],
    })
    .unwrap()
}

/// The samples of the first decision, of two whiskers by turns.
fn decided(
    model: ModelBuf,
    rule: RuleSettings,
    deciding: Deciding,
) -> Result<Option<u32>, SetupError> {
    let mut classifier = StreamClassifier::new(model, rule, deciding, 2)?;
    let decision = (0..20).find_map(|n| classifier.push_to(n % 2, &[0]).unwrap());
    Ok(decision.as_ref().map(Decision::samples))
}

#[test]
fn what_is_left_out_is_refused_and_all_else_decides() {
    let touch = TouchRule {
        limit: 1024,
        gate: 0.05,
        gap: 200,
    };
    // More than 98 %: three samples of two bits.
    let threshold = RuleSettings::Sequential(Threshold::new(0.98).unwrap());
    for (rule, rule_name, has_rule, samples) in [
        (
            threshold,
            "sequential rule",
            cfg!(feature = "sequential"),
            3,
        ),
        (
            RuleSettings::Window(4),
            "window rule",
            cfg!(feature = "window"),
            4,
        ),
    ] {
        for deciding in [Deciding::First, Deciding::Each] {
            let is_built = deciding == Deciding::First || cfg!(feature = "several");
            for touch in [None, Some(touch)] {
                let expected = if !is_built {
                    Err(SetupError::NotBuilt("several whiskers"))
                } else if touch.is_some() && !JOINT {
                    Err(SetupError::NotBuilt("joint models"))
                } else if !has_rule {
                    Err(SetupError::NotBuilt(rule_name))
                } else {
                    Ok(Some(samples))
                };
                let found = decided(model(touch), rule, deciding);
                assert_eq!(found, expected, "{rule:?} {deciding:?} {touch:?}");
            }
        }
    }
}
