//! A value that nothing ever works out again, kept so that a flipped bit is noticed.

/// A value in three copies. What every tick works out heals by itself; what was set once,
/// as a gain or the rest of a motor, does not. Two copies that agree are believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Voted<T> {
    first: T,
    second: T,
    third: T,
}

impl<T: Copy + PartialEq> Voted<T> {
    /// Three copies of `value`.
    pub const fn new(value: T) -> Self {
        Self {
            first: value,
            second: value,
            third: value,
        }
    }

    /// The value of which there are two copies; `None` if all three differ.
    #[allow(clippy::inline_always, reason = "a call costs more than it does")]
    #[inline(always)]
    pub fn get(&self) -> Option<T> {
        if self.first == self.second {
            return Some(self.first);
        }
        self.by_third()
    }

    #[cold]
    #[inline(never)]
    fn by_third(&self) -> Option<T> {
        let agrees = |copy: &T| *copy == self.third;
        [self.first, self.second].into_iter().find(agrees)
    }

    /// The copies, for tests that spoil them.
    pub const fn copies_mut(&mut self) -> [&mut T; 3] {
        [&mut self.first, &mut self.second, &mut self.third]
    }
}

#[cfg(test)]
mod tests {
    use super::Voted;

    #[test]
    fn two_copies_outvote_the_third() {
        for n in 0..3 {
            let mut voted = Voted::new(7);
            *voted.copies_mut()[n] = -9;
            assert_eq!(voted.get(), Some(7), "{n}");
        }
        let mut voted = Voted::new(0.5_f32);
        *voted.copies_mut()[0] = f32::NAN;
        assert_eq!(voted.get(), Some(0.5));
        *voted.copies_mut()[2] = f32::NAN;
        assert_eq!(voted.get(), None, "a NaN agrees with nothing");
    }
}
