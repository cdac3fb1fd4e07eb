//! What a run has come to.

use serde::{Deserialize, Serialize};

use super::injection::Kind;
use super::judge::Harm;

/// How a run is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ending {
    /// In the end the whiskers move and decide as in the undisturbed run.
    Masked,
    /// The module has noticed it: a fault, a line of the log, or a reset.
    Noticed,
    /// It moves or decides otherwise, and has not noticed it.
    Silent,
    /// What must hold in every tick did not.
    Harmful,
    /// The emulated chip is not modelled beyond this point.
    Unfollowed,
}

/// A run, as it stands in the table of its shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRow {
    /// Where it ran: `host-sim`, or the board's name.
    pub subject: String,
    /// Its number, from which it can be repeated.
    pub run: u64,
    /// The scene's name.
    pub scene: String,
    /// What was injected.
    pub kind: Kind,
    /// What was injected beside it.
    pub and: Option<Kind>,
    /// Before which tick, counted from 1.
    pub start: u64,
    /// For how many ticks; nothing: to the end.
    pub ticks: Option<u64>,
    /// How it is called.
    pub outcome: Ending,
    /// Why, or what was noticed first.
    pub reason: String,
    /// The word of RAM or the register that was changed.
    pub changed: Option<String>,
    /// From the injection to what was noticed first, ms.
    pub noticed_ms: Option<f64>,
}

#[derive(Debug, Default)]
pub(super) struct Findings {
    pub(super) harm: Option<(u64, Harm)>,
    /// The tick of what was noticed first after the injection, and what it was.
    pub(super) noticed: Option<(u64, String)>,
    pub(super) unfollowed: Option<String>,
    pub(super) difference: Option<&'static str>,
}

impl Findings {
    pub(super) const fn is_over(&self) -> bool {
        self.harm.is_some() || self.unfollowed.is_some()
    }

    pub(super) fn verdict(&self) -> (Ending, String) {
        if let Some((tick, harm)) = &self.harm {
            return (Ending::Harmful, format!("{harm}, tick {tick}"));
        }
        if let Some(what) = &self.unfollowed {
            return (Ending::Unfollowed, what.clone());
        }
        if let Some((_, what)) = &self.noticed {
            return (Ending::Noticed, what.clone());
        }
        match self.difference {
            Some(what) => (Ending::Silent, what.to_owned()),
            None => (Ending::Masked, String::new()),
        }
    }
}
