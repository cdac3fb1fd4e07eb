//! Keys, their values, and every combination of these.

use std::collections::HashSet;
use std::str::FromStr;

use scene::Override;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Axis {
    pub(super) key: String,
    pub(super) values: Vec<String>,
}

impl FromStr for Axis {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let allowed = || "allowed: KEY=VALUE,VALUE,..., such as plant.stiffness=0.1,0.2".to_owned();
        let (key, values) = text.split_once('=').ok_or_else(allowed)?;
        let values = split(values);
        if key.trim().is_empty() || values.iter().any(String::is_empty) {
            return Err(allowed());
        }
        // Be it written as another number.
        let number = |value: &String| value.parse::<f64>().map(|number| number.to_string());
        let mut seen = HashSet::new();
        let mut all = values.iter();
        if let Some(twice) = all.find(|one| !seen.insert(number(one).unwrap_or((*one).clone()))) {
            return Err(format!("{twice} is there twice, allowed: once"));
        }
        let key = key.trim().to_owned();
        Ok(Self { key, values })
    }
}

/// The values between commas; those within brackets, braces and quotes are no ends.
fn split(text: &str) -> Vec<String> {
    let mut values = vec![String::new()];
    let (mut depth, mut quote) = (0_i32, None);
    for c in text.chars() {
        match (c, quote) {
            (_, Some(q)) if c == q => quote = None,
            ('"' | '\'', None) => quote = Some(c),
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth -= 1,
            (',', None) if depth == 0 => {
                values.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(value) = values.last_mut() {
            value.push(c);
        }
    }
    values.iter().map(|value| value.trim().to_owned()).collect()
}

/// Every combination, the last key changing first.
pub(super) fn combinations(axes: &[Axis]) -> Vec<Vec<Override>> {
    let mut combinations = vec![Vec::new()];
    for Axis { key, values } in axes {
        let longer = combinations.iter().flat_map(|combination: &Vec<Override>| {
            values.iter().map(|value| {
                let source = format!("--key {key}={value}");
                let one = Override::new(source, key, value);
                [combination.as_slice(), &[one]].concat()
            })
        });
        combinations = longer.collect();
    }
    combinations
}

#[cfg(test)]
mod tests {
    use super::{Axis, combinations};

    #[test]
    fn values_end_at_commas_that_are_not_within_something() {
        let axis = |text: &str| text.parse::<Axis>();
        let values = |text: &str| axis(text).unwrap().values;
        assert_eq!(axis(" rcp.gain = 0, 0.5,1 ").unwrap().key, "rcp.gain");
        assert_eq!(values("rcp.gain = 0, 0.5,1 "), ["0", "0.5", "1"]);
        assert_eq!(values("a=[80, 90],[1, 2]"), ["[80, 90]", "[1, 2]"]);
        assert_eq!(values("a='x,y',\"[\",z"), ["'x,y'", "\"[\"", "z"]);
        for wrong in ["", "a", "a=", "=1", "a=1,,2", "a=1,", "a=1,2,1.0"] {
            assert!(axis(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_combination_comes_once_and_the_last_key_changes_first() {
        let axes = ["a=1,2", "b=x,y,z"].map(|text| text.parse().unwrap());
        let all = combinations(&axes);
        let texts = |n: usize| all[n].iter().map(ToString::to_string).collect::<Vec<_>>();
        assert_eq!(all.len(), 6);
        assert_eq!(texts(0), ["a=1", "b=x"]);
        assert_eq!(texts(1), ["a=1", "b=y"]);
        assert_eq!(texts(5), ["a=2", "b=z"]);
        assert_eq!(combinations(&[]), [[]]);
    }
}
