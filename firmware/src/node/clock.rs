//! The clock that all nodes of a head share: that of its lowest node that lives.
//!
//! A message of time ends at the same moment for all who hear it. Its sender notes when by its
//! clock, and says so in the next one; who has noted the same by its own knows how far it is off.

/// When a message of time ended, by the node's own clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Ended {
    from: u8,
    number: u8,
    at_us: u64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Clock {
    last: Option<Ended>,
    /// What is added to the node's own clock, µs.
    offset_us: i64,
    is_set: bool,
    /// The number of the next message of time of its own, and when the last ended, by the head's.
    next: u8,
    said_us: u64,
}

impl Clock {
    pub(super) const fn new() -> Self {
        Self {
            last: None,
            offset_us: 0,
            is_set: false,
            next: 0,
            said_us: 0,
        }
    }

    pub(super) const fn is_set(&self) -> bool {
        self.is_set
    }

    pub(super) fn hear(&mut self, from: u8, number: u8, last_us: u64, at_us: u64) {
        if let Some(last) = self.last
            && last.from == from
            && last.number == number.wrapping_sub(1)
        {
            self.offset_us = last_us.wrapping_sub(last.at_us).cast_signed();
            self.is_set = true;
        }
        self.last = Some(Ended {
            from,
            number,
            at_us,
        });
    }

    pub(super) const fn said(&mut self, at_us: u64) {
        self.said_us = at_us.wrapping_add_signed(self.offset_us);
    }

    pub(super) const fn next(&mut self) -> (u8, u64) {
        let number = self.next;
        self.next = number.wrapping_add(1);
        (number, self.said_us)
    }

    /// Which tick of the head's clock is nearest to now, and by how much it is past, µs; none: that
    /// clock is not known.
    pub(super) fn tick(&self, now_us: u64, tick_hz: u32) -> Option<(u32, i32)> {
        // Of 48 bits, as a message has: then the product fits, and a board divides no 128 bits.
        let us = now_us.wrapping_add_signed(self.offset_us) & ((1 << 48) - 1);
        let rounded = us.saturating_mul(tick_hz.into()).saturating_add(500_000);
        // Of a tick, from −500,000 to 499,999.
        let millionths = (rounded % 1_000_000) as i32 - 500_000;
        let past_us = millionths.checked_div(tick_hz.cast_signed()).unwrap_or(0);
        self.is_set
            .then_some(((rounded / 1_000_000) as u32, past_us))
    }
}

#[cfg(test)]
mod tests {
    use super::Clock;
    use proptest::prelude::*;

    proptest! {
        /// However far two clocks are apart, the second node's ticks have the first's numbers after
        /// two messages, however long those take.
        #[test]
        fn two_messages_set_a_clock(
            own_us in 0_u64..1 << 40,
            head_us in 0_u64..1 << 40,
            took_us in 50_u64..5_000,
        ) {
            let (mut first, mut second) = (Clock::new(), Clock::new());
            let mut later = 0;
            for _ in 0..2 {
                let (number, last_us) = first.next();
                later += took_us;
                first.said(head_us + later);
                second.hear(0, number, last_us, own_us + later);
            }
            prop_assert!(second.is_set());
            let tick = |us: u64| ((us as f64) * 2e-3).round() as u32;
            for after in [0, 250_001, 499_999, 1_000_000] {
                let (found, past_us) = second.tick(own_us + after, 2000).unwrap();
                let head_us = head_us + after;
                prop_assert!(found.abs_diff(tick(head_us)) <= 1);
                let nearest_us = i64::from(found) * 500 + i64::from(past_us);
                prop_assert_eq!(nearest_us as u32, head_us as u32);
            }
        }
    }

    #[test]
    fn only_two_in_a_row_of_one_node_count() {
        let mut clock = Clock::new();
        clock.hear(0, 1, 500, 100);
        clock.hear(0, 3, 900, 300);
        assert_eq!(clock.tick(400, 2000), None);
        clock.hear(1, 4, 900, 400);
        assert_eq!(clock.tick(400, 2000), None);
        clock.hear(1, 5, 10_400, 500);
        // 10,600 µs by the head's clock, 21.2 ticks.
        assert_eq!(clock.tick(600, 2000), Some((21, 100)));
    }
}
