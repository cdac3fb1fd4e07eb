//! The papers' module by forward Euler, step for step.
//!
//! A tick senses, gates, then steps. Contact of the previous angle (eq. 11, the
//! sensor's word, H50, eq. 9) sets z and g (eq. 10, 12–14); then ψ, θ and θ̇
//! move together, every right-hand side taken at the state before the step.
//! No noise (σ_η = 0). θ and θ̇ start at 0, z at 0, g at nominal, H50 at rest.

use super::butterworth::Lowpass;
use super::{
    CONTACT_CUTOFF_HZ, Gate, Obstacle, PSI_LIMIT, Row, Settings, muscle_acceleration,
    oscillator_rate, to_degrees,
};

#[derive(Clone, Debug)]
struct Whisker {
    theta: f64,
    rate: f64,
    nominal: f64,
    g: f64,
    lowpass: Lowpass,
}

/// A module of two sides, between ticks.
#[derive(Clone, Debug)]
pub(crate) struct Module {
    settings: Settings,
    ticks: u64,
    psi: [[f64; 2]; 2],
    z: [f64; 2],
    whiskers: [Vec<Whisker>; 2],
}

impl Module {
    pub(crate) fn new(settings: &Settings) -> Self {
        let whiskers = settings.gains.clone().map(|gains| {
            gains
                .into_iter()
                .map(|nominal| Whisker {
                    theta: 0.0,
                    rate: 0.0,
                    nominal,
                    g: nominal,
                    lowpass: Lowpass::new(CONTACT_CUTOFF_HZ, settings.tick_hz),
                })
                .collect()
        });
        Self {
            settings: settings.clone(),
            ticks: 0,
            psi: settings.start,
            z: [0.0; 2],
            whiskers,
        }
    }

    pub(crate) fn psi(&self) -> [[f64; 2]; 2] {
        self.psi
    }

    /// Advances by one tick and returns its row. A side without whiskers shows
    /// θ' = 50 degrees, g = 0 and no contact.
    pub(crate) fn tick(&mut self) -> Row {
        let contact = [self.sense(0), self.sense(1)];
        self.gate(contact);
        self.step();
        self.ticks += 1;
        let first = |of: fn(&Whisker) -> f64| {
            [0, 1].map(|side: usize| self.whiskers[side].first().map_or(0.0, of))
        };
        Row {
            t_s: self.ticks as f64 / self.settings.tick_hz,
            theta_deg: first(|whisker| whisker.theta).map(to_degrees),
            z: self.z,
            g: first(|whisker| whisker.g),
            contact,
        }
    }

    /// π of a side (eq. 9): the largest |H50(x)| of its whiskers. The y axis is
    /// zero and takes no part.
    fn sense(&mut self, side: usize) -> f64 {
        let mut contact = 0.0_f64;
        for whisker in &mut self.whiskers[side] {
            let mut x = match self.settings.obstacle {
                Some(obstacle) => deflection(&obstacle, side, to_degrees(whisker.theta)),
                None => 0.0,
            };
            if self.settings.quantise {
                x = through_sensor_word(x);
            }
            contact = contact.max(whisker.lowpass.step(x).abs());
        }
        contact
    }

    /// z by eq. 10 and g by eq. 12 to 14.
    fn gate(&mut self, contact: [f64; 2]) {
        let tick = self.settings.tick_s();
        if let Some(Gate { gain, tau_s }) = self.settings.rcp {
            for (z, pi) in self.z.iter_mut().zip(contact) {
                *z = ((1.0 - tick / tau_s) * *z).max(gain * pi).clamp(0.0, 1.0);
            }
        }
        let Some(Gate { gain, tau_s }) = self.settings.cia else {
            return;
        };
        let excitation = gain * contact[0].max(contact[1]);
        let reading = self.settings.reading;
        for whisker in self.whiskers.iter_mut().flatten() {
            let decayed = if reading.g_decay_misprint {
                whisker.g + tick / (tau_s * (1.0 - whisker.g))
            } else {
                whisker.g + tick / tau_s * (whisker.nominal - whisker.g)
            };
            let excited = if reading.cia_misprint {
                excitation
            } else {
                whisker.nominal + excitation
            };
            whisker.g = decayed.max(excited).clamp(0.0, 2.0);
        }
    }

    /// Oscillators (eq. 2 to 4) and muscles (eq. 6 to 8), both from the state
    /// before the step.
    fn step(&mut self) {
        let tick = self.settings.tick_s();
        let mass = self.settings.mass();
        let rate = oscillator_rate(&self.settings, self.psi);
        for (side, whiskers) in self.whiskers.iter_mut().enumerate() {
            for w in whiskers {
                let psi_1 = self.psi[side][0];
                let acceleration =
                    muscle_acceleration(mass, psi_1, self.z[side], w.g, w.theta, w.rate);
                w.theta += tick * w.rate;
                w.rate += tick * acceleration;
            }
        }
        for (psi, rate) in self.psi.iter_mut().flatten().zip(rate.iter().flatten()) {
            *psi = (*psi + tick * rate).clamp(-PSI_LIMIT, PSI_LIMIT);
        }
    }
}

/// x of a whisker at θ' (eq. 11): ⟨σ_x max(0, θ' − θ'_lim)⟩ on \[−1, 1\].
fn deflection(obstacle: &Obstacle, side: usize, theta_deg: f64) -> f64 {
    let beyond = (theta_deg - obstacle.at_deg[side]).max(0.0);
    (obstacle.stiffness * beyond).clamp(-1.0, 1.0)
}

/// The nearest of the sensor's 14-bit words to `x` in \[−1, 1\], as deflection
/// again: (code − 8192)/8191, halves rounded away from zero.
fn through_sensor_word(x: f64) -> f64 {
    let code = 8192.0 + (8191.0 * x).round();
    (code - 8192.0) / 8191.0
}

pub(crate) fn run(settings: &Settings, duration_s: f64) -> Vec<Row> {
    let ticks = (duration_s * settings.tick_hz).round() as usize;
    let mut module = Module::new(settings);
    (0..ticks).map(|_| module.tick()).collect()
}
