//! Motor and friction from steps of the setpoint.
//!
//! The whisker obeys θ″ = a u − b sgn θ′ − c θ′, with the duty u: a motor with back-EMF and
//! Coulomb friction. Multiplied by φ(t) = sin⁴(π t/T), which is 0 at both ends with three
//! derivatives (so that a sum over ticks is as good as the integral), and integrated by parts over a
//! stretch of length T in which the whisker does not turn round, that is linear in the three
//! unknowns without any derivative of what was measured:
//!
//! ∫ φ″ θ = a ∫ φ u − b sgn θ′ ∫ φ + c ∫ φ′ θ
//!
//! Least squares over all such stretches gives a, b and c (modulating functions: Shinbrot,
//! NACA TN 3288, 1954). With an encoder of 5,600 counts a turn, over motors of 4,000 to 20,000
//! degrees/s, 20 to 80 ms and a friction of 0.02 to 0.1, a = K/τ is found within 1 %, τ within 4 %
//! and friction within 0.001 and 3 % (the tests hold it to that).

use std::f64::consts::PI;

use crate::sample::Sample;

const STRETCH_S: f64 = 0.020;
/// By how much the angle changes at least in each fifth of a stretch, degrees: more than a count
/// of the encoder, and no turning round.
const LEAST_DEG: f64 = 0.1;
const LEAST_STRETCHES: usize = 30;

/// A motor with its gear, as the whisker feels it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Motor {
    /// Speed without friction at full duty K = a/c, degrees/s.
    pub(crate) speed_deg_s: f64,
    /// Mechanical time constant τ = 1/c, s.
    pub(crate) tau_s: f64,
    /// Duty that friction takes, f = b/a.
    pub(crate) friction: f64,
    /// Share of ∫ φ″ θ that the fit leaves, root mean square.
    pub(crate) misfit: f64,
}

/// The motor behind samples at `tick_s`; none if the whisker moved too little, or not as a
/// motor moves it.
pub(crate) fn identify(samples: &[Sample], tick_s: f64) -> Option<Motor> {
    let length = (STRETCH_S / tick_s).round() as usize;
    let stretches = samples.windows(length + 1);
    let rows = stretches.filter_map(|samples| row(samples, tick_s));
    let rows: Vec<Row> = rows.collect();
    if rows.len() < LEAST_STRETCHES {
        return None;
    }
    // Normal equations AᵀA z = Aᵀy.
    let mut normal = [[0.0; 3]; 3];
    let mut right = [0.0; 3];
    for (factors, value) in &rows {
        for (i, a) in factors.iter().enumerate() {
            for (j, b) in factors.iter().enumerate() {
                normal[i][j] += a * b;
            }
            right[i] += a * value;
        }
    }
    let [a, b, c] = solved(normal, right)?;
    let left = |([fa, fb, fc], value): &Row| value - a * fa - b * fb - c * fc;
    let left: f64 = rows.iter().map(left).map(|left| left * left).sum();
    let all: f64 = rows.iter().map(|(_, value)| value * value).sum();
    let motor = Motor {
        speed_deg_s: a / c,
        tau_s: 1.0 / c,
        friction: b / a,
        misfit: (left / all).sqrt(),
    };
    let is_one = a > 0.0 && b > 0.0 && c > 0.0 && motor.misfit < 0.3;
    is_one.then_some(motor)
}

/// One equation: factors of a, b and c, and what they add up to.
type Row = ([f64; 3], f64);

