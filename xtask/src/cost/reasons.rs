//! Why a goal is missed, for docs/measured/cost.md.

/// Stages that miss their goal for one reason, and the reason.
pub(super) struct Reason {
    pub(super) stages: &'static [&'static str],
    pub(super) why: &'static str,
}

/// All that is known. A stage that misses its goal and is not here fails
/// `cargo xtask cost`.
pub(super) const REASONS: &[Reason] = &[
    Reason {
        stages: &["classifier push 4 classes", "classifier push 9 classes"],
        why: "The same number of instructions too many for any number of classes: they find \
              the bins. The quantiser is data of the model (origin and slope of each channel), \
              its edges are checked for every code an `i32` can be, the frame pointer is kept \
              for the debugger, and call and return are counted; the floor has one shift for \
              bins and no edges. A table of powers of two would be cheaper, but the models \
              must have equal bins over the range that was learnt.",
    },
    Reason {
        stages: &["both oscillators exact with both drives"],
        why: "The goal is that of the step alone; here the ψ₁ that the muscles need is worked \
              out for both sides as well, from what the step keeps. The mean is a compensated sum: \
              without that, rounding alone is of the size of the error that is allowed at 2 Hz \
              in single precision. The radial \
              relaxation is a polynomial whose error is below rounding in place of a small \
              table, with the check that it may be used.",
    },
    Reason {
        stages: &["muscle with its exponential"],
        why: "The goal is below the floor, which is of third order; this is of fifth, for the \
              sake of 2 ms ticks at 25 Hz (docs/measured/accuracy.md), and sums the slow lag with \
              compensation.",
    },
];
