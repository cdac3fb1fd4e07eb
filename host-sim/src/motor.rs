//! A simulated micro motor with gear, whisker inertia and encoder, behind the
//! same embedded-hal traits as the board's.
//!
//! Glossary:
//!
//! - *stage*: what the pins switch. Brushed: an H-bridge with PWM and
//!   direction. Brushless: three half-bridges with enables, and three Halls, of one pole pair;
//! - *reflected*: seen through the gear of ratio G: inertia and torque of the
//!   whisker appear at the rotor divided by G² and G.
//!
//! # Model
//!
//! J dω/dt = k (u U − k ω)/R − b ω − τ_c sgn ω + τ_load/G, with the PWM averaged over its period
//! and the winding's inductance left out: its L/R, some tens of microseconds, is short against a
//! tick. An H-bridge at PWM zero brakes (the winding is shorted), a phase that is not enabled
//! carries no current (free-wheeling diodes are left out). The gear is stiff: its losses are in τ_c
//! and b. It may have play: then encoder and friction are on the motor's side, and the whisker is
//! free between its ends ([`play`]).
//!
//! At an end stop the rotor comes to rest within the step (no rebound).
//!
//! Between pin changes this is linear but for the sign of ω, and is solved
//! exactly ([`rotor`]), so any tick is stable. In the brushless stage the
//! torque also depends on the rotor angle, which is held over substeps.

mod flaws;
mod ideal;
mod pins;
mod play;
mod rotor;
mod settings;
mod stage;

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

use physics::BadSetting;
use rand_core::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

pub use flaws::EncoderFlaws;
use flaws::jitter;
pub use ideal::IdealMotor;
use pins::{End, Wires};
pub use pins::{SimEncoder, SimHall, SimPin, SimPwm, Wire};
use play::{Coupled, Play};
use rotor::Rotor;
pub use settings::MotorSettings;
pub(crate) use settings::PWM_COUNTS;
use stage::Stage;

/// What connects a brushed motor with its driver and its angle input.
#[derive(Debug, Clone)]
pub struct Brushed {
    /// Size of the duty.
    pub pwm: SimPwm,
    /// Its sign; high is protraction.
    pub dir: SimPin,
    /// Angle input.
    pub encoder: SimEncoder,
}

/// What connects a brushless motor with its driver and its angle input.
#[derive(Debug, Clone)]
pub struct Brushless {
    /// Inputs of phases 1 to 3.
    pub pwms: [SimPwm; 3],
    /// Enables of phases 1 to 3.
    pub enables: [SimPin; 3],
    /// Hall sensors 1 to 3.
    pub halls: [SimHall; 3],
    /// Angle input, if the driver's count of sectors is not used.
    pub encoder: SimEncoder,
}

/// The ends of a motor's wires that a board has.
#[derive(Debug, Clone)]
pub enum Pins {
    /// No wires: the motor is always at its setpoint, and only counts.
    Ideal(IdealMotor),
    /// An H-bridge and an encoder.
    Brushed(Brushed),
    /// Three half-bridges, three Hall sensors and an encoder.
    Brushless(Brushless),
}

/// A motor, its gear and its whisker.
#[derive(Debug)]
pub struct SimMotor {
    settings: MotorSettings,
    stage: Stage,
    rotor: Rotor,
    wires: Arc<Wires>,
    blocked: bool,
    /// Outer torque at the rotor, N·m.
    load_nm: f64,
    flaws: EncoderFlaws,
    random: Xoshiro256PlusPlus,
    /// Its supply now, and how many times its Coulomb friction it has.
    supply_v: f64,
    friction: f64,
    play: Play,
}

impl SimMotor {
    /// A brushed motor at rest with its pins.
    ///
    /// # Errors
    /// The first setting out of its range.
    pub fn brushed(settings: MotorSettings) -> Result<(Self, Brushed), BadSetting> {
        settings.check()?;
        let motor = Self::at_rest(settings, Stage::Brushed);
        let pins = motor.brushed_pins();
        Ok((motor, pins))
    }

