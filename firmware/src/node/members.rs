//! Who lives, who leads, and what others feel.

use can::MAX_NODES;
use whisking::{MAX_SIDES, Real};

use super::{NodeEvent, Times};
use crate::HeadConfig;

/// So many messages in a row with strange stamps, and a clock is another.
const STRANGE: u8 = 3;

#[derive(Debug, Clone, Copy, Default)]
struct Member {
    /// Ticks for which it lives without being heard.
    left: u16,
    is_joined: bool,
    /// Messages in a row with stamps that are no time of this node's clock.
    strange: u8,
    /// Contact π of its whiskers, Q15, and ticks for which that is believed: what comes too late
    /// shows that a node lives, and does not say what it feels.
    pi: [u16; MAX_SIDES],
    believed: u16,
    carries: [bool; MAX_SIDES],
}

#[derive(Debug)]
pub(super) struct Members {
    number: u8,
    drop: u16,
    all: [Member; MAX_NODES],
}

impl Members {
    pub(super) fn new(head: &HeadConfig, number: u8, times: Times) -> Self {
        let member = |node: usize| Member {
            carries: core::array::from_fn(|side| head.carries(node as u8, side)),
            ..Member::default()
        };
        Self {
            number,
            drop: times.drop,
            all: core::array::from_fn(member),
        }
    }

    fn living(&self) -> impl Iterator<Item = (u8, &Member)> {
        let all = (0..).zip(&self.all);
        all.filter(|(_, member)| member.left > 0)
    }

    /// The lowest node that lives, has joined and carries a side, or any; this one counts if it
    /// `has_joined`.
    fn lowest(&self, side: Option<usize>, has_joined: bool) -> Option<u8> {
        let carries =
            |member: &Member| side.is_none_or(|side| member.carries.get(side) == Some(&true));
        let own = self.all.get(usize::from(self.number));
        let own = own.filter(|own| has_joined && carries(own));
        let mut living = self.living();
        let other = living.find(|(_, member)| member.is_joined && carries(member));
        let own = own.map(|_| self.number);
        own.into_iter().chain(other.map(|(number, _)| number)).min()
    }

    pub(super) fn leader(&self, side: usize, has_joined: bool) -> Option<u8> {
        self.lowest(Some(side), has_joined)
    }

    pub(super) fn leader_of_time(&self, has_joined: bool) -> Option<u8> {
        self.lowest(None, has_joined)
    }

    pub(super) fn is_lowest(&self) -> bool {
        self.living().all(|(number, _)| number > self.number)
    }

    /// A node was heard; whether it had not been for a while.
    pub(super) fn heard(&mut self, from: u8, is_joined: bool) -> bool {
        let Some(member) = self.all.get_mut(usize::from(from)) else {
            return false;
        };
        let was_lost = member.left == 0;
        member.left = self.drop;
        member.is_joined = is_joined;
        was_lost
    }

    /// Whether a stamp was a time of this node's clock.
    pub(super) fn fits(&mut self, from: u8, fits: bool) {
        if let Some(member) = self.all.get_mut(usize::from(from)) {
            member.strange = if fits {
                0
            } else {
                member.strange.saturating_add(1)
            };
        }
    }

    /// Whether a lower node of the head has another clock.
    pub(super) fn is_strange(&self) -> bool {
        let mut lower = self
            .living()
            .take_while(|(number, _)| *number < self.number);
        lower.any(|(_, member)| member.is_joined && member.strange >= STRANGE)
    }

    pub(super) fn feels(&mut self, from: u8, pi: [u16; MAX_SIDES]) {
        if let Some(member) = self.all.get_mut(usize::from(from)) {
            (member.pi, member.believed) = (pi, self.drop);
        }
    }

    /// Who was not heard for long does not live; of whom nothing came in time feels nothing.
    pub(super) fn pass(&mut self, events: &mut impl FnMut(NodeEvent)) {
        for (number, member) in (0..).zip(&mut self.all) {
            if member.left == 1 {
                events(NodeEvent::Lost(number));
                *member = Member {
                    carries: member.carries,
                    ..Member::default()
                };
            }
            member.left = member.left.saturating_sub(1);
            member.believed = member.believed.saturating_sub(1);
        }
    }

    /// Contact π of the other nodes' whiskers of each side, the largest.
    pub(super) fn contact<R: Real>(&self) -> [R; MAX_SIDES] {
        let mut most = [0; MAX_SIDES];
        let believed = self.living().filter(|(_, member)| member.believed > 0);
        for (_, member) in believed {
            for (most, pi) in most.iter_mut().zip(member.pi) {
                *most = pi.max(*most);
            }
        }
        most.map(|pi| R::from_q24(i32::from(pi) << 9))
    }
}
