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
        if name.is_empty() || sample.is_empty() || name == host_sim::decisions::UNKNOWN {
            return Err("allowed: a name but \"unknown\", or LABEL=SAMPLE".to_owned());
        }
        for one in [name, sample] {
            token(one)?;
        }
        let [name, sample] = [name, sample].map(str::to_owned);
        Ok(Self { name, sample })
    }
}

/// Tilt and depth.
pub(crate) type Stands = [f64; 2];

/// How samples stand, as `TILT,DEPTH`.
pub(crate) fn stands(text: &str) -> Result<Stands, String> {
    let number = |text: &str| text.trim().parse().ok().filter(|of: &f64| of.is_finite());
    let read = text
        .split_once(',')
        .and_then(|(tilt, depth)| Some([number(tilt)?, number(depth)?]));
    read.ok_or_else(|| "allowed: two numbers with a comma between them".to_owned())
}

/// What may stand in a recording: a label, or a pose.
pub(crate) fn token(text: &str) -> Result<String, String> {
    if text.trim().is_empty() {
        return Err("allowed: a name".to_owned());
    }
    match tactile::name::check(text) {
        Ok(()) => Ok(text.to_owned()),
        Err(reason) => Err(format!("{text:?} {reason}")),
    }
}
