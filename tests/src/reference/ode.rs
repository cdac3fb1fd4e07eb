//! The whisking equations as what they are, ordinary differential equations,
//! solved to about 1e-11 degrees: what an integrator's error is measured
//! against.
//!
//! Gragg's modified midpoint rule with 2, 4, … 12 steps over a stride,
//! extrapolated to stride zero (Gragg–Bulirsch–Stoer, order 12). The stride is
//! fixed: a tick, divided until it is at most a hundredth of a whisk.

use super::{Settings, muscle_acceleration, oscillator_rate, to_degrees};

/// ψ left, ψ right, then (θ, θ̇) left, (θ, θ̇) right.
type State = [[f64; 2]; 4];

/// Columns of the extrapolation; the order is twice this.
const COLUMNS: usize = 6;
/// Strides a whisk, at least.
const STRIDES_PER_WHISK: f64 = 100.0;

/// θ' in degrees of the first whisker of the left and right side after each of
/// `ticks` ticks, in free air at constant nominal gain (z = 0).
///
/// Uses `tick_hz`, `frequency_hz`, `gains`, `start`, `coupling` and
/// `reading.mass_misprint` of the settings; the others have no meaning here. ψ
/// is not limited: from a start within the limit the exact solution never
/// leaves it. θ and θ̇ start at 0.
pub fn theta_prime(settings: &Settings, ticks: usize) -> Vec<[f64; 2]> {
    trajectory(settings, ticks)
        .into_iter()
        .map(|state| [to_degrees(state[2][0]), to_degrees(state[3][0])])
        .collect()
}

/// ψ of the left and right side after each of `ticks` ticks; see
/// [`theta_prime`].
pub fn psi(settings: &Settings, ticks: usize) -> Vec<[[f64; 2]; 2]> {
    trajectory(settings, ticks)
        .into_iter()
        .map(|[left, right, ..]| [left, right])
        .collect()
}

fn trajectory(settings: &Settings, ticks: usize) -> Vec<State> {
    let per_tick = STRIDES_PER_WHISK * settings.frequency_hz / settings.tick_hz;
    let strides = per_tick.ceil().max(1.0);
    let stride_s = settings.tick_s() / strides;
    let mut state = [settings.start[0], settings.start[1], [0.0; 2], [0.0; 2]];
    (0..ticks)
        .map(|_| {
            for _ in 0..strides as usize {
                state = extrapolated(settings, state, stride_s);
            }
            state
        })
        .collect()
}

/// All right-hand sides (eq. 2 to 8 with z = 0).
fn rate(settings: &Settings, state: State) -> State {
    let [psi_left, psi_right, left, right] = state;
    let [d_left, d_right] = oscillator_rate(settings, [psi_left, psi_right]);
    let muscle = |side: usize, psi_1: f64, [theta, rate]: [f64; 2]| {
        let g = settings.gains[side].first().copied().unwrap_or(0.0);
        let acceleration = muscle_acceleration(settings.mass(), psi_1, 0.0, g, theta, rate);
        [rate, acceleration]
    };
    [
        d_left,
        d_right,
        muscle(0, psi_left[0], left),
        muscle(1, psi_right[0], right),
    ]
}

/// base + factor · slope, element by element.
fn along(base: State, factor: f64, slope: State) -> State {
    let mut sum = base;
    for (to, by) in sum.iter_mut().flatten().zip(slope.iter().flatten()) {
        *to += factor * by;
    }
    sum
}

/// The modified midpoint rule over `stride_s` in `steps` (even) steps; its
/// error has even powers of the step only.
fn midpoint(settings: &Settings, start: State, stride_s: f64, steps: u32) -> State {
    let h = stride_s / f64::from(steps);
    let mut before = start;
    let mut now = along(start, h, rate(settings, start));
    for _ in 1..steps {
        let next = along(before, 2.0 * h, rate(settings, now));
        before = now;
        now = next;
    }
    now
}

/// One stride: the midpoint rule at rising numbers of steps, extrapolated to
/// step zero by the Aitken–Neville scheme in h².
fn extrapolated(settings: &Settings, start: State, stride_s: f64) -> State {
    let mut table: Vec<State> = Vec::with_capacity(COLUMNS);
    let mut corner = start;
    for column in 0..COLUMNS {
        let steps = 2 * (column + 1);
        corner = midpoint(settings, start, stride_s, steps as u32);
        // `table` holds the diagonal of the row above, coarsest last.
        let mut diagonal = vec![corner];
        for (depth, above) in table.iter().enumerate() {
            let coarser = 2 * (column - depth);
            let ratio = steps as f64 / coarser as f64;
            let weight = 1.0 / (ratio * ratio - 1.0);
            let difference = along(corner, -1.0, *above);
            corner = along(corner, weight, difference);
            diagonal.push(corner);
        }
        table = diagonal;
    }
    corner
}
