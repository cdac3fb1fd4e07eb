//! A three-phase brushless motor in six steps, commutated from Hall sensors.
//!
//! For a power stage like ST's L6230: per phase an input IN (high connects the
//! phase to the supply, low to ground) and an enable EN (low floats it). The
//! stage itself must keep its two switches from conducting together and must
//! tolerate a duty of 100 %, as a stage with a charge pump does.
//!
//! Of the driven pair the high phase carries the PWM and the low phase is tied
//! to ground, so the current circulates through the low switches between
//! pulses and a zero duty brakes; `off` floats all phases and coasts.

use serde::{Deserialize, Serialize};

use super::{
    Duty, Fault, HallInputs, HallTracker, MotorDriver, Pair, Phase, PhaseEnables, PhasePwms, Role,
    Sector, StallConfig, StallGuard,
};

/// Settings of a [`SixStep`] driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SixStepConfig {
    /// Magnet pole pairs of the rotor: electrical turns per rotor turn. Used
    /// only to state the resolution.
    pub pole_pairs: u8,
    /// Ticks in succession with skipped Hall sectors that are a fault; see
    /// [`HallTracker`] for the speed this allows.
    pub skip_limit: u8,
    /// When the motor counts as stalled.
    pub stall: StallConfig,
}

impl SixStepConfig {
    /// For the BIOTACT motor (Faulhaber 1307BH) at 2000 Hz. One pole pair is
    /// assumed, not verified.
    pub const DEFAULT: Self = Self {
        pole_pairs: 1,
        skip_limit: 4,
        stall: StallConfig::DEFAULT,
    };

    /// Hall counts per rotor turn, `6 · pole_pairs`.
    pub const fn counts_per_turn(&self) -> u16 {
        6 * self.pole_pairs as u16
    }

    /// Degrees of whisker per Hall count behind a gear of `gear_ratio` rotor
    /// turns per whisker turn: `360 / (6 · pole_pairs · gear_ratio)`, both
    /// factors being above zero.
    ///
    /// BIOTACT's 11:1 gear gives 66 counts a turn, 5.45°: coarse against a
    /// whisk of some tens of degrees. An encoder on the rotor is better.
    pub fn degrees_per_count(&self, gear_ratio: f32) -> f32 {
        360.0 / (f32::from(self.counts_per_turn()) * gear_ratio)
    }
}

impl Default for SixStepConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Six-step driver over three PWM inputs, three enables and three Hall inputs,
/// each given as a tuple; phases and signs as in [`COMMUTATION`].
///
/// Each [`drive`](MotorDriver::drive) reads the sensors and sets the step. The
/// lead of 60° to 120° holds at the tick; until the next one it falls by the
/// angle turned, so torque drops as the speed nears one sector per tick.
///
/// When the step changes, phases that change role are floated first, then their
/// inputs change, then the enables rise: no intermediate pattern drives. A
/// duty of zero keeps the last direction.
///
/// [`COMMUTATION`]: super::COMMUTATION
#[derive(Debug)]
pub struct SixStep<PWM, EN, HALL> {
    pwms: PWM,
    enables: EN,
    halls: HALL,
    tracker: HallTracker,
    stall: StallConfig,
    guard: StallGuard,
    /// Count at which the rotor was last seen to have moved.
    moved_at: i32,
    /// Direction of the last duty other than zero.
    forward: bool,
    buffered: bool,
    state: SixStepState,
}

/// What a [`SixStep`] driver is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SixStepState {
    /// All phases float.
    Off,
    /// A pair of phases is driven.
    Driving {
        /// The pair.
        pair: Pair,
        /// The duty of its high phase.
        duty: Duty,
    },
    /// All phases float until the fault is cleared.
    Faulted {
        /// The first fault that was found.
        fault: Fault,
    },
}

impl<PWM: PhasePwms, EN: PhaseEnables, HALL: HallInputs> SixStep<PWM, EN, HALL> {
    /// Takes the pins and switches off. If that fails, the first
    /// [`drive`](MotorDriver::drive) returns the fault.
    pub fn new(pwms: PWM, enables: EN, halls: HALL, config: SixStepConfig) -> Self {
        let mut motor = Self {
            pwms,
            enables,
            halls,
            tracker: HallTracker::new(config.skip_limit),
            stall: config.stall,
            guard: StallGuard::default(),
            moved_at: 0,
            forward: true,
            buffered: false,
            state: SixStepState::Off,
        };
        motor.off();
        motor
    }

    /// For PWMs whose duty takes effect only at their next period. Where a
    /// phase would go from high straight to low (a reversal, or a skipped
    /// sector) its old duty would act in the new step for up to a period; the
    /// motor coasts for one tick instead. The period must not exceed the tick.
    #[must_use]
    pub fn with_buffered_pwm(mut self) -> Self {
        self.buffered = true;
        self
    }

    /// Hall sectors passed since the start, forward less backward, wrapping;
    /// [`SixStepConfig::degrees_per_count`] makes it an angle.
    #[inline]
    pub const fn counts(&self) -> i32 {
        self.tracker.counts()
    }

    /// The sector last seen.
    pub const fn sector(&self) -> Option<Sector> {
        self.tracker.sector()
    }

    /// What it is doing.
    pub const fn state(&self) -> SixStepState {
        self.state
    }

