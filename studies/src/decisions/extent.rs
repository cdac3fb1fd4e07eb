//! How much is measured.

use std::ops::Range;

/// How much is measured. Training seeds are none of those scored.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Extent {
    pub(crate) is_quick: bool,
    /// Seeds of the runs that are trained on; the first is that of the shipped models.
    pub(crate) trainings: Vec<u64>,
    pub(crate) scored: Range<u64>,
    pub(crate) main_job: Range<u64>,
    /// How long a free whisker is moved, s.
    pub(crate) air_s: f64,
    /// How many drives are held out; the rest only serve to train.
    pub(crate) drives: usize,
    pub(crate) values: usize,
}

impl Extent {
    pub(crate) fn new(is_quick: bool) -> Self {
        if is_quick {
            return Self {
                is_quick,
                trainings: vec![3],
                scored: 600..602,
                main_job: 600..603,
                air_s: 10.0,
                drives: 2,
                values: 2,
            };
        }
        Self {
            is_quick,
            trainings: [3].into_iter().chain(41..=49).collect(),
            scored: 600..620,
            main_job: 600..700,
            air_s: 600.0,
            drives: usize::MAX,
            values: usize::MAX,
        }
    }
}
