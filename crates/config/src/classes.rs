//! Priors and thresholds of classes, from the names and costs of a scene.

use scene::{ClassifierSection, Rule, Scene};
use tactile::{ClassList, ClassSetting, MOST_THRESHOLD, ModelBuf, Threshold, information};

use crate::Mismatch;

/// What a scene says of the classes of its model, in the model's order; empty: nothing.
///
/// # Errors
/// [`Mismatch::Classes`]: a class that the model does not have, shares of more or less than one,
/// costs for a model that names by its opinion.
pub fn classes(scene: &Scene, model: &ModelBuf) -> Result<ClassList, Mismatch> {
    classes_of(scene, &model.names().collect::<Vec<_>>(), Some(model))
}

/// The same of classes of these names; costs need the model itself.
///
/// # Errors
/// As [`classes`], and for costs without a model.
pub fn classes_of(
    scene: &Scene,
    names: &[&str],
    model: Option<&ModelBuf>,
) -> Result<ClassList, Mismatch> {
    let Some(classifier) = &scene.classifier else {
        return Ok(ClassList::new());
    };
    if !names_classes(classifier) {
        return Ok(ClassList::new());
    }
    let prior = named("prior", classifier.prior.as_deref(), names)?;
    let prior = shares(&prior)?;
    let thresholds = match classifier.rule {
        Rule::Costs { error, delay_per_s } => {
            let costs = [error, delay_per_s];
            of_costs(costs, model, scene.tick_hz)?
        }
        _ => named("thresholds", classifier.thresholds.as_deref(), names)?,
    };
    let most = prior.iter().copied().fold(0.0, f64::max);
    let settings = prior.iter().zip(thresholds);
    let settings = settings.map(|(share, threshold)| ClassSetting::new(share / most, threshold));
    Ok(settings.collect())
}

pub(crate) const fn names_classes(classifier: &ClassifierSection) -> bool {
    classifier.prior.is_some()
        || classifier.thresholds.is_some()
        || matches!(classifier.rule, Rule::Costs { .. })
}

fn refused(key: &'static str, found: String, allowed: String) -> Mismatch {
    Mismatch::Classes {
        key,
        found,
        allowed,
    }
}

/// The numbers of the model's classes, in its order.
fn named(
    key: &'static str,
    given: Option<&[(String, f64)]>,
    names: &[&str],
) -> Result<Vec<Option<f64>>, Mismatch> {
    let given = given.unwrap_or_default();
    if let Some((other, _)) = given
        .iter()
        .find(|(name, _)| !names.contains(&name.as_str()))
    {
        let allowed = format!("the model's classes, {}", names.join(", "));
        return Err(refused(key, format!("{other:?}"), allowed));
    }
    let number = |name: &&str| given.iter().find(|(given, _)| given == name);
    let numbers = names
        .iter()
        .map(|name| number(name).map(|(_, number)| *number));
    Ok(numbers.collect())
}

/// The share of each class; those without a number have an even part of what is left.
fn shares(given: &[Option<f64>]) -> Result<Vec<f64>, Mismatch> {
    /// Of the rounding of decimal shares.
    const LEAST: f64 = 1e-6;
    let others = given.iter().filter(|share| share.is_none()).count();
    let sum: f64 = given.iter().flatten().sum();
    let left = 1.0 - sum;
    let (is_good, allowed) = if others == 0 {
        (left.abs() < LEAST, "1, as every class is named")
    } else {
        let least = LEAST * others as f64;
        (
            left >= least,
            "at most 1 less 0.000001 for each other class",
        )
    };
    if !is_good {
        return Err(refused(
            "prior",
            format!("a sum of {sum}"),
            allowed.to_owned(),
        ));
    }
    let even = left / others.max(1) as f64;
    Ok(given.iter().map(|share| share.unwrap_or(even)).collect())
}

