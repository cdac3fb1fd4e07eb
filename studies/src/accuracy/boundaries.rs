//! The limit cycle: how round it is in each format, and where forward Euler
//! leaves it or breaks down, predicted and measured.

use anyhow::Result;
use std::f64::consts::TAU;

use whisking::{Config, Integrator, Real, muscle, oscillator};

use super::schemes::{Format, Pace, in_format};
use crate::page::{Page, short};

/// f_W T of the table of radii: 2 Hz at 20 kHz up to 25 Hz at 250 Hz.
const CYCLES: [f64; 7] = [1e-4, 1e-3, 4e-3, 8e-3, 1.25e-2, 0.05, 0.1];
/// Whisks until a run counts as settled, and those measured then.
const SETTLE: f64 = 60.0;
const MEASURED: f64 = 20.0;
/// ψ_lim.
const LIMIT: f64 = 1.5;

/// A product's configuration at f_W T = `cycles`.
fn config<R: Real>(integrator: Integrator, cycles: f64) -> Result<Config<R>> {
    // The frequency is free: only f_W T enters. It keeps the tick rate in range.
    let frequency_hz = (cycles * 20_000.0).min(25.0);
    let pace = Pace::new(frequency_hz, frequency_hz / cycles);
    pace.settings(integrator)
        .build()
        .map_err(anyhow::Error::new)
}

/// Smallest and largest radius and largest |ψ₁| on the settled limit cycle.
fn cycle<R: Real>(integrator: Integrator, cycles: f64) -> Result<[f64; 3]> {
    let oscillators = config::<R>(integrator, cycles)?.oscillators;
    let mut state = oscillator::State::new([[R::ONE, R::ZERO]; 2].into());
    for _ in 0..(SETTLE / cycles) as usize {
        oscillators.step(&mut state, None);
    }
    let [mut low, mut high, mut drive] = [f64::INFINITY, 0.0, 0.0];
    for _ in 0..(MEASURED / cycles) as usize {
        oscillators.step(&mut state, None);
        for side in oscillators.psi(&state) {
            let [a, b] = side.map(R::to_f64);
            let r = libm::sqrt(a * a + b * b);
            low = f64::min(low, r);
            high = f64::max(high, r);
            drive = f64::max(drive, a.abs());
        }
    }
    Ok([low, high, drive])
}

/// Largest |r − 1|.
fn out_of_round(integrator: Integrator, format: Format, cycles: f64) -> Result<f64> {
    let [low, high, _] = in_format!(format, cycle(integrator, cycles))?;
    Ok(f64::max(high - 1.0, 1.0 - low))
}

/// f_W T at which Euler's radius is [`LIMIT`]. It holds r = √((r + s)² + (φ r)²) with the rotation
/// φ = 2π f_W T and the relaxation s = (1 − r) f_W T/2, so that 4π² x = 2/3 · (1/2) − x/36.
fn predicted_limit() -> f64 {
    let third = 1.0 - 1.0 / LIMIT;
    third / (TAU * TAU + third * third / 4.0)
}

/// f_W T at which the product's Euler oscillator first touches its limit.
fn measured_limit() -> Result<f64> {
    bisect(5e-3, 1.2e-2, |cycles| {
        let [_, _, drive] = cycle::<f64>(Integrator::Euler, cycles)?;
        Ok(drive >= LIMIT)
    })
}

/// 10 f_W T at which |1 + λ T| = 1 for the faster pole, λ = −ω_n (2 + √3).
fn predicted_muscle() -> f64 {
    2.0 / (2.0 + libm::sqrt(3.0))
}

/// 10 f_W T at which the product's Euler muscle, without force, starts to grow.
fn measured_muscle() -> Result<f64> {
    let cycles = bisect(0.01, 0.1, |cycles| {
        let muscle = config::<f64>(Integrator::Euler, cycles)?.muscle;
        let mut state = muscle::State::default();
        state.theta = 1e-3;
        let mut run = || {
            for _ in 0..1_000 {
                muscle.step(&mut state, 0.0, 0.0, 0.0);
            }
            f64::max(state.theta.abs(), state.kept()[0].abs())
        };
        let (before, after) = (run(), run());
        Ok(after > before || after >= 1.0)
    })?;
    Ok(10.0 * cycles)
}

/// Where between `low` (false) and `high` (true) `test` turns.
fn bisect(mut low: f64, mut high: f64, test: impl Fn(f64) -> Result<bool>) -> Result<f64> {
    for _ in 0..16 {
        let middle = f64::midpoint(low, high);
        if test(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(f64::midpoint(low, high))
}

/// The table of radii, and Euler's boundaries.
pub(super) fn section(page: &mut Page) -> Result<()> {
    page.heading(2, "Limit cycle");
    page.say(format_args!(
        "Largest |r − 1| of ψ over {MEASURED} whisks after {SETTLE} whisks, both sides in phase. \
         f_W T = 0.001 is 2 Hz at 0.5 ms, 0.0125 is 25 Hz at 0.5 ms, 0.1 is 25 Hz at 4 ms."
    ));
    let mut rows = Vec::new();
    for cycles in CYCLES {
        let mut row = vec![format!("{cycles}")];
        for format in Format::ALL {
            row.push(short(out_of_round(Integrator::Exact, format, cycles)?));
        }
        row.push(short(out_of_round(Integrator::Euler, Format::F64, cycles)?));
        rows.push(row);
    }
    page.table(
        "f_W T | exact f64 | exact f32 | exact fixed | euler f64",
        rows,
    );

    page.heading(2, "Where forward Euler ends");
    let (limit, muscle) = (measured_limit()?, measured_muscle()?);
    let at_2_khz = |cycles: f64| format!("{:.1} Hz", cycles * 2_000.0);
    let row = |what: &str, formula: &str, predicted: f64, measured: f64, cycles: f64| {
        vec![
            what.to_owned(),
            formula.to_owned(),
            format!("{predicted:.5}"),
            format!("{measured:.5}"),
            at_2_khz(cycles),
        ]
    };
    page.table(
        "boundary | from | predicted | measured | f_W at 2 kHz",
        [
            row(
                "largest 10 f_W T of a stable muscle",
                "poles −ω_n (2 ± √3): 10 f_W T (2 + √3) < 2",
                predicted_muscle(),
                muscle,
                muscle / 10.0,
            ),
            row(
                "f_W T at which ψ reaches ±1.5",
                "growth √(1 + (2π f_W T)²) against relaxation: 1/r = 2/3",
                predicted_limit(),
                limit,
                limit,
            ),
        ],
    );
    page.say(
        "Measured by bisection on runs of the product's own Euler: the oscillator leaves its \
         circle long before the muscle is unstable.",
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Format, Integrator, out_of_round};
    use super::{measured_limit, measured_muscle, predicted_limit, predicted_muscle};

    #[test]
    fn boundaries_are_where_the_poles_put_them() {
        for (measured, predicted) in [
            (measured_muscle().unwrap(), predicted_muscle()),
            (measured_limit().unwrap(), predicted_limit()),
        ] {
            let apart = (measured / predicted - 1.0).abs();
            assert!(apart < 0.01, "{measured} {predicted}");
        }
    }

    #[test]
    fn the_exact_integrator_is_round_at_the_longest_tick() {
        for format in Format::ALL {
            assert!(out_of_round(Integrator::Exact, format, 0.1).unwrap() < 1e-6);
        }
    }
}
