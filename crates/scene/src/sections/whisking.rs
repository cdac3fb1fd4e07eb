//! `[whisking]`: oscillators, their coupling, and muscle.

use whisking::{Integrator, ranges};

use crate::choice::choice;
use crate::key::{number, pair_per_side, per_whisker, word, yes_or_no};
use crate::keys::keys;

choice! { for Integrator { Exact = "exact", Euler = "euler" } }

choice! {
    /// Number format of the tick. `config` says which one [`Numbers::Auto`] is.
    pub enum Numbers {
        /// The one that suits the integrator and the board.
        Auto = "auto",
        /// Single precision, as on a board with an FPU.
        Single = "f32",
        /// Double precision, the reference.
        Double = "f64",
        /// 32-bit fixed point, as on a board without FPU.
        Fixed = "fixed",
    }
}

keys! {
    /// Active whisking: oscillators, coupling and muscle (BIOTACT eqs 2 to 9).
    pub struct WhiskingSection {
        /// Whisk frequency f_W. A motor that would be too hot within 6 s of it is refused.
        frequency_hz: f64 = number(ranges::FREQUENCY_HZ).unit("Hz"),

        /// `exact` keeps to the limit cycle; `euler` is the papers' forward Euler, step for step.
        /// Below 18.7 ticks a whisk its muscles swing up, and the scene is refused.
        integrator: Integrator = word(),

        /// Whether the sides' oscillators are coupled (eq. 4).
        coupling: bool = yes_or_no(),

        /// Standard deviation σ_η of the oscillator noise.
        noise: f64 = number(ranges::NOISE),

        /// Nominal gain g_nominal of the muscle drive.
        gain: Vec<f64> = per_whisker(ranges::GAIN),

        /// Oscillator state ψ = [ψ₁, ψ₂] of each side at the start.
        start: Vec<[f64; 2]> = pair_per_side(ranges::PSI),

        /// Number format of the tick. `auto` in a simulation: `f64` for `euler`, as in the papers,
        /// `f32` for `exact`; on a board: `f32` with an FPU, else `fixed`. No board has `f64`, and
        /// only one with an FPU `f32`.
        numbers: Numbers = word().default("\"auto\""),
    }
}