/// The threshold of each class that costs least on average, by an error and by a second of contact.
///
/// With log odds ℓ at the threshold, and evidence that grows by I nats a second in steps that are
/// small beside ℓ, a decision between two classes is wrong in 1/(1 + e^ℓ) of cases and takes
/// (ℓ/I) tanh(ℓ/2) (Wald, Sequential Analysis, 1947). Their cost, L/(1 + e^ℓ) +
/// c (ℓ/I) tanh(ℓ/2), is least where
///
/// 2 sinh ℓ + 2 ℓ = L I / c (Bogacz et al., Psychological Review 113, 2006, appendix),
///
/// whatever the priors (Wald and Wolfowitz 1948); for ℓ ≫ 1 the odds are L I / c. Of more classes I
/// is taken against the likest rival, right where the odds are large (Chernoff 1959). Thresholds
/// lie between ½ and 1 − 10⁻¹².
fn of_costs(
    [error, delay_per_s]: [f64; 2],
    model: Option<&ModelBuf>,
    tick_hz: u32,
) -> Result<Vec<Option<f64>>, Mismatch> {
    let refused = |allowed: &str| refused("cost_error", error.to_string(), allowed.to_owned());
    let Some(model) = model else {
        return Err(refused("where the file of the module's model is at hand"));
    };
    if model.names_between_poses() {
        let allowed = "a model with tables: one of several poses does not say how fast it learns";
        return Err(refused(allowed));
    }
    let blocks_per_s = f64::from(tick_hz) / f64::from(model.block());
    let of_rise = |rise: f64| {
        let odds = log_odds(error * rise * blocks_per_s / delay_per_s);
        Some(1.0 / (1.0 + (-odds).exp()))
    };
    Ok(information(model).into_iter().map(of_rise).collect())
}

/// ℓ of 2 sinh ℓ + 2 ℓ = `gain`, up to 28; its sinh is convex and rises, so it is bisected.
fn log_odds(gain: f64) -> f64 {
    crate::edge(28.0, |odds| 2.0 * odds.sinh() + 2.0 * odds < gain)
}

/// The threshold of no class, where costs give each its own: the largest of those.
pub(crate) fn largest(classes: &[ClassSetting]) -> Threshold {
    let units = classes.iter().map(|class| class.threshold).max();
    let units = units.unwrap_or(0).clamp(1, MOST_THRESHOLD);
    Threshold::of_units(units)
}

#[cfg(test)]
mod tests {
    use super::{log_odds, named, shares};

    #[test]
    fn shares_are_of_classes_and_make_one() {
        let found = shares(&[None, Some(0.7), None]).unwrap();
        let off = found
            .iter()
            .zip([0.15, 0.7, 0.15])
            .map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12);
        assert!(shares(&[Some(0.3), Some(0.7)]).is_ok());
        for bad in [
            &[Some(0.3), Some(0.6)][..],
            &[Some(0.5), Some(0.6)],
            &[Some(0.5), Some(0.5), None],
            &[Some(0.999_999_5), None],
        ] {
            let said = shares(bad).unwrap_err().to_string();
            let is_right = said.starts_with("classifier.prior: found a sum of ");
            assert!(is_right, "{said}");
        }
        let given = [("carpet".to_owned(), 0.5)];
        let said = named("prior", Some(&given), &["smooth", "p600"]).unwrap_err();
        let expected =
            "classifier.prior: found \"carpet\"; allowed: the model's classes, smooth, p600";
        assert_eq!(said.to_string(), expected);
    }

    /// By gambler's ruin (Feller, vol. 1, XIV.2 and 3) the cost of a boundary of n steps is exact,
    /// where a step moves the odds by 1.5 and I is 0.2 ln 1.5 a step: the derived threshold lies
    /// within a step of the cheapest, and costs at most 5 % more, though a step is a quarter of ℓ at
    /// the first.
    #[test]
    fn costs_come_to_the_cheapest_boundary() {
        let step = 1.5_f64.ln();
        for ratio in [30.0, 100.0, 1e3, 1e5] {
            let cost = |n: i32| {
                let wrong = 1.0 / (1.0 + 1.5_f64.powi(n));
                ratio * wrong + f64::from(n) / 0.2 * (1.0 - 2.0 * wrong)
            };
            let best = (1..60)
                .min_by(|a, b| cost(*a).total_cmp(&cost(*b)))
                .unwrap();
            let derived = (log_odds(ratio * 0.2 * step) / step).ceil() as i32;
            let is_cheap = cost(derived) <= 1.05 * cost(best);
            assert!(
                is_cheap && (derived - best).abs() <= 1,
                "{ratio}: {derived} {best}"
            );
        }
    }
}
