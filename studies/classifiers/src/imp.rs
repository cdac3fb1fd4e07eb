//! The instantaneous mean power (IMP) of a whisker pad (PSIK section 3.1).
//!
//! # Glossary
//!
//! - **deflection**: r = √(x² + y²) of a vibrissa, whichever way it bends.
//! - **peak**: where the deflection stops rising and falls: its derivative
//!   changes sign from plus to minus. Peak amplitude A is the deflection there.
//! - **peak period** T: from one peak to the next, samples.
//! - **IMP**: the mean of A/T over the peaks of a window; for a pure vibration
//!   it is amplitude times frequency.
//!
//! # What it is of simple signals
//!
//! | deflection | IMP |
//! |---|---|
//! | x = A sin(2πft), y = 0: r = A \|sin\| | 2 A f: r has two peaks a turn |
//! | r = c + A sin(2πft), c ≥ A | (c + A) f |
//! | constant, or rising only | 0: no peaks |
//!
//! The amplitude is that of the deflection itself, as the paper has it, so a
//! steady deflection counts: IMP is not invariant to an offset. A trapped or
//! steadily bent whisker thus has a larger IMP at the same vibration.
//!
//! # Noise
//!
//! With every sign change a peak, a noisy sensor at rest has a peak every third
//! sample. The paper's sensors had 8 bits, whose steps swallowed the noise; on
//! a finer sensor either shift the codes down, or ask for a `band`: a peak then
//! counts once the deflection has fallen by more than the band below it, and
//! the next once it has risen by more than the band above the trough. Band
//! nought is the paper's rule.
//!
//! # Numbers
//!
//! Integers throughout. Peaks are found by comparing squares, which is exact;
//! the one square root and the one division are taken at a peak. A/T is in
//! units of 2⁻¹⁶ code a sample, at most 2⁻¹⁵ (3.1e-5) of itself and two units
//! low. Times rate · 2⁻¹⁶ it is in codes a second.

mod pad;
mod peaks;

pub use pad::{Imp, ImpState, ImpSweep};
pub use peaks::{Band, Peaks, deflection};
