//! The independent truth: the papers' formulas in plain double precision,
//! written from the equations alone and sharing no code with the product.
//!
//! Glossary. *Whisk*: one protraction and retraction, T_W = 1/f_W. *ψ*: a
//! side's oscillator, in Cartesian form. *θ*: protraction of a whisker, at rest
//! 0, fully protracted about 1; *θ'* = 100 θ + 50 is the same in degrees. *π*:
//! contact of a side, 0 to 1. *z*: suppression of a side's drive (RCP). *g*:
//! excitability of a whisker (CIA). Sides are in the order left, right.
//!
//! Source of all equations: Sullivan et al. 2011 ("BIOTACT"), section III.

pub(crate) mod bayes;
pub(crate) mod butterworth;
pub(crate) mod claims;
pub(crate) mod euler;
pub(crate) mod recording;

/// Limit of |ψ| after each forward Euler step (text below BIOTACT eq. 2).
pub(crate) const PSI_LIMIT: f64 = 1.5;
/// Spring constant k of the muscle (BIOTACT eq. 7).
pub(crate) const SPRING: f64 = 1.0;
/// Cutoff of H50 in Hz (text below BIOTACT eq. 5).
pub(crate) const CONTACT_CUTOFF_HZ: f64 = 50.0;

/// What a module is and what it meets. [`Settings::papers`] has the values that
/// hold throughout BIOTACT; figures change single fields.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    pub(crate) tick_hz: f64,
    /// f_W.
    pub(crate) frequency_hz: f64,
    /// Nominal gain of every whisker of each side, 0 to 2.
    pub(crate) gains: [Vec<f64>; 2],
    /// ψ of each side before the first tick.
    pub(crate) start: [[f64; 2]; 2],
    /// Of the sides (eq. 4, τ11 = 2 T_W).
    pub(crate) coupling: bool,
    /// Eq. 10; `None` keeps z at 0.
    pub(crate) rcp: Option<Gate>,
    /// Eq. 12–14; `None` keeps g nominal.
    pub(crate) cia: Option<Gate>,
    pub(crate) obstacle: Option<Obstacle>,
    /// Whether contact passes through the sensor's 14-bit word.
    pub(crate) quantise: bool,
    pub(crate) reading: Reading,
}

/// A gate that contact opens and time closes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gate {
    /// σ: its value per unit of contact.
    pub(crate) gain: f64,
    /// τ of the return.
    pub(crate) tau_s: f64,
}

/// Obstacles beside the head (eq. 11).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Obstacle {
    /// θ'_lim of each side, in degrees.
    pub(crate) at_deg: [f64; 2],
    /// σ_x: deflection per degree beyond the obstacle.
    pub(crate) stiffness: f64,
}

/// Which reading of the misprinted equations to follow; all `false` is the one
/// that satisfies the paper's own claims.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reading {
    /// Eq. 7 as printed, m = f_W²/100, in place of m = T_W²/100.
    pub(crate) mass_misprint: bool,
    /// Eq. 12 as printed, ⟨max(g*, σ_g ζ)⟩, in place of
    /// ⟨max(g*, g_nominal + σ_g ζ)⟩.
    pub(crate) cia_misprint: bool,
    /// Eq. 13 as printed, g* = g + T/(τ_g (1 − g)), in place of
    /// g* = g + (T/τ_g)(g_nominal − g). Infinite at g = 1.
    pub(crate) g_decay_misprint: bool,
}

/// A row of a trace: time and θ' after a tick, and the z, g and π that it used. Pairs are left,
/// right; θ' and g are those of the first whisker of the side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Row {
    pub(crate) t_s: f64,
    pub(crate) theta_deg: [f64; 2],
    pub(crate) z: [f64; 2],
    pub(crate) g: [f64; 2],
    pub(crate) contact: [f64; 2],
}

impl Settings {
    /// The values that hold throughout BIOTACT: 2 kHz, 2 Hz, one whisker a side
    /// at gain 1, coupled, both sides started at ψ = \[1, 0\], in free air.
    pub(crate) fn papers() -> Self {
        Self {
            tick_hz: 2000.0,
            frequency_hz: 2.0,
            gains: [vec![1.0], vec![1.0]],
            start: [[1.0, 0.0]; 2],
            coupling: true,
            rcp: None,
            cia: None,
            obstacle: None,
            quantise: false,
            reading: Reading::default(),
        }
    }

    pub(crate) fn tick_s(&self) -> f64 {
        1.0 / self.tick_hz
    }

    pub(crate) fn whisk_s(&self) -> f64 {
        1.0 / self.frequency_hz
    }

    /// m of eq. 7.
    pub(crate) fn mass(&self) -> f64 {
        if self.reading.mass_misprint {
            self.frequency_hz * self.frequency_hz / 100.0
        } else {
            self.whisk_s() * self.whisk_s() / 100.0
        }
    }
}

/// dψ/dt of both sides: eq. 2 to 4 in Cartesian form without noise,
/// dψ = ((1 − r)/(τ_r r)) ψ + 2π f_W J ψ + coupling, τ_r = τ11 = 2 T_W.
///
/// The direction of ψ is undefined at r = 0, an unstable point; no radial
/// drive is applied there.
pub(crate) fn oscillator_rate(settings: &Settings, psi: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let tau = 2.0 * settings.whisk_s();
    let omega = std::f64::consts::TAU * settings.frequency_hz;
    [(0, 1), (1, 0)].map(|(own, other)| {
        let [p, q] = psi[own];
        let r = p.hypot(q);
        let radial = if r > 0.0 { (1.0 - r) / (tau * r) } else { 0.0 };
        let pull = if settings.coupling {
            (psi[other][0] - p) / tau
        } else {
            0.0
        };
        [radial * p - omega * q + pull, radial * q + omega * p]
    })
}

/// d²θ/dt² by eq. 6 to 8: m θ̈ = q W − k θ − ν θ̇ with W = (tanh(2 ψ_1) + 1)/2,
/// q = 1.45 (1 − z) g exp(−θ²), ν = 4 √(k m).
pub(crate) fn muscle_acceleration(
    mass: f64,
    psi_1: f64,
    z: f64,
    g: f64,
    theta: f64,
    rate: f64,
) -> f64 {
    let drive = f64::midpoint((2.0 * psi_1).tanh(), 1.0);
    let gain = 1.45 * (1.0 - z) * g * (-theta * theta).exp();
    let damping = 4.0 * (SPRING * mass).sqrt();
    (gain * drive - SPRING * theta - damping * rate) / mass
}

/// θ' in degrees: 100 θ + 50 (text below BIOTACT eq. 8).
pub(crate) fn to_degrees(theta: f64) -> f64 {
    100.0 * theta + 50.0
}
