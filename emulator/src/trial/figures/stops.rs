//! What becomes of a stop.

use super::super::links::Arrived;

#[derive(Debug, Clone, Default)]
pub(super) struct Stops {
    ticks: u64,
    pub(super) arrived: u64,
    /// After which a motor was still driven, or armed, a tick later.
    pub(super) late: u64,
    /// Most ticks from a stop to off.
    pub(super) longest: u64,
    /// Ticks in which a motor was driven after the first.
    pub(super) driven: u64,
    /// The first has come; and nothing has armed since.
    has_stopped: bool,
    is_stopped: bool,
    /// The first that has not switched off yet, and how many came a tick ago.
    pending: Option<u64>,
    just_now: u64,
}

impl Stops {
    /// What has arrived in a tick, and what its pins then do.
    pub(super) fn look(&mut self, is_driven: bool, may_drive: bool, arrived: Arrived) {
        self.ticks += 1;
        if arrived.is_arm {
            self.is_stopped = false;
            self.pending = None;
            self.just_now = 0;
        }
        self.driven += u64::from(self.is_stopped && is_driven);
        if may_drive {
            self.late += self.just_now;
        } else {
            self.end();
        }
        self.just_now = 0;
        if arrived.stops == 0 {
            return;
        }
        self.arrived += arrived.stops;
        let is_first = !std::mem::replace(&mut self.has_stopped, true);
        // Whichever of the two came first, it may be armed.
        if arrived.is_arm {
            return;
        }
        self.just_now = arrived.stops;
        self.is_stopped |= is_first;
        if may_drive {
            self.pending.get_or_insert(self.ticks);
        }
    }

    /// It is off now, or the run is over.
    pub(super) fn end(&mut self) {
        if let Some(since) = self.pending.take() {
            self.longest = self.longest.max(self.ticks - since);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Arrived, Stops};

    const NOTHING: Arrived = Arrived {
        stops: 0,
        is_arm: false,
        is_clear: false,
    };
    const STOP: Arrived = Arrived {
        stops: 1,
        ..NOTHING
    };
    const ARM: Arrived = Arrived {
        is_arm: true,
        ..NOTHING
    };

    #[test]
    fn a_stop_may_take_until_the_next_tick_and_an_arm_ends_it() {
        let mut stops = Stops::default();
        for (is_driven, arrived) in [
            (true, NOTHING),
            (true, STOP),
            (false, NOTHING),
            (true, ARM),
            (true, NOTHING),
        ] {
            stops.look(is_driven, is_driven, arrived);
        }
        let found = (stops.arrived, stops.late, stops.longest, stops.driven);
        assert_eq!(found, (1, 0, 1, 0));
        stops = Stops::default();
        for (is_driven, arrived) in [(true, STOP), (true, NOTHING), (true, NOTHING)] {
            stops.look(is_driven, is_driven, arrived);
        }
        stops.end();
        let found = (stops.arrived, stops.late, stops.longest, stops.driven);
        assert_eq!(found, (1, 1, 2, 2));
    }
}
