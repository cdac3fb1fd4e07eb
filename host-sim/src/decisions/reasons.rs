//! Decisions that name no class, counted by their reasons.

use tactile::Reason;

use super::Decided;

/// The reasons in the order in which they are shown.
const REASONS: [Reason; 3] = [Reason::Unknown, Reason::Pose, Reason::Between(0)];

/// How many decisions name no class, for each reason.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Reasons([usize; REASONS.len()]);

impl Reasons {
    /// Of these decisions.
    pub fn of<'d>(decisions: impl Iterator<Item = &'d Decided> + Clone) -> Self {
        let reasons = decisions.filter_map(|d| d.reason);
        let count = |of: Reason| {
            let same = reasons.clone().filter(|reason| reason.name() == of.name());
            same.count()
        };
        Self(REASONS.map(count))
    }

    /// Name and count of each that there is. Nothing where all are unknown, as they are counted as
    /// such anyway.
    pub fn apart(self) -> impl Iterator<Item = (&'static str, usize)> {
        let [_, further @ ..] = self.0;
        let are_told = further != [0; 2];
        let each = REASONS.map(Reason::name).into_iter().zip(self.0);
        each.filter(move |(_, count)| are_told && *count > 0)
    }
}
