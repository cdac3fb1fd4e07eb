//! How much is measured.

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    pub(crate) is_quick: bool,
    /// Trainings in one pose, and all others.
    pub(crate) trainings: [usize; 2],
    /// Seconds that are tested of each training, likewise.
    pub(crate) test_s: [f64; 2],
    /// The most conditions of a table.
    pub(crate) conditions: usize,
    /// The most surfaces that have two names, or are left out.
    pub(crate) surfaces: usize,
}

impl Extent {
    pub(crate) const fn new(is_quick: bool) -> Self {
        if is_quick {
            return Self {
                is_quick,
                trainings: [2, 1],
                test_s: [20.0, 20.0],
                conditions: 3,
                surfaces: 1,
            };
        }
        Self {
            is_quick,
            trainings: [5, 3],
            test_s: [240.0, 340.0],
            conditions: usize::MAX,
            surfaces: usize::MAX,
        }
    }
}
