//! What a program may want to know of a key before it has a scene.

use crate::kind::{Kind, Range};
use crate::sections::sections;

/// A key as it is declared.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyFacts {
    /// Type and range in words.
    pub allowed: String,
    /// Unit of its numbers; empty where there is none.
    pub unit: &'static str,
    /// The ends of its range, of a number.
    pub ends: Option<[f64; 2]>,
    /// What it means.
    pub meaning: &'static str,
}

/// The key of this path, such as `motor.kp`; none if there is none.
pub fn key_facts(path: &str) -> Option<KeyFacts> {
    let (section, name) = path.split_once('.').unwrap_or(("", path));
    let section = sections().find(|known| known.name == section)?;
    let key = section.key(name)?;
    let ends = match key.kind {
        Kind::Number(Range { low, high, .. }) => Some([low, high]),
        _ => None,
    };
    Some(KeyFacts {
        allowed: key.kind.to_string(),
        unit: key.unit,
        ends,
        meaning: key.meaning,
    })
}

#[cfg(test)]
mod tests {
    use super::key_facts;

    #[test]
    fn a_key_is_known_by_its_path() {
        let kp = key_facts("motor.kp").unwrap();
        assert_eq!(kp.ends, Some([0.0, 10.0]));
        assert_eq!(kp.unit, "duty per degree");
        assert_eq!(key_facts("tick_hz").unwrap().ends, None);
        for unknown in ["kp", "motor", "motor.", "moto.kp", ""] {
            assert_eq!(key_facts(unknown), None, "{unknown}");
        }
    }
}
