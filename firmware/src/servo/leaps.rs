//! Leaps of an encoder: from nothing to more counts in a tick than any motor turns in it. Its
//! contact has closed again, and what turned meanwhile is lost.

/// So many leaps, and counts are lost: a blow may be one.
const MOST: u8 = 2;

#[derive(Debug, Default)]
pub(super) struct Leaps {
    stood: bool,
    seen: u8,
}

impl Leaps {
    /// Whether a tick in which it `moved` by so many counts is a leap, of `least` or more.
    #[inline]
    pub(super) const fn is_one(&mut self, moved: i32, least: u32) -> bool {
        let stood = core::mem::replace(&mut self.stood, moved == 0);
        stood && moved.unsigned_abs() >= least
    }

    pub(super) const fn are_too_many(&mut self) -> bool {
        self.seen = self.seen.saturating_add(1);
        if self.seen >= MOST {
            self.seen = 0;
        }
        self.seen == 0
    }
}

#[cfg(test)]
mod tests {
    use super::Leaps;

    #[test]
    fn a_leap_begins_where_nothing_moved() {
        let mut leaps = Leaps::default();
        let moved = [5, 0, 3, 0, 4, 5, 0, -9];
        let found = moved.map(|moved| leaps.is_one(moved, 4));
        let right = [false, false, false, false, true, false, false, true];
        assert_eq!(found, right);
    }

    #[test]
    fn the_second_is_one_too_many() {
        let mut leaps = Leaps::default();
        let found = [(); 4].map(|()| leaps.are_too_many());
        assert_eq!(found, [false, true, false, true]);
    }
}