    /// Whether the motor moves when it is driven.
    pub const fn guard(&self) -> StallGuard {
        self.guard
    }

    /// The fault that holds the motor off.
    pub const fn fault(&self) -> Option<Fault> {
        match self.state {
            SixStepState::Faulted { fault } => Some(fault),
            SixStepState::Off | SixStepState::Driving { .. } => None,
        }
    }

    /// Reads the sensors without touching the outputs, so that the count goes
    /// on while the motor is off. Once per tick, instead of
    /// [`drive`](MotorDriver::drive).
    ///
    /// # Errors
    ///
    /// The fault that holds the motor off: an earlier one, or one just found.
    pub fn observe(&mut self) -> Result<(), Fault> {
        let seen = self.track();
        if let Some(fault) = self.fault() {
            return Err(fault);
        }
        match seen {
            Ok(_) => Ok(()),
            Err(fault) => {
                self.fail(fault);
                Err(fault)
            }
        }
    }

    /// Its PWMs.
    pub const fn pwms(&self) -> &PWM {
        &self.pwms
    }

    /// Switches off and gives the pins back.
    pub fn release(mut self) -> (PWM, EN, HALL) {
        self.off();
        (self.pwms, self.enables, self.halls)
    }

    #[inline]
    fn track(&mut self) -> Result<Sector, Fault> {
        let code = self.halls.code()?;
        self.tracker.update(code)
    }

    /// Whether the rotor has left the place where it was last seen to move, by two
    /// counts at least: a blocked rotor on a Hall edge flickers by one.
    #[inline]
    fn moved(&mut self) -> bool {
        let away = self.counts().wrapping_sub(self.moved_at).unsigned_abs() > 1;
        if away {
            self.moved_at = self.counts();
        }
        away
    }

    #[inline]
    fn step(&mut self, duty: Duty) -> Result<(), Fault> {
        let sector = self.track()?;
        let moved = self.moved();
        if self.guard.update(self.stall, duty, moved) {
            return Err(Fault::Stall);
        }
        if duty != Duty::ZERO {
            self.forward = duty.is_forward();
        }
        self.apply(sector.pair(self.forward), duty)
    }

    #[inline]
    fn apply(&mut self, pair: Pair, duty: Duty) -> Result<(), Fault> {
        match self.state {
            SixStepState::Driving { pair: old, .. } if old == pair => {
                self.pwms.set(pair.high, duty)?;
            }
            SixStepState::Driving {
                pair: old,
                duty: last,
            } => {
                if self.buffered && last != Duty::ZERO && old.high == pair.low {
                    self.state = SixStepState::Off;
                    return self.coast();
                }
                self.change(Some(old), pair, duty)?;
            }
            SixStepState::Off | SixStepState::Faulted { .. } => self.change(None, pair, duty)?,
        }
        self.state = SixStepState::Driving { pair, duty };
        Ok(())
    }

    fn change(&mut self, old: Option<Pair>, pair: Pair, duty: Duty) -> Result<(), Fault> {
        let changes = |phase| old.is_none_or(|old| old.role(phase) != pair.role(phase));
        for phase in Phase::ALL.into_iter().filter(|&phase| changes(phase)) {
            if old.is_none_or(|old| old.role(phase) != Role::Float) {
                self.enables.enable(phase, false)?;
            }
        }
        for phase in Phase::ALL.into_iter().filter(|&phase| changes(phase)) {
            // The high phase gets its duty at once after this.
            if phase != pair.high {
                self.pwms.zero(phase)?;
            }
        }
        self.pwms.set(pair.high, duty)?;
        for phase in [pair.low, pair.high] {
            if changes(phase) {
                self.enables.enable(phase, true)?;
            }
        }
        Ok(())
    }

    /// Switches off and holds it there.
    fn fail(&mut self, fault: Fault) {
        self.state = SixStepState::Faulted { fault };
        self.off();
    }

    /// Floats all phases, then takes all inputs low, going on after an error;
    /// the first is returned.
    fn coast(&mut self) -> Result<(), Fault> {
        let mut result = Ok(());
        for phase in Phase::ALL {
            result = result.and(self.enables.enable(phase, false));
        }
        for phase in Phase::ALL {
            result = result.and(self.pwms.zero(phase));
        }
        result
    }
}

impl<PWM: PhasePwms, EN: PhaseEnables, HALL: HallInputs> MotorDriver for SixStep<PWM, EN, HALL> {
    /// As in the trait; the count goes on while a fault stands, as far as the
    /// sensors allow.
    #[inline]
    fn drive(&mut self, duty: Duty) -> Result<(), Fault> {
        if let SixStepState::Faulted { fault } = self.state {
            self.off();
            // The first fault stands, whatever the sensors say now.
            let _ = self.track();
            return Err(fault);
        }
        self.step(duty).inspect_err(|&fault| self.fail(fault))
    }

    fn off(&mut self) {
        let done = self.coast();
        self.guard = StallGuard::default();
        if self.fault().is_none() {
            self.state = match done {
                Ok(()) => SixStepState::Off,
                Err(fault) => SixStepState::Faulted { fault },
            };
        }
    }

    fn clear(&mut self) {
        if self.fault().is_some() {
            self.state = SixStepState::Off;
        }
        // The stall guard was reset when the fault switched the motor off.
        self.tracker.forget_skips();
    }
}
