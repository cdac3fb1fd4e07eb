//! How much is measured.

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    /// Whether this is the short form.
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
    /// At least 400 presentations of 2.5 s in each cell.
    pub(crate) const fn full() -> Self {
        Self {
            is_quick: false,
            trainings: [5, 3],
            test_s: [240.0, 340.0],
            conditions: usize::MAX,
            surfaces: usize::MAX,
        }
    }

    pub(crate) const fn quick() -> Self {
        Self {
            is_quick: true,
            trainings: [2, 1],
            test_s: [20.0, 20.0],
            conditions: 3,
            surfaces: 1,
        }
    }
}
