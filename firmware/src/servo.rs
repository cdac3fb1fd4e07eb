//! The servo of one whisker: a motor that follows a setpoint, and what it does about faults.

mod failing;
mod finding;
mod leaps;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};
use whisking::motor::{
    self, Duty, GuardConfig, Guards, Heat, Homing, HomingConfig, MotorDriver, Moved,
};
use whisking::{Real, Voted, pd};
use wire::{Flags, q13};

use crate::config::Part;
use crate::io::AngleInput;
use crate::{Event, Place};
use leaps::Leaps;

/// Constants of a servo.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct ServoConfig<R: Real> {
    /// Position control.
    pub pd: pd::Config<R>,
    /// What is done after a fault.
    pub retry: Retry,
    /// What is a fault of its motion.
    pub guards: GuardConfig<R>,
    /// Soft start: by how much a tick brings the setpoint from where the whisker is nearer to
    /// where it should be, protraction, above 0.
    pub approach: R,
    /// How it finds where it is; `None`: it is at rest, θ = 0, when it is armed.
    pub homing: Option<HomingConfig>,
}

impl<R: Real> ServoConfig<R> {
    #[inline]
    fn homing(&self) -> Option<&HomingConfig> {
        self.homing.as_ref().filter(|_| Part::Homing.is_built())
    }
}

/// A motor that was given up was cleared, and given up again, less than [`Retry::window`] ago.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the motor has had too many faults")]
pub struct TooManyFaults;

/// What is done after a fault of a motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Retry {
    /// Ticks that it rests before it is tried again; 0 is taken as 1.
    pub rest: u16,
    /// Ticks within which [`FAULTS`] faults are one too many.
    pub window: u32,
}

/// So many faults within [`Retry::window`], and the motor is given up.
pub const FAULTS: usize = 3;

/// So many tests of its motion in succession that a motor fails, and it is given up: a whisker
/// that something holds and an encoder that stands still look alike, and a test is gentle.
pub const HELD: u8 = 6;

/// What a servo is doing.
// With a tag of its own, by which the emulator reads each variant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(u8)]
pub enum ServoState<R> {
    /// The motor is off: before the first tick, while it is not armed or the whisker's
    /// sensor has a fault, and where any fault [stops all](crate::MotionConfig::stops_all).
    Off,
    /// It is driven gently to its retracted stop, to find out where it is.
    Homing(Homing),
    /// It follows the setpoint.
    Running {
        /// The position control with its terms.
        pd: pd::State<R>,
        /// Whether it moves as it is driven.
        guards: Guards<R>,
        /// By how much the setpoint is still behind, protraction.
        behind: R,
        /// Another setpoint was commanded: one that is behind goes there from where it is.
        has_new_aim: bool,
    },
    /// The motor is off after a fault.
    Resting {
        /// Ticks left until it is tried again.
        left: u16,
    },
    /// The motor is off after too many faults, until [`Servo::clear`].
    GivenUp,
}

/// What the last tick has done with a motor, as a [`TickRecord`](wire::TickRecord) has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MotorRecord {
    /// Where the whisker should be: protraction, Q13.
    pub setpoint: i16,
    /// Where it is: protraction, Q13.
    pub measured: i16,
    /// What drives it, Q15.
    pub duty: i16,
    /// What it is doing, and [`Flags::ARMED`].
    pub flags: Flags,
}

/// The motor of one whisker, its angle input and its controller.
#[derive(Debug)]
pub struct Servo<R, M, A> {
    motor: M,
    angle: A,
    /// Counts at rest, θ = 0. Like the setpoint it is set once and never computed again.
    home: Voted<i32>,
    counts: i32,
    /// Whether home was found, where it is to be, since the motor was off.
    is_homed: bool,
    /// Whether home was found at all, and not elsewhere since.
    is_known: bool,
    /// Ticks of following its setpoint since home was found.
    since_home: u32,
    /// Ticks for which it has touched nothing.
    calm: u16,
    /// Whether it was armed since the start: rest is where the whisker was then.
    has_rest: bool,
    /// Takes the place of the pattern generator's θ.
    setpoint: Voted<Option<R>>,
    state: ServoState<R>,
    heat: Heat,
    /// Ticks for which each of the last faults still counts.
    windows: [u32; FAULTS - 1],
    /// Tests of its motion that it has failed since it moved last.
    held: u8,
    /// Ticks until a motor that was given up may be cleared once more.
    until_clear: u32,
    leaps: Leaps,
}

