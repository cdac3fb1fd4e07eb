//! The axes along which the module is run, and how their product is thinned.

use whisking::{GateSettings, Integrator, Settings, oscillator::Psi};

/// f_W, Hz.
const FREQUENCIES_HZ: [f64; 8] = [0.05, 0.2, 1.0, 2.0, 5.0, 8.0, 12.5, 25.0];
/// 1/T, Hz.
pub(crate) const TICKS_HZ: [f64; 7] = [200.0, 500.0, 1_000.0, 2_000.0, 5_000.0, 10_000.0, 20_000.0];
/// σ_z: off, the papers', the largest.
const SIGMA_Z: [f64; 3] = [0.0, 0.7, 100.0];
/// σ_g: off, the papers', the largest.
const SIGMA_G: [f64; 3] = [0.0, 0.5, 100.0];
/// g_nominal of the whiskers, two a side: every level in every run.
pub(crate) const NOMINAL: [[f64; 2]; 2] = [[0.0, 2.0], [1.0, 2.0]];
const INTEGRATORS: [Integrator; 2] = [Integrator::Exact, Integrator::Euler];

/// τ of a gate: a share of the tick, or of the whisk.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Tau {
    Ticks(f64),
    Whisks(f64),
}

/// τ_z and τ_g.
const TAUS: [Tau; 7] = [
    Tau::Ticks(0.1),
    Tau::Ticks(1.0),
    Tau::Ticks(10.0),
    Tau::Whisks(0.25),
    Tau::Whisks(1.0),
    Tau::Whisks(100.0),
    Tau::Whisks(1_000.0),
];

/// Where the oscillators start, left and right.
const STARTS: [[Psi<f64>; 2]; 6] = [
    // The origin, where eq. 3 has no direction.
    [[0.0, 0.0], [0.0, 0.0]],
    // So near to it that squares underflow in some format or in all.
    [[1e-12, 0.0], [1e-30, 0.0]],
    [[-1e-16, 1e-20], [1e-14, -1e-24]],
    // Anti-phase, an unstable equilibrium.
    [[1.0, 0.0], [-1.0, 0.0]],
    // The corners.
    [[1.5, 1.5], [-1.5, -1.5]],
    [[1.5, -1.5], [-1.5, 1.5]],
];

/// What comes in as contact during abuse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Input {
    /// Full contact in every tick.
    Saturated,
    /// Nothing.
    Dead,
    /// A sensor that jumps from one end of its range to the other in every
    /// tick, through H50.
    Alternating,
    /// NaN; in fixed point, which has none, the lowest number.
    NotANumber,
    /// +∞, or the highest number.
    Highest,
    /// −∞, or the lowest number.
    Lowest,
    /// All of these in turns, other ones on each side.
    Mixed,
}

pub(crate) const INPUTS: [Input; 7] = [
    Input::Saturated,
    Input::Dead,
    Input::Alternating,
    Input::NotANumber,
    Input::Highest,
    Input::Lowest,
    Input::Mixed,
];

/// One run, as indices into the axes: f_W, tick, integrator, start, input, and
/// what is dealt: τ_z, τ_g, σ_z, σ_g.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case(pub(crate) [usize; 9]);

/// Levels of each axis.
const LEVELS: [usize; 9] = [
    FREQUENCIES_HZ.len(),
    TICKS_HZ.len(),
    INTEGRATORS.len(),
    STARTS.len(),
    INPUTS.len(),
    TAUS.len(),
    TAUS.len(),
    SIGMA_Z.len(),
    SIGMA_G.len(),
];

impl Case {
    pub(crate) fn frequency_hz(self) -> f64 {
        FREQUENCIES_HZ[self.0[0]]
    }

    pub(crate) fn tick_hz(self) -> f64 {
        TICKS_HZ[self.0[1]]
    }

    pub(crate) fn start(self) -> [Psi<f64>; 2] {
        STARTS[self.0[3]]
    }

    /// Whether the sides start together, as far as f64 can tell.
    pub(crate) fn is_in_phase(self) -> bool {
        self.0[3] < 3
    }

    pub(crate) fn input(self) -> Input {
        INPUTS[self.0[4]]
    }

    fn seconds(self, tau: Tau) -> f64 {
        match tau {
            Tau::Ticks(ticks) => ticks / self.tick_hz(),
            Tau::Whisks(whisks) => whisks / self.frequency_hz(),
        }
    }

    pub(crate) fn settings(self) -> Settings {
        let [.., tau_z, tau_g, sigma_z, sigma_g] = self.0;
        Settings {
            tick_hz: self.tick_hz(),
            frequency_hz: self.frequency_hz(),
            integrator: INTEGRATORS[self.0[2]],
            coupling: true,
            noise: 0.0,
            rcp: Some(GateSettings {
                gain: SIGMA_Z[sigma_z],
                tau_s: self.seconds(TAUS[tau_z]),
            }),
            cia: Some(GateSettings {
                gain: SIGMA_G[sigma_g],
                tau_s: self.seconds(TAUS[tau_g]),
            }),
        }
    }

    /// Whether its integrator can carry it. Forward Euler: the limit cycle stays
    /// below 1.5 (f_W T ≤ 0.0084375) and no gate is shorter than a tick.
    pub(crate) fn is_carried(self) -> bool {
        let Settings { rcp, cia, .. } = self.settings();
        let shortest = f64::min(rcp.unwrap().tau_s, cia.unwrap().tau_s) * self.tick_hz();
        INTEGRATORS[self.0[2]] == Integrator::Exact
            || (self.frequency_hz() / self.tick_hz() <= 0.008_437_5 && shortest >= 0.999)
    }

    /// Whether the formats must agree: it is carried, with ten ticks a whisk or
    /// more. (With eight, 25 Hz at 200 Hz, the differences that the muscles'
    /// multistep method takes outgrow the ±4 of fixed point and saturate.)
    pub(crate) fn is_alike_in_all_formats(self) -> bool {
        self.is_carried() && self.tick_hz() / self.frequency_hz() >= 10.0
    }
}

/// A generator of numbers for shuffles (Knuth's MMIX constants).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, n: usize) -> usize {
        let state = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = state.wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n as u64) as usize
    }
}

/// All places of a product of `levels`, last axis fastest.
fn product(levels: &[usize]) -> Vec<Vec<usize>> {
    levels.iter().fold(vec![Vec::new()], |places, &n| {
        let extended = |place: Vec<usize>| (0..n).map(move |i| [place.clone(), vec![i]].concat());
        places.into_iter().flat_map(extended).collect()
    })
}

/// Deals all places of a product of `levels`; shuffles them again when the pack is empty.
fn dealt(levels: &[usize], seed: u64) -> impl FnMut() -> Vec<usize> {
    let all = product(levels);
    let mut random = Random(seed);
    let mut pack = Vec::new();
    move || {
        if pack.is_empty() {
            pack.clone_from(&all);
            for i in (1..pack.len()).rev() {
                pack.swap(i, random.below(i + 1));
            }
        }
        pack.pop().unwrap_or_default()
    }
}

/// The full product of the first `full` axes, with levels of the others dealt to it, shuffled by
/// `seed`.
pub(crate) fn cases(full: usize, seed: u64) -> Vec<Case> {
    let mut deal = dealt(&LEVELS[full..], seed);
    let places = product(&LEVELS[..full]);
    let place = |full: Vec<usize>| [full, deal()].concat().try_into().unwrap();
    places.into_iter().map(place).map(Case).collect()
}
