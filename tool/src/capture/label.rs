//! What is captured, by name.

use std::str::FromStr;

/// A class, and the sample that is laid before the whisker for it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Label {
    pub(crate) name: String,
    /// The sample; of the same name, unless said otherwise.
    pub(crate) sample: String,
}

impl FromStr for Label {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, sample) = text.split_once('=').unwrap_or((text, text));
        let (name, sample) = (name.trim(), sample.trim());
        // `unknown` is what a decision for none of the classes says.
        let is_name = |name: &str| !name.is_empty() && !name.contains(char::is_control);
        if is_name(name) && is_name(sample) && name != host_sim::decisions::UNKNOWN {
            let [name, sample] = [name, sample].map(str::to_owned);
            return Ok(Self { name, sample });
        }
        Err("allowed: a name but \"unknown\", or LABEL=SAMPLE".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::Label;

    #[test]
    fn a_label_names_its_sample_or_is_its_name() {
        let parts = |text: &str| {
            let label: Label = text.parse().ok()?;
            Some((label.name, label.sample))
        };
        let both = |a: &str, b: &str| Some((a.to_owned(), b.to_owned()));
        assert_eq!(parts("felt"), both("felt", "felt"));
        assert_eq!(parts("a = smooth"), both("a", "smooth"));
        for text in ["", "=smooth", "a=", "unknown", "a\nb"] {
            assert_eq!(parts(text), None, "{text:?}");
        }
    }
}
