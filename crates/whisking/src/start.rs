//! The start of a run: the given ψ, whiskers at rest, and a past for the multistep integrator.
//!
//! A multistep method needs forces from before the start. The quartic through
//! the first five forces of the run, computed from the same equations in fine
//! steps, is continued backwards; with that past the first ticks are as accurate
//! as the later ones. It is computed once, in f64, outside the tick.

use crate::list::listed;
use crate::muscle::{self, History, PEAK_GAIN, acceleration, pace};
use crate::oscillator::{self, PSI_LIMIT, Psi, field};
use crate::state::{SideStart, Start, WhiskerStart};
use crate::{Error, Integrator, Parameter, Real, Settings, ranges};

const WRONG_SIZE: Error = Error {
    parameter: Parameter::Size,
};

/// Substeps per tick of the fourth-order Runge-Kutta method.
const SUBSTEPS: usize = 32;

/// ψ of all sides and (θ, v) of one whisker.
#[derive(Clone, Copy)]
struct Joint<const S: usize> {
    psi: [Psi<f64>; S],
    whisker: [f64; 2],
}

/// One whisker's equations, which give the change of a [`Joint`] per tick.
struct Equations {
    cycles: f64,
    coupling: bool,
    side: usize,
    gain: f64,
}

impl Equations {
    fn rate<const S: usize>(&self, joint: &Joint<S>) -> Joint<S> {
        let push = self.gain * force(joint, self.side);
        Joint {
            psi: field(&joint.psi, self.cycles, self.coupling),
            whisker: [
                pace(self.cycles) * joint.whisker[1],
                acceleration(self.cycles, joint.whisker, push),
            ],
        }
    }

    /// One step of length `h` ticks, by the classical Runge-Kutta method.
    fn step<const S: usize>(&self, joint: &Joint<S>, h: f64) -> Joint<S> {
        let k1 = self.rate(joint);
        let k2 = self.rate(&joint.moved(h / 2.0, &k1));
        let k3 = self.rate(&joint.moved(h / 2.0, &k2));
        let k4 = self.rate(&joint.moved(h, &k3));
        [(1.0, k1), (2.0, k2), (2.0, k3), (1.0, k4)]
            .iter()
            .fold(*joint, |sum, (weight, k)| sum.moved(weight * h / 6.0, k))
    }
}

impl<const S: usize> Joint<S> {
    fn moved(&self, h: f64, rate: &Self) -> Self {
        let mut out = *self;
        for (x, k) in out.psi.iter_mut().flatten().zip(rate.psi.iter().flatten()) {
            *x = Real::clamp(*x + h * k, -PSI_LIMIT, PSI_LIMIT);
        }
        for (x, k) in out.whisker.iter_mut().zip(rate.whisker) {
            *x = Real::clamp(*x + h * k, -2.0, 2.0);
        }
        out
    }
}

fn force<const S: usize>(joint: &Joint<S>, side: usize) -> f64 {
    muscle::force(muscle::drive(joint.psi[side][0]), joint.whisker[0])
}

impl Settings {
    /// The start from `psi` of each side, left first, with whiskers of nominal gain `gains` of
    /// each side, at rest.
    ///
    /// # Errors
    /// [`Parameter::Size`] unless there are one or two sides, as many in `gains` as in `psi`,
    /// and at most [`MAX_WHISKERS`] whiskers;
    /// [`Parameter::Start`] for a ψ outside [`ranges::PSI`], [`Parameter::Gain`]
    /// for a gain outside [`ranges::GAIN`], or what [`Settings::build`] refuses.
    pub fn start<R: Real>(&self, psi: &[Psi<f64>], gains: &[&[f64]]) -> Result<Start<R>, Error> {
        match *psi {
            [left] => self.start_of([left], gains),
            [left, right] => self.start_of([left, right], gains),
            _ => Err(WRONG_SIZE),
        }
    }

    fn start_of<R: Real, const S: usize>(
        &self,
        psi: [Psi<f64>; S],
        gains: &[&[f64]],
    ) -> Result<Start<R>, Error> {
        if gains.len() != S {
            return Err(WRONG_SIZE);
        }
        for x in psi.iter().flatten() {
            Error::check(Parameter::Start, *x, &ranges::PSI)?;
        }
        for g in gains.iter().copied().flatten() {
            Error::check(Parameter::Gain, *g, &ranges::GAIN)?;
        }
        self.check()?;
        let kept = match self.integrator {
            Integrator::Euler => psi,
            Integrator::Exact => oscillator::keep(&psi, self.cycles(), self.coupling),
        };
        let mut whiskers = heapless::Vec::new();
        for (side, gains) in gains.iter().enumerate() {
            for gain in *gains {
                let whisker = WhiskerStart {
                    side: side as u8,
                    gain: R::from_f64(*gain),
                    history: match self.integrator {
                        Integrator::Euler => History::default(),
                        Integrator::Exact => self.past(psi, side, *gain),
                    },
                };
                whiskers.push(whisker).map_err(|_| WRONG_SIZE)?;
            }
        }
        Ok(Start {
            sides: listed(kept.iter().zip(psi).map(|(kept, psi)| SideStart {
                oscillator: kept.map(R::from_f64),
                drive: R::from_f64(muscle::drive(psi[0])),
            })),
            whiskers,
        })
    }