/// That of a stretch in which nothing is missing and the whisker goes one way.
fn row(samples: &[Sample], tick_s: f64) -> Option<Row> {
    let (first, last) = (samples.first()?, samples.last()?);
    let whole = (samples.len() - 1) as f64 * tick_s;
    if last.t_s - first.t_s > whole + 0.5 * tick_s {
        return None;
    }
    let fifth = samples.len().div_ceil(5);
    let parts = samples.chunks(fifth).zip(samples.chunks(fifth).skip(1));
    let direction = (last.measured_deg - first.measured_deg).signum();
    for (before, after) in parts {
        let moved = after.first()?.measured_deg - before.first()?.measured_deg;
        if moved * direction < LEAST_DEG {
            return None;
        }
    }
    let middle = first.measured_deg;
    let (mut factors, mut value) = ([0.0; 3], 0.0);
    for (n, sample) in samples.iter().enumerate() {
        let angle = sample.measured_deg - middle;
        let phase = 2.0 * PI * n as f64 * tick_s / whole;
        // φ = (3 − 4 cos + cos 2)/8 and its derivatives; the trapezoidal rule, with all of them 0
        // at the ends.
        let rate = 2.0 * PI / whole;
        let (single, double) = (phase.sin_cos(), (2.0 * phase).sin_cos());
        value += 0.5 * rate * rate * (single.1 - double.1) * angle * tick_s;
        factors[2] += 0.25 * rate * (2.0 * single.0 - double.0) * angle * tick_s;
        // A tick's duty acts from its end to the next tick's.
        if n + 1 < samples.len() {
            let sum = |p: f64| (3.0 * p - 4.0 * p.sin() + 0.5 * (2.0 * p).sin()) / 8.0;
            factors[0] += (sum(phase + rate * tick_s) - sum(phase)) / rate * sample.duty;
        }
    }
    factors[1] = -direction * 0.375 * whole;
    Some((factors, value))
}

fn solved(normal: [[f64; 3]; 3], right: [f64; 3]) -> Option<[f64; 3]> {
    let determinant = |m: &[[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = determinant(&normal);
    let scale = normal[0][0] * normal[1][1] * normal[2][2];
    if whole.abs() <= 1e-12 * scale.abs() {
        return None;
    }
    let with = |column: usize| {
        let mut replaced = normal;
        for (row, value) in replaced.iter_mut().zip(right) {
            row[column] = value;
        }
        determinant(&replaced) / whole
    };
    Some([with(0), with(1), with(2)])
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gains {
    /// Duty per degree.
    pub(crate) kp: f64,
    /// Duty per degree per second.
    pub(crate) kd: f64,
    /// Dead band that friction leaves, f/kp, degrees to either side.
    pub(crate) dead_band_deg: f64,
    /// Damping ratio of the loop without friction.
    pub(crate) damping: f64,
}

const DAMPING: f64 = 0.8;
/// Corner of the low-pass on the measured velocity, Hz (`whisking::pd`).
const VELOCITY_CORNER_HZ: f64 = 100.0;
/// Natural frequency times delay of what is suggested, at most: the delay takes that many
/// radians of phase.
const LATE: f64 = 0.35;

impl Motor {
    /// What becomes of it under gains: τ θ″ + (1 + K kd) θ′ + K kp θ = K kp s.
    pub(crate) fn under(&self, kp: f64, kd: f64) -> Gains {
        let stiffness = self.speed_deg_s * kp;
        Gains {
            kp,
            kd,
            dead_band_deg: self.friction / kp,
            damping: (1.0 + self.speed_deg_s * kd) / (2.0 * (stiffness * self.tau_s).sqrt()),
        }
    }
}

/// Gains with a damping ratio of 0.8 and as small a dead band as a delay of a tick and a half
/// and the velocity's low-pass allow.
pub(crate) fn suggest(motor: &Motor, tick_s: f64) -> Gains {
    let delay_s = 1.5 * tick_s + 1.0 / (2.0 * PI * VELOCITY_CORNER_HZ);
    let natural = LATE / delay_s;
    let rounded = |value: f64| {
        let digits = 10_f64.powf(1.0 - value.log10().floor());
        (value * digits).round() / digits
    };
    let kp = rounded(natural * natural * motor.tau_s / motor.speed_deg_s);
    let root = (motor.speed_deg_s * kp * motor.tau_s).sqrt();
    let kd = (2.0 * DAMPING * root - 1.0) / motor.speed_deg_s;
    motor.under(kp, if kd > 0.0 { rounded(kd) } else { 0.0 })
}

#[cfg(test)]
mod tests;
