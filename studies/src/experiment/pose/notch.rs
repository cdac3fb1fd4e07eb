//! The notch at the whisker's resonance, behind which POSE takes its features of texture
//! (section II-C: "IIR notch filtered to remove the resonant frequency").

use anyhow::{Context, Result};
use core::f64::consts::TAU;

use physics::Shaft;

/// The lowest natural frequency of the table's whisker in free air, Hz.
pub(super) fn resonance_hz() -> Result<f64> {
    let modes = Shaft::xy_table().modes(1)?;
    let first = modes.modes.first().context("no mode")?;
    Ok(first.omega_rad_s / TAU)
}

/// A signal behind a notch at `hz`, `hz` / `quality` wide (at −3 dB), as if it had always rested
/// at its first value; the signal itself for a quality of 0:
/// H(z) = (1 − 2 c z⁻¹ + z⁻²)/(1 + a − 2 c z⁻¹ + (1 − a) z⁻²) with c = cos ω and
/// a = sin ω/(2 quality), the bilinear transform of the analogue notch.
pub(super) fn notched(x: &[f64], hz: f64, quality: f64, rate_hz: f64) -> Vec<f64> {
    if quality <= 0.0 {
        return x.to_vec();
    }
    let (sine, cosine) = libm::sincos(TAU * hz / rate_hz);
    let a = sine / (2.0 * quality);
    let rest = x.first().copied().unwrap_or(0.0);
    let (mut inputs, mut outputs) = ([rest; 2], [rest; 2]);
    let step = |&x: &f64| {
        let zeros = x - 2.0 * cosine * inputs[0] + inputs[1];
        let poles = 2.0 * cosine * outputs[0] - (1.0 - a) * outputs[1];
        let y = (zeros + poles) / (1.0 + a);
        inputs = [x, inputs[0]];
        outputs = [y, outputs[0]];
        y
    };
    x.iter().map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::notched;

    #[test]
    fn a_tone_at_the_notch_goes_and_others_and_the_mean_stay() {
        let rate_hz = 4000.0;
        let amplitude = |hz: f64| {
            let tone =
                |n: i32| 5.0 + libm::sin(core::f64::consts::TAU * hz * f64::from(n) / rate_hz);
            let x: Vec<f64> = (0..16_000).map(tone).collect();
            let y = notched(&x, 30.0, 5.0, rate_hz);
            let late = y.iter().skip(8_000).map(|y| y - 5.0);
            late.fold(0.0_f64, |most, y| most.max(y.abs()))
        };
        assert!(amplitude(30.0) < 1e-3, "{}", amplitude(30.0));
        // Half the power at the edges of its width, geometrically about its middle.
        let edge = 30.0 * (1.0 + 0.25 / 25.0_f64).sqrt() + 3.0;
        assert!((amplitude(edge) - 0.5_f64.sqrt()).abs() < 0.01);
        assert!((amplitude(200.0) - 1.0).abs() < 0.01);
        assert_eq!(notched(&[1.0, 2.0], 30.0, 0.0, rate_hz), [1.0, 2.0]);
    }
}
