//! Stability: every format driven to its corners, in bounds throughout. The same is a test with more levels
//! (`tests/tests/suite/stability`); here stand its figures.

use anyhow::Result;
use whisking::{Fix, GateSettings, Integrator, Number, Settings, State, filter};

use super::schemes::Pace;
use crate::page::{Page, short};

const FREQUENCIES_HZ: [f64; 3] = [0.05, 2.0, 25.0];
const TICKS_HZ: [f64; 3] = [200.0, 2_000.0, 20_000.0];
/// Time constants of the gates, in ticks (first) and whisks.
const TAUS: [(f64, f64); 3] = [(0.1, 0.0), (0.0, 0.25), (0.0, 1_000.0)];
/// σ_z and σ_g.
const GAINS: [f64; 3] = [0.0, 0.7, 100.0];
const STARTS: [[[f64; 2]; 2]; 4] = [
    [[0.0, 0.0], [0.0, 0.0]],
    [[1e-12, 0.0], [0.0, -1e-30]],
    [[1.0, 0.0], [-1.0, 0.0]],
    [[1.5, 1.5], [-1.5, 1.5]],
];
const TICKS: usize = 400;

#[derive(Clone, Copy)]
enum Input {
    Dead,
    Saturated,
    Alternating,
    /// A contact signal that is not a number, or infinite.
    Wild(f64),
}

const INPUTS: [Input; 5] = [
    Input::Dead,
    Input::Saturated,
    Input::Alternating,
    Input::Wild(f64::NAN),
    Input::Wild(f64::INFINITY),
];

/// A module of two whiskers whose contact signals we make.
struct Driven<R: Number> {
    config: whisking::Config<R>,
    state: State<R>,
    h50: filter::Config<R>,
    filters: [filter::State<R>; 2],
    ticks: usize,
}

impl<R: Number> Driven<R> {
    fn new(settings: &Settings, psi: [[f64; 2]; 2], gain: f64) -> Result<Self> {
        let start = settings.start(&psi, &[&[gain][..]; 2])?;
        Ok(Self {
            config: settings.build()?,
            state: State::new(&start, 1),
            h50: filter::Config::new(filter::CORNER_HZ, settings.tick_hz)?,
            filters: Default::default(),
            ticks: 0,
        })
    }

    fn tick(&mut self, input: Input) {
        let odd = self.ticks % 2 == 1;
        self.ticks += 1;
        let mut contact = [R::ZERO; 2];
        for (contact, filter) in contact.iter_mut().zip(&mut self.filters) {
            let x = match input {
                Input::Dead | Input::Wild(_) => R::ZERO,
                Input::Alternating if odd => -R::ONE,
                Input::Saturated | Input::Alternating => R::ONE,
            };
            *contact = self.h50.process(filter, x).abs();
            if let Input::Wild(value) = input {
                *contact = R::from_f64(value);
            }
        }
        self.config.step(&mut self.state, &contact);
    }
}

#[derive(Debug, Default)]
struct Extremes {
    runs: u32,
    psi: f64,
    theta: f64,
    kept: f64,
    z: f64,
    g: f64,
    /// Values that are not finite, or below zero where they must not be.
    wrong: u64,
}

impl Extremes {
    fn look<R: Number>(&mut self, driven: &Driven<R>) {
        let state = &driven.state;
        let mut note = |largest: fn(&mut Self) -> &mut f64, value: f64, least: f64| {
            if !value.is_finite() || value < least {
                self.wrong += 1;
            }
            let largest = largest(self);
            *largest = f64::max(*largest, value.abs());
        };
        for x in driven
            .config
            .oscillators
            .psi(&state.oscillators)
            .iter()
            .flatten()
        {
            note(|e| &mut e.psi, x.to_f64(), -1.5);
        }
        for side in &state.sides {
            note(|e| &mut e.z, side.z.value.to_f64(), 0.0);
        }
        for whisker in &state.whiskers {
            note(|e| &mut e.g, whisker.gain(), 0.0);
            note(|e| &mut e.theta, whisker.muscle.theta.to_f64(), -2.5);
            for kept in whisker.muscle.kept() {
                note(|e| &mut e.kept, kept.to_f64(), -5.0);
            }
        }
    }
}

/// Every combination of the levels above, for one format.
fn extremes<R: Number>() -> Result<Extremes> {
    let mut found = Extremes::default();
    for settings in combinations() {
        for psi in STARTS {
            for input in INPUTS {
                let mut driven = Driven::<R>::new(&settings, psi, 2.0)?;
                for _ in 0..TICKS {
                    driven.tick(input);
                    found.look(&driven);
                }
                found.runs += 1;
            }
        }
    }
    Ok(found)
}

fn combinations() -> Vec<Settings> {
    let mut list = Vec::new();
    for frequency_hz in FREQUENCIES_HZ {
        for tick_hz in TICKS_HZ {
            for (in_ticks, in_whisks) in TAUS {
                for gain in GAINS {
                    for integrator in [Integrator::Exact, Integrator::Euler] {
                        let tau_s = in_ticks / tick_hz + in_whisks / frequency_hz;
                        let gate = Some(GateSettings { gain, tau_s });
                        let pace = Pace::new(frequency_hz, tick_hz);
                        list.push(Settings {
                            rcp: gate,
                            cia: gate,
                            ..pace.settings(integrator)
                        });
                    }
                }
            }
        }
    }
    list
}

/// The section.
pub(super) fn section(page: &mut Page) -> Result<()> {
    fn row<R: Number>(name: &str) -> Result<Vec<String>> {
        let found = extremes::<R>()?;
        Ok(vec![
            name.to_owned(),
            found.runs.to_string(),
            short(found.psi),
            short(found.theta),
            short(found.kept),
            short(found.z),
            short(found.g),
            found.wrong.to_string(),
        ])
    }
    page.heading(2, "Stability");
    page.say(format_args!(
        "Every combination of f_W 0.05, 2 and 25 Hz; ticks of 5, 0.5 and 0.05 ms; gates with time \
         constants of a tenth of a tick, a quarter of a whisk and a thousand whisks; gains of \
         nothing, 0.7 and 100; both integrators (Euler beyond its boundary too); starts at the \
         origin, next to it, in anti-phase and in the corners of ψ; contact signals dead, \
         saturated, alternating at full scale each tick, not a number and infinite: {TICKS} ticks \
         each. The largest values met, beside their bounds. `cargo test` runs the same with more \
         levels, and that θ' recovers."
    ));
    page.table(
        "format | runs | ψ (1.5) | θ (2.5) | v or lags (5) | z (1) | g (2) | out of bounds",
        [row::<f64>("f64")?, row::<f32>("f32")?, row::<Fix>("fixed")?],
    );
    Ok(())
}
