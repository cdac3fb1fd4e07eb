//! A three-phase brushless motor in six steps, commutated from Hall sensors.
//!
//! For a power stage like ST's L6230: per phase an input IN (high connects the phase to the supply,
//! low to ground) and an enable EN (low floats it). The stage itself must keep its two switches
//! from conducting together and must tolerate a duty of 100 %, as a stage with a charge pump does.
//!
//! Of the driven pair the high phase carries the PWM and the low phase is tied
//! to ground, so the current circulates through the low switches between
//! pulses and a zero duty brakes; `off` floats all phases and coasts.

use embedded_hal::digital::{InputPin, OutputPin, PinState};
use embedded_hal::pwm::SetDutyCycle;

use super::commutation::{Pair, Phase, Role, Sector};
use super::{Duty, Fault, HallTracker, MotorDriver, StallConfig, StallGuard, set_pwm, zero_pwm};

/// Settings of a [`SixStep`] driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SixStepConfig {
    /// Ticks in succession with skipped Hall sectors that are a fault; see
    /// [`HallTracker`] for the speed this allows.
    pub skip_limit: u8,
    /// When the motor counts as stalled.
    pub stall: StallConfig,
}

impl SixStepConfig {
    /// For the BIOTACT motor (Faulhaber 1307BH) at 2000 Hz. One pole pair is assumed, not verified.
    pub const DEFAULT: Self = Self {
        skip_limit: 4,
        stall: StallConfig::DEFAULT,
    };
}

/// Six-step driver over the three PWM inputs IN1 to IN3 of the power stage, its enables EN1 to
/// EN3 (low floats a phase) and three Hall inputs; phase k has its axis at 120° (k − 1), and sensor
/// k is high while the rotor's magnet is within 90° of it.
///
/// Each [`drive`](MotorDriver::drive) reads the sensors and sets the step. The
/// lead of 60° to 120° holds at the tick; until the next one it falls by the
/// angle turned, so torque drops as the speed nears one sector per tick.
///
/// When the step changes, phases that change role are floated first, then their inputs change, then
/// the enables rise: no intermediate pattern drives. A duty of zero keeps the last direction.
#[derive(Debug)]
pub struct SixStep<PWM, EN, HALL> {
    pwms: [PWM; 3],
    enables: [EN; 3],
    halls: [HALL; 3],
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

#[derive(Debug, Clone, Copy)]
enum SixStepState {
    /// All phases float.
    Off,
    /// A pair of phases is driven.
    Driving {
        pair: Pair,
        /// The duty of its high phase.
        duty: Duty,
    },
    /// All phases float until the fault, the first that was found, is cleared.
    Faulted { fault: Fault },
}

impl<PWM: SetDutyCycle, EN: OutputPin, HALL: InputPin> SixStep<PWM, EN, HALL> {
    /// Takes the pins and switches off. If that fails, the first
    /// [`drive`](MotorDriver::drive) returns the fault.
    pub fn new(pwms: [PWM; 3], enables: [EN; 3], halls: [HALL; 3], config: SixStepConfig) -> Self {
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

    /// For PWMs whose duty takes effect only at their next period. Where a phase would go from high
    /// straight to low (a reversal, or a skipped sector) its old duty would act in the new step for
    /// up to a period; the motor coasts for one tick instead. The period must not exceed the tick.
    #[must_use]
    pub fn with_buffered_pwm(mut self) -> Self {
        self.buffered = true;
        self
    }

    /// Hall sectors passed since the start, forward less backward, wrapping.
    #[inline]
    pub const fn counts(&self) -> i32 {
        self.tracker.counts()
    }

    /// The fault that holds the motor off.
    pub const fn fault(&self) -> Option<Fault> {
        match self.state {
            SixStepState::Faulted { fault } => Some(fault),
            SixStepState::Off | SixStepState::Driving { .. } => None,
        }
    }

    /// Its PWMs.
    pub const fn pwms(&self) -> &[PWM; 3] {
        &self.pwms
    }

    #[inline]
    fn enable(&mut self, phase: Phase, on: bool) -> Result<(), Fault> {
        let enable = phase.of(&mut self.enables);
        let state = PinState::from(on);
        enable.set_state(state).map_err(|_| Fault::Pin)
    }

    /// Takes in the Hall code. Sensors may be read one after another: only one changes at a time,
    /// so the code is that of before or after the change.
    #[inline]
    fn track(&mut self) -> Result<Sector, Fault> {
        let mut code = 0;
        for (bit, hall) in self.halls.iter_mut().enumerate() {
            let is_high = hall.is_high().map_err(|_| Fault::Pin)?;
            code |= u8::from(is_high) << bit;
        }
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
                set_pwm(pair.high.of(&mut self.pwms), duty)?;
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
                self.enable(phase, false)?;
            }
        }
        for phase in Phase::ALL.into_iter().filter(|&phase| changes(phase)) {
            // The high phase gets its duty at once after this.
            if phase != pair.high {
                zero_pwm(phase.of(&mut self.pwms))?;
            }
        }
        set_pwm(pair.high.of(&mut self.pwms), duty)?;
        for phase in [pair.low, pair.high] {
            if changes(phase) {
                self.enable(phase, true)?;
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
            result = result.and(self.enable(phase, false));
        }
        for phase in Phase::ALL {
            result = result.and(zero_pwm(phase.of(&mut self.pwms)));
        }
        result
    }
}

impl<PWM: SetDutyCycle, EN: OutputPin, HALL: InputPin> MotorDriver for SixStep<PWM, EN, HALL> {
    /// As in the trait; the count goes on while a fault stands, as far as the sensors allow.
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