impl<R: Real, M: MotorDriver, A: AngleInput> Servo<R, M, A> {
    /// A motor that is off, its whisker at rest (θ = 0) where the angle input now is.
    pub fn new(mut motor: M, mut angle: A) -> Self {
        motor.off();
        let home = angle.counts();
        Self {
            motor,
            angle,
            home: Voted::new(home),
            counts: home,
            is_homed: false,
            is_known: false,
            since_home: 0,
            calm: 0,
            has_rest: false,
            setpoint: Voted::new(None),
            state: ServoState::Off,
            heat: Heat::default(),
            windows: [0; FAULTS - 1],
            held: 0,
            until_clear: 0,
            leaps: Leaps::default(),
        }
    }

    #[inline]
    pub(crate) const fn running_at(&self) -> Option<i32> {
        match self.state {
            ServoState::Running { .. } => Some(self.counts),
            _ => None,
        }
    }

    #[inline]
    pub(crate) fn is_whisking(&self) -> bool {
        matches!(self.state, ServoState::Running { .. }) && self.setpoint().is_none()
    }

    /// What drives it.
    pub const fn motor(&self) -> &M {
        &self.motor
    }

    /// What it is doing.
    pub const fn state(&self) -> &ServoState<R> {
        &self.state
    }

    /// Whether the motor rests after a fault, or was given up.
    #[inline]
    pub const fn rests(&self) -> bool {
        matches!(self.state, ServoState::Resting { .. } | ServoState::GivenUp)
    }

    /// Whether nothing that its whisker feels is of use: it rests, or is being homed.
    #[inline]
    pub const fn is_inhibited(&self) -> bool {
        self.rests() || matches!(self.state, ServoState::Homing(_))
    }

    /// Whoever arms it first says that the whisker is at rest, θ = 0, now, unless it is homed.
    /// After that the encoder counts on, whether the motor is off or not, and arming it moves rest
    /// no more, but to where it is found. Faults are neither forgotten nor ended.
    pub fn arm(&mut self) {
        if let ServoState::Off = self.state {
            self.is_homed = false;
        }
        if !self.has_rest {
            self.has_rest = true;
            self.home = Voted::new(self.counts);
        }
    }

    /// Runs a motor that rests or was given up again. Its faults count on, so that the next one
    /// may give it up; where it was given up, this can be done once within [`Retry::window`].
    ///
    /// # Errors
    /// [`TooManyFaults`] where it was done within it.
    pub fn clear(&mut self) -> Result<(), TooManyFaults> {
        if let ServoState::GivenUp = self.state {
            if self.until_clear > 0 {
                return Err(TooManyFaults);
            }
            // Limited to the window as it ages.
            self.until_clear = u32::MAX;
        }
        if self.rests() {
            self.state = ServoState::Off;
            // It is tested first.
            self.held = self.held.min(HELD - 1);
            self.motor.clear();
        }
        Ok(())
    }

    /// The setpoint that was commanded, if any.
    #[allow(clippy::inline_always, reason = "a call costs more than it does")]
    #[inline(always)]
    pub fn setpoint(&self) -> Option<R> {
        self.setpoint.get().flatten()
    }

    /// In place of the pattern generator's; `None`: that again. A whisker that is still on its way
    /// to the last, slowly, goes to this one as slowly, from where it is.
    pub const fn set_setpoint(&mut self, setpoint: Option<R>) {
        self.setpoint = Voted::new(setpoint);
        if let ServoState::Running { has_new_aim, .. } = &mut self.state {
            *has_new_aim = true;
        }
    }

    /// What a tick towards protraction `theta` has done.
    #[inline]
    pub fn record(&self, config: &ServoConfig<R>, theta: R) -> MotorRecord {
        let (setpoint, measured, duty, flags) = match &self.state {
            ServoState::Running { pd, .. } => {
                let setpoint = pd.measured + pd.error;
                (setpoint, pd.measured, pd.duty(), Flags::RUNNING)
            }
            _ => self.record_without_pd(config, theta),
        };
        MotorRecord {
            setpoint: q13(setpoint.to_q24()),
            measured: q13(measured.to_q24()),
            duty: duty.q15(),
            flags,
        }
    }

    /// Setpoint, measured angle, duty and flags where no PD loop runs.
    // Apart, as records are of motors that run, and need fewer registers without this.
    #[cold]
    #[inline(never)]
    fn record_without_pd(&self, config: &ServoConfig<R>, theta: R) -> (R, R, Duty, Flags) {
        let measured = self.measured(config);
        let wanted = || config.pd.clamp(self.setpoint().unwrap_or(theta));
        match (&self.state, config.homing()) {
            (ServoState::Homing(homing), Some(how)) => {
                (measured, measured, homing.duty(how), Flags::HOMING)
            }
            (ServoState::Resting { .. } | ServoState::GivenUp, _) => {
                (wanted(), measured, Duty::ZERO, Flags::RESTING)
            }
            _ => (wanted(), measured, Duty::ZERO, Flags::NONE),
        }
    }

