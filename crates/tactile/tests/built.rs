//! A program refuses what it was built without, and decides by all else.

use tactile::{
    Axis, Deciding, Decision, JOINT, ModelBuf, ModelParts, OPINION, Quantiser, RuleSettings,
    SetupError, StreamClassifier, TableParts, TableSource, Threshold, TouchRule,
};

/// Words of an opinion of two classes that has nothing against any name: it objects (0), of one
/// pose, with one stage, and says so after one block.
const AGREES: [u32; 347] = {
    let mut words = [0; 347];
    words[0] = u32::from_le_bytes([0, 1, 1, 1]);
    words[1] = u32::MAX;
    words
};

/// Two classes that differ by two bits a sample.
fn model(touch: Option<TouchRule>, opinion: &[u32]) -> ModelBuf {
    let axis = [Axis::new(0, 1, [0, 0])];
    let quantiser = Quantiser::of_codes(0, 0);
    ModelBuf::new(&ModelParts {
        names: &["a", "b"].map(str::to_owned),
        block: 1,
        channels: &[quantiser; 2],
        tables: &[TableParts {
            source: TableSource::Samples,
            axes: &axis,
            entries: &[18_000, 18_000 + 2 * 1024],
        }],
        floors: None,
        touch,
        opinion,
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
    let decision = (0..20).find_map(|n| classifier.push_to(n % 2, &[0, 0]).unwrap());
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
    let has_rule = [cfg!(feature = "sequential"), cfg!(feature = "window")];
    for (rule, rule_name, has_rule, samples) in [
        (threshold, "sequential rule", has_rule[0], 3),
        (RuleSettings::Window(4), "window rule", has_rule[1], 4),
    ] {
        for deciding in [Deciding::First, Deciding::Each] {
            let is_built = deciding == Deciding::First || cfg!(feature = "several");
            let objects = (Some(touch), AGREES.as_slice());
            for (touch, opinion) in [(None, [].as_slice()), (Some(touch), &[]), objects] {
                let expected = if !is_built {
                    Err(SetupError::NotBuilt("several whiskers"))
                } else if touch.is_some() && !JOINT {
                    Err(SetupError::NotBuilt("joint models"))
                } else if !opinion.is_empty() && !OPINION {
                    Err(SetupError::NotBuilt("models that object"))
                } else if !has_rule {
                    Err(SetupError::NotBuilt(rule_name))
                } else {
                    Ok(Some(samples))
                };
                let found = decided(model(touch, opinion), rule, deciding);
                let objects = !opinion.is_empty();
                assert_eq!(found, expected, "{rule:?} {deciding:?} {touch:?} {objects}");
            }
        }
    }
}
