//! Deciding together: one board of a head adds up what the whiskers of all have felt.

use can::{Evidence, MAX_NODES, Message, OTHERS};
use tactile::{Decision, Felt};

use super::Times;
use crate::Part;
use crate::perception::SampleClassifier;

// What is felt fits what is said.
const _: () = {
    assert!(Felt::MOST_BEHIND == Evidence::MOST_DEFICIT);
    let ([least, most], [from, to]) = (Felt::EXCESS, Evidence::EXCESS);
    assert!(least == from && most == to);
};

/// Most boards whose evidence comes.
const BOARDS: usize = if Part::Classifier.is_built() && Part::Several.is_built() {
    MAX_NODES
} else {
    0
};

/// What a board knows of the evidence of others, and has said of its own.
#[derive(Debug)]
pub(super) struct Deciding {
    times: Times,
    /// Parts that have come, of each board.
    heard: [Felt; BOARDS],
    said: Option<Felt>,
    since_said: u16,
    /// Evidence from before this tick led to the last decision.
    begins: u32,
}

/// The classes other than `leader` of which a part of evidence is.
fn others(leader: u8, part: u8, classes: usize) -> impl Iterator<Item = usize> {
    let all = (0..classes).filter(move |class| *class != usize::from(leader));
    all.skip(usize::from(part) * OTHERS).take(OTHERS)
}

impl Deciding {
    pub(super) const fn new(times: Times) -> Self {
        Self {
            times,
            heard: [Felt::NOTHING; BOARDS],
            said: None,
            since_said: 0,
            begins: 0,
        }
    }

    /// Evidence of a board, made after tick `made`, takes effect; a decision may fall by it.
    pub(super) fn hear(
        &mut self,
        from: u8,
        made: u32,
        evidence: Evidence,
        classifier: &mut impl SampleClassifier,
    ) -> Option<Decision> {
        if made.wrapping_sub(self.begins).cast_signed() < 0 {
            return None;
        }
        let classes = classifier.classes();
        let heard = self.heard.get_mut(usize::from(from))?;
        let Evidence {
            leader,
            part,
            deficits,
            excess,
        } = evidence;
        heard.excess = excess;
        *heard
            .behind
            .get_mut(usize::from(leader))
            .filter(|_| usize::from(leader) < classes)? = 0;
        for (class, deficit) in others(leader, part, classes).zip(deficits) {
            *heard.behind.get_mut(class)? = deficit;
        }
        let is_last = others(leader, part + 1, classes).next().is_none();
        let heard = *heard;
        is_last
            .then(|| classifier.hear(from.into(), Some(&heard)))
            .flatten()
    }

    /// The head has decided, at tick `now`: what was felt before does not count again.
    pub(super) const fn decided(&mut self, now: u32) {
        self.said = None;
        self.begins = now;
    }

    /// What this board has felt since it said so last, for the board that adds up.
    pub(super) fn say(
        &mut self,
        classifier: &impl SampleClassifier,
        say: &mut impl FnMut(Message),
    ) {
        self.since_said = self.since_said.saturating_add(1);
        let now = classifier.evidence();
        if self.since_said < self.times.contact || now == self.said {
            return;
        }
        let Some(Felt { behind, excess }) = now else {
            return;
        };
        self.since_said = 0;
        self.said = now;
        let classes = classifier.classes();
        let leader = behind
            .iter()
            .take(classes)
            .position(|deficit| *deficit == 0);
        let leader = leader.unwrap_or(0) as u8;
        for part in 0..classes.saturating_sub(1).div_ceil(OTHERS) as u8 {
            let mut deficits = [0; OTHERS];
            for (deficit, class) in deficits.iter_mut().zip(others(leader, part, classes)) {
                *deficit = behind.get(class).copied().unwrap_or(0);
            }
            say(Message::Evidence(Evidence {
                leader,
                part,
                deficits,
                excess,
            }));
        }
    }
}
