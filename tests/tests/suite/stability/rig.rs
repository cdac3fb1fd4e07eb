//! A module of two sides with two whiskers each in one number format, its
//! bounds, and the inputs that try to break it.

use std::fmt::Debug;

use whisking::muscle::History;
use whisking::{
    Config, Fix, Number, Settings, SideStart, Start, State, WhiskerStart, WhiskerState, filter,
};

use super::axes::{Case, INPUTS, Input, NOMINAL, Random};

/// The numbers of a format that come nearest to no number at all.
pub(crate) trait Extreme: Number + Send + Sync {
    const NOT_A_NUMBER: Self;
    const HIGHEST: Self;
    const LOWEST: Self;
    /// The distance of neighbouring numbers near zero.
    const STEP: f64;
    /// The largest distance from f64 of ψ, θ, z and g that is taken for rounding.
    const ROUNDING: f64;
}

impl Extreme for f64 {
    const NOT_A_NUMBER: Self = Self::NAN;
    const HIGHEST: Self = Self::INFINITY;
    const LOWEST: Self = Self::NEG_INFINITY;
    const STEP: f64 = 0.0;
    const ROUNDING: f64 = 0.0;
}

impl Extreme for f32 {
    const NOT_A_NUMBER: Self = Self::NAN;
    const HIGHEST: Self = Self::INFINITY;
    const LOWEST: Self = Self::NEG_INFINITY;
    const STEP: f64 = 0.0;
    const ROUNDING: f64 = 5e-5;
}

impl Extreme for Fix {
    const NOT_A_NUMBER: Self = Self(i32::MIN);
    const HIGHEST: Self = Self(i32::MAX);
    const LOWEST: Self = Self(i32::MIN);
    const STEP: f64 = 1.0 / 268_435_456.0;
    // Constants of 16 bits, within 3e-5 of their values.
    const ROUNDING: f64 = 3e-4;
}

pub(crate) struct Module<R: Number> {
    config: Config<R>,
    pub(crate) state: State<R>,
}

impl<R: Number> Module<R> {
    pub(crate) fn new(settings: &Settings, start: &Start<R>) -> Self {
        Self {
            config: settings.build().unwrap(),
            state: State::new(start, 1),
        }
    }

    pub(crate) fn tick(&mut self, contact: [R; 2], case: &impl Debug) {
        self.config.step(&mut self.state, &contact);
        let [psi, theta, kept, z, g] = self.view();
        let is_within = |list: &[f64], lo: f64, hi: f64| list.iter().all(|x| (lo..=hi).contains(x));
        assert!(
            is_within(&psi, -1.5, 1.5)
                && is_within(&theta, -2.5, 2.5)
                && is_within(&kept, -3.0, 3.0)
                && is_within(&z, 0.0, 1.0)
                && is_within(&g, 0.0, 2.0),
            "{case:?}: {:?}",
            self.state
        );
    }

    /// ψ, θ, v or the slow lag, z (twice) and g.
    pub(crate) fn view(&self) -> [[f64; 4]; 5] {
        let psi = self.config.oscillators.psi(&self.state.oscillators);
        let whiskers = [0, 1, 2, 3].map(|n| &self.state.whiskers[n]);
        let [l, r] = [0, 1].map(|side| self.state.sides[side].z.value);
        let numbers = [
            [psi[0][0], psi[0][1], psi[1][0], psi[1][1]],
            whiskers.map(|w| w.muscle.theta),
            whiskers.map(|w| w.muscle.kept()[0]),
            [l, l, r, r],
        ]
        .map(|list: [R; 4]| list.map(R::to_f64));
        let [psi, theta, kept, z] = numbers;
        [psi, theta, kept, z, whiskers.map(WhiskerState::gain)]
    }

    pub(crate) fn distance<Q: Number>(&self, other: &Module<Q>) -> f64 {
        let (a, b) = (self.view(), other.view());
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

pub(crate) fn start<R: Number>(case: Case, settings: &Settings) -> Start<R> {
    let [left, right] = &NOMINAL;
    settings.start(&case.start(), &[left, right]).unwrap()
}

/// The same start, to the last bit, in f64.
pub(crate) fn widened<R: Number>(start: &Start<R>) -> Start<f64> {
    Start {
        sides: (start.sides.iter())
            .map(|side| SideStart {
                oscillator: side.oscillator.map(R::to_f64),
                drive: side.drive.to_f64(),
            })
            .collect(),
        whiskers: (start.whiskers.iter())
            .map(|whisker| WhiskerStart {
                side: whisker.side,
                gain: whisker.gain.to_f64(),
                history: History {
                    force: whisker.history.force.map(R::to_f64),
                },
            })
            .collect(),
    }
}

/// Contact of both sides during abuse.
pub(crate) struct Abuse<R: Number> {
    input: Input,
    h50: filter::Config<R>,
    filters: [filter::State<R>; 2],
    up: bool,
    random: Random,
}

impl<R: Extreme> Abuse<R> {
    pub(crate) fn new(input: Input, tick_hz: f64) -> Self {
        Self {
            input,
            h50: filter::Config::new(filter::CORNER_HZ, tick_hz).unwrap(),
            filters: [filter::State::default(); 2],
            up: false,
            random: Random(7),
        }
    }

    pub(crate) fn contact(&mut self) -> [R; 2] {
        self.up = !self.up;
        let jump = if self.up { R::ONE } else { -R::ONE };
        let h50 = self.h50;
        let filtered = self.filters.each_mut().map(|f| h50.process(f, jump).abs());
        [filtered[0], filtered[1]].map(|filtered| {
            let input = match self.input {
                Input::Mixed => INPUTS[self.random.below(INPUTS.len() - 1)],
                input => input,
            };
            match input {
                Input::Saturated => R::ONE,
                Input::Dead | Input::Mixed => R::ZERO,
                Input::Alternating => filtered,
                Input::NotANumber => R::NOT_A_NUMBER,
                Input::Highest => R::HIGHEST,
                Input::Lowest => R::LOWEST,
            }
        })
    }
}