    fn past<R: Real, const S: usize>(
        &self,
        psi: [Psi<f64>; S],
        side: usize,
        gain: f64,
    ) -> History<R> {
        let equations = Equations {
            cycles: self.cycles(),
            coupling: self.coupling,
            side,
            gain: PEAK_GAIN * gain,
        };
        let mut joint = Joint {
            psi,
            whisker: [0.0; 2],
        };
        let mut forces = [0.0; 5];
        for f in &mut forces {
            *f = force(&joint, side);
            for _ in 0..SUBSTEPS {
                joint = equations.step(&joint, 1.0 / SUBSTEPS as f64);
            }
        }
        // Newton's forward differences; the quartic at −k ticks is
        // Σ_j (−1)^j C(j + k − 1, j) Δ^j f_0.
        let mut ahead = forces;
        for order in 1..ahead.len() {
            for n in (order..ahead.len()).rev() {
                ahead[n] -= ahead[n - 1];
            }
        }
        let [d0, d1, d2, d3, d4] = ahead;
        let f0 = d0;
        let f1 = d0 - d1 + d2 - d3 + d4;
        let f2 = d0 - 2.0 * d1 + 3.0 * d2 - 4.0 * d3 + 5.0 * d4;
        let f3 = d0 - 3.0 * d1 + 6.0 * d2 - 10.0 * d3 + 15.0 * d4;
        let differences = [
            f0,
            f0 - f1,
            f0 - 2.0 * f1 + f2,
            f0 - 3.0 * f1 + 3.0 * f2 - f3,
        ];
        History {
            force: differences.map(R::from_f64),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Equations, Joint};
    use crate::{Fix, Integrator, Number, Settings, State};

    /// Largest error of θ' in degrees over ten whisks against 64 Runge-Kutta steps per tick.
    fn error<R: Number>(frequency_hz: f64, tick_hz: f64, gain: f64, psi: [[f64; 2]; 2]) -> f64 {
        let settings = Settings {
            tick_hz,
            frequency_hz,
            integrator: Integrator::Exact,
            coupling: true,
            noise: 0.0,
            rcp: None,
            cia: None,
        };
        let config = settings.build::<R>().unwrap();
        let start = settings.start::<R>(&psi, &[&[gain][..]; 2]).unwrap();
        let mut state = State::new(&start, 1);
        let side = |side| Equations {
            cycles: settings.cycles(),
            coupling: true,
            side,
            gain: super::PEAK_GAIN * gain,
        };
        let equations = [side(0), side(1)];
        let mut truth = [Joint {
            psi,
            whisker: [0.0; 2],
        }; 2];
        let mut worst = 0.0_f64;
        for _ in 0..(10.0 * tick_hz / frequency_hz) as usize {
            config.step(&mut state, &[]);
            for (joint, equations) in truth.iter_mut().zip(&equations) {
                for _ in 0..16 {
                    *joint = equations.step(joint, 1.0 / 16.0);
                }
            }
            for (theta, truth) in state.theta().zip(&truth) {
                worst = worst.max(100.0 * (theta.to_f64() - truth.whisker[0]).abs());
            }
        }
        worst
    }

    /// The errors that the exact integrator was designed for, in degrees: ticks of
    /// half a millisecond up to 25 Hz, of two milliseconds at 25 Hz.
    #[test]
    fn the_exact_integrator_holds_its_error_from_the_first_tick() {
        let psi = [[1.0, 0.0], [0.6, 0.5]];
        for (frequency_hz, tick_hz, double, single, fixed) in [
            (0.5, 2_000.0, 1e-8, 4e-5, 6e-4),
            (2.0, 2_000.0, 2e-7, 3e-5, 3e-4),
            (8.0, 2_000.0, 3e-6, 6e-5, 2e-4),
            (25.0, 2_000.0, 1.2e-4, 2e-4, 3e-4),
            (25.0, 500.0, 0.06, 0.06, 0.06),
        ] {
            for (error, goal) in [
                (
                    error::<f64> as fn(f64, f64, f64, [[f64; 2]; 2]) -> f64,
                    double,
                ),
                (error::<f32>, single),
                (error::<Fix>, fixed),
            ] {
                let found = error(frequency_hz, tick_hz, 1.0, psi);
                assert!(found < goal, "{frequency_hz} Hz at {tick_hz}: {found:e}");
            }
        }
    }

    /// Far from the circle the error of the split between radial part and coupling
    /// dominates, which is of second order in the tick.
    #[test]
    fn another_start_and_gain_cost_no_more_than_the_split() {
        let psi = [[-1.0, 0.4], [0.1, 0.0]];
        for (tick_hz, goal) in [(2_000.0, 5e-4), (4_000.0, 1.3e-4), (8_000.0, 3.3e-5)] {
            let found = error::<f64>(8.0, tick_hz, 2.0, psi);
            assert!(found < goal, "{tick_hz}: {found:e}");
        }
    }
}