    fn measured(&self, config: &ServoConfig<R>) -> R {
        let home = self.home.get().unwrap_or(self.counts);
        config.pd.measured(self.counts.wrapping_sub(home))
    }

    /// Switches the motor off until the next tick; a rest goes on.
    fn off(&mut self) {
        self.motor.off();
        if let ServoState::Running { .. } | ServoState::Homing(_) = self.state {
            self.state = ServoState::Off;
        }
    }

    /// One tick towards protraction `setpoint`, unless another was commanded, where it `may_run`.
    // Apart: a tick in one piece runs out of registers.
    #[inline(never)]
    pub fn step(
        &mut self,
        config: &ServoConfig<R>,
        setpoint: R,
        may_run: bool,
        place: Place,
        events: &mut impl FnMut(Event),
    ) {
        let counts = self.angle.counts();
        let moved = counts.wrapping_sub(self.counts);
        self.counts = counts;
        if self.leaps.is_one(moved, config.guards.leap) {
            self.leap(config, place, events);
        }
        self.age(config.retry);

        let setpoint = config.pd.clamp(self.setpoint().unwrap_or(setpoint));
        let home = self.home.get();
        let at = counts.wrapping_sub(home.unwrap_or(counts));
        match self.state {
            ServoState::Running { .. } | ServoState::Off | ServoState::Homing(_) if !may_run => {
                self.off();
                self.cool(&config.guards);
                return;
            }
            ServoState::Off if config.homing().is_some() && !self.is_homed => {
                let known = home.filter(|_| self.is_known);
                self.state = ServoState::Homing(Homing::new(counts, known));
            }
            ServoState::Off => {
                let measured = config.pd.measured(at);
                // Where its range ends, homing leaves it on its way.
                let is_moving = self.is_homed && self.since_home == 0;
                let pd = config.pd.at_speed(if is_moving { moved } else { 0 });
                self.state = ServoState::Running {
                    guards: self.guards(&config.guards, pd.velocity),
                    pd,
                    behind: setpoint - measured,
                    has_new_aim: false,
                };
            }
            ServoState::Running { .. } | ServoState::Homing(_) => {}
            ServoState::Resting { left } => {
                self.rest(left.min(config.retry.rest.saturating_mul(2)), place, events);
                self.cool(&config.guards);
                return;
            }
            ServoState::GivenUp => {
                self.cool(&config.guards);
                return;
            }
        }
        let judged = if let ServoState::Running {
            pd,
            guards,
            behind,
            has_new_aim,
        } = &mut self.state
        {
            // Nearly always it has arrived.
            if *behind != R::ZERO {
                if core::mem::take(has_new_aim) {
                    *behind = setpoint - config.pd.measured(at);
                }
                *behind = if behind.is_within(R::TWO + R::TWO) {
                    toward_zero(*behind, config.approach)
                } else {
                    // So far from where it should be no whisker is: its bits were flipped.
                    R::ZERO
                };
            }
            config.pd.measure(pd, setpoint - *behind, at, moved);
            let wanted = (pd.p + pd.d).to_q24();
            let wanted = guards.test(&config.guards).unwrap_or(wanted);
            let duty = config.pd.command(pd, wanted);
            let seen = Moved {
                duty: pd.command,
                error: pd.error,
                velocity: pd.velocity,
                at,
                counts: moved,
            };
            if self.held > 0 && !guards.is_tested() {
                self.held = 0;
            }
            // Where rest is not known, no angle is within the travel.
            home.ok_or(motor::Fault::Travel)
                .and_then(|_| guards.check(&config.guards, seen))
                .map(|()| duty)
        } else {
            match self.find_home(config, moved).transpose() {
                Some(judged) => judged,
                None => return,
            }
        };
        let driven = judged.and_then(|duty| {
            self.heat.check(&config.guards, duty)?;
            self.motor.drive(duty)
        });
        if let Err(fault) = driven {
            self.fail(fault, config, place, events);
        }
    }

    /// Guards of a motor that begins to run: one that did not move is tested, each way in turn.
    fn guards(&self, config: &GuardConfig<R>, velocity: R) -> Guards<R> {
        if self.held == 0 {
            Guards::at_speed(velocity)
        } else {
            Guards::doubtful(config, self.held.is_multiple_of(2))
        }
    }

    fn cool(&mut self, guards: &GuardConfig<R>) {
        let _ = self.heat.check(guards, Duty::ZERO);
    }
}

#[inline]
fn toward_zero<R: Real>(value: R, step: R) -> R {
    if value > step {
        value - step
    } else if value < -step {
        value + step
    } else {
        R::ZERO
    }
}