    /// A three-phase motor at rest with its pins; phases and sensors as in
    /// [`whisking::motor::SixStep`].
    ///
    /// # Errors
    /// The first setting out of its range.
    pub fn brushless(settings: MotorSettings) -> Result<(Self, Brushless), BadSetting> {
        settings.check()?;
        let motor = Self::at_rest(settings, Stage::Brushless);
        let pins = motor.brushless_pins();
        Ok((motor, pins))
    }

    fn at_rest(settings: MotorSettings, stage: Stage) -> Self {
        let counts_per_rad = f64::from(settings.counts_per_rev) / core::f64::consts::TAU;
        Self {
            settings,
            stage,
            rotor: Rotor::default(),
            wires: Arc::new(Wires::new(counts_per_rad, settings.pwm_counts)),
            blocked: false,
            load_nm: 0.0,
            flaws: EncoderFlaws::NONE,
            random: Xoshiro256PlusPlus::seed_from_u64(0),
            supply_v: settings.supply_v,
            friction: 1.0,
            play: Play::default(),
        }
    }

    /// Starts again as newly made, without load and with every wire intact; pins that it had are
    /// no longer connected.
    pub(crate) fn restart(&mut self) {
        *self = Self::at_rest(self.settings, self.stage);
    }

    /// The ends of its wires that a board has.
    pub fn pins(&self) -> Pins {
        match self.stage {
            Stage::Brushed => Pins::Brushed(self.brushed_pins()),
            Stage::Brushless => Pins::Brushless(self.brushless_pins()),
        }
    }

    fn brushed_pins(&self) -> Brushed {
        Brushed {
            pwm: SimPwm(self.end(0)),
            dir: SimPin(self.end(0)),
            encoder: self.encoder(),
        }
    }

    fn brushless_pins(&self) -> Brushless {
        let ends = || [0, 1, 2].map(|i| self.end(i));
        Brushless {
            pwms: ends().map(SimPwm),
            enables: ends().map(SimPin),
            halls: ends().map(SimHall),
            encoder: self.encoder(),
        }
    }

    fn end(&self, i: usize) -> End {
        let wires = Arc::clone(&self.wires);
        End { wires, i }
    }

    fn encoder(&self) -> SimEncoder {
        SimEncoder(Arc::clone(&self.wires))
    }

    /// Lets `dt_s` seconds pass with the pins as they are; nothing happens
    /// unless it is positive and finite.
    pub fn advance(&mut self, dt_s: f64) {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return;
        }
        let jitter = jitter(&mut self.random, self.flaws.jitter);
        self.wires.jitter.store(jitter, Relaxed);
        if self.blocked {
            self.rotor.speed = 0.0;
            return;
        }
        let supply_v = self.supply_v;
        let s = &MotorSettings {
            supply_v,
            ..self.settings
        };
        let both = s.inertia_kg_m2();
        let stops = self.stops();
        let steps = self.stage.substeps(s, self.rotor.speed, dt_s);
        let step_s = dt_s / f64::from(steps);
        for _ in 0..steps {
            let winding = self.stage.winding(s, &self.wires, self.rotor.angle);
            let law = |load_nm: f64, inertia: f64| rotor::Law {
                push: (winding.drive_nm + load_nm) / inertia,
                rate: (winding.damping_nm_s + s.viscous_nm_s) / inertia,
                friction: self.friction * (s.coulomb_nm / both) * both / inertia,
            };
            let before = self.rotor;
            self.rotor.advance(&law(self.load_nm, both), step_s);
            if self.play.half > 0.0 {
                let coupled = Coupled {
                    load_nm: self.load_nm,
                    whisker_kg_m2: both - s.rotor_kg_m2,
                    both_kg_m2: both,
                };
                if self.play.is_pushed(coupled, before, self.rotor, step_s) {
                    self.play.speed = self.rotor.speed;
                } else {
                    self.rotor = before;
                    self.rotor.advance(&law(0.0, s.rotor_kg_m2), step_s);
                    self.play.coast(coupled, before, &mut self.rotor, step_s);
                }
            }
            self.rotor.stop_at(stops);
        }
        self.wires.set_angle(self.rotor.angle, self.flaws);
    }

    /// The rotor's angles at the end stops, rad.
    fn stops(&self) -> [f64; 2] {
        let stops_deg = self.settings.stops_deg;
        stops_deg.map(|stop| self.settings.rotor_angle(stop))
    }

    /// Turns the whisker by hand to θ′ = `angle_deg`, or to the stop before it, and holds it
    /// there for a moment; what is not finite does nothing.
    pub fn turn_to_deg(&mut self, angle_deg: f64) {
        if angle_deg.is_finite() {
            self.rotor.angle = self.settings.rotor_angle(angle_deg);
            self.rotor.speed = 0.0;
            self.rotor.stop_at(self.stops());
            self.wires.set_angle(self.rotor.angle, self.flaws);
        }
    }

    /// Holds the whisker where it is, or lets it go.
    pub fn block(&mut self, blocked: bool) {
        self.blocked = blocked;
    }

    /// An outer torque on the whisker from now on, N·m, positive towards
    /// protraction; what is not finite counts as 0.
    pub fn set_load_nm(&mut self, load_nm: f64) {
        let load_nm = if load_nm.is_finite() { load_nm } else { 0.0 };
        self.load_nm = load_nm / self.settings.gear;
    }

    /// Gives its encoder flaws from now on.
    pub fn set_encoder(&mut self, flaws: EncoderFlaws) {
        self.flaws = flaws;
    }

    /// Feeds it with so many volts from now on; `None`: with those of its settings. What its
    /// settings could not have does nothing.
    pub fn set_supply_v(&mut self, supply_v: Option<f64>) {
        let supply_v = supply_v.unwrap_or(self.settings.supply_v);
        if (0.0..=100.0).contains(&supply_v) {
            self.supply_v = supply_v;
        }
    }

    /// So many times its Coulomb friction from now on; what is negative or not finite does nothing.
    pub fn set_friction(&mut self, factor: f64) {
        if factor >= 0.0 && factor.is_finite() {
            self.friction = factor;
        }
    }

    /// A gear with so much play from now on, degrees of the whisker, in whose middle it is;
    /// what is negative or not finite does nothing.
    pub fn set_play_deg(&mut self, play_deg: f64) {
        if play_deg >= 0.0 && play_deg.is_finite() {
            self.play = Play::new(play_deg.to_radians() * self.settings.gear);
        }
    }

    /// Cuts a wire.
    pub fn cut(&mut self, wire: Wire) {
        self.wires.set_cut(wire, true);
    }

    /// Mends a wire.
    pub fn mend(&mut self, wire: Wire) {
        self.wires.set_cut(wire, false);
    }

    /// Whisker angle θ′, degrees; [`MotorSettings::rest_deg`] at the start.
    pub fn angle_deg(&self) -> f64 {
        let angle = self.rotor.angle + self.play.lag;
        self.settings.rest_deg + (angle / self.settings.gear).to_degrees()
    }

    /// Speed of the whisker, degrees a second.
    pub fn speed_deg_s(&self) -> f64 {
        (self.rotor.speed / self.settings.gear).to_degrees()
    }

    /// By how much the whisker is displaced from where the encoder says it is, degrees.
    pub fn displaced_deg(&self) -> f64 {
        (self.wires.missed.get() / self.settings.gear).to_degrees()
    }

    /// What its driver's pins ask for, 0 to 1: 0 is off, whatever the wires behind them do.
    pub fn effort(&self) -> f64 {
        self.stage.effort(&self.wires)
    }

    /// The duty at its driver's pins, -1 to 1, positive towards protraction, whatever the
    /// wires behind them do.
    pub fn duty(&self) -> f64 {
        self.stage
            .duty(&self.settings, &self.wires, self.rotor.angle)
    }

    /// The settings it was made with.
    pub const fn settings(&self) -> &MotorSettings {
        &self.settings
    }
}

#[cfg(test)]
mod six_step_tests;
#[cfg(test)]
mod tests;
