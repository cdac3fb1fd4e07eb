//! The servo of one whisker: a motor with an angle input that follows a
//! setpoint, and what it does about faults.

use whisking::motor::{self, MotorDriver, StallConfig, StallGuard};
use whisking::{Real, pd};

use crate::io::AngleInput;
use crate::{Event, Place};

/// Constants of a servo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoConfig<R: Real> {
    /// Position control.
    pub pd: pd::Config<R>,
    /// Ticks a faulty motor rests before it is tried again; 0 is taken as 1.
    pub retry: u16,
    /// When a motor counts as stalled.
    pub stall: StallConfig,
}

/// What a servo is doing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ServoState<R> {
    /// The motor is off: before the first tick, while the whisker's sensor has a
    /// fault, and where any fault [stops all](crate::StopAll).
    Off,
    /// It follows the setpoint.
    Running {
        /// The position control with its terms.
        pd: pd::State<R>,
        /// How long the motor has been driven without moving.
        stall: StallGuard,
    },
    /// The motor is off after a fault.
    Resting {
        /// Ticks left until it is tried again.
        left: u16,
    },
}

/// The motor of one whisker, its angle input and its controller.
#[derive(Debug)]
pub struct Servo<R, M, A> {
    motor: M,
    angle: A,
    /// Counts at rest, θ = 0, and at the last tick.
    home: i32,
    counts: i32,
    /// Takes the place of the pattern generator's θ.
    setpoint: Option<R>,
    state: ServoState<R>,
}

impl<R: Real, M: MotorDriver, A: AngleInput> Servo<R, M, A> {
    /// A motor that is off, its whisker at rest (θ = 0) where the angle input now is.
    pub fn new(mut motor: M, mut angle: A) -> Self {
        motor.off();
        let home = angle.counts();
        Self {
            motor,
            angle,
            home,
            counts: home,
            setpoint: None,
            state: ServoState::Off,
        }
    }

    /// The hardware, for a simulation that looks at it.
    pub const fn parts_mut(&mut self) -> (&mut M, &mut A) {
        (&mut self.motor, &mut self.angle)
    }

    /// What it is doing.
    pub const fn state(&self) -> &ServoState<R> {
        &self.state
    }

    /// Whether the motor rests after a fault.
    #[inline]
    pub const fn rests(&self) -> bool {
        matches!(self.state, ServoState::Resting { .. })
    }

    /// The setpoint that was commanded, if any.
    pub const fn setpoint(&self) -> Option<R> {
        self.setpoint
    }

    /// A setpoint that takes the place of the pattern generator's; `None`: the
    /// pattern generator's again.
    pub const fn set_setpoint(&mut self, setpoint: Option<R>) {
        self.setpoint = setpoint;
    }

    /// Switches the motor off until the next tick; a rest goes on.
    fn off(&mut self) {
        self.motor.off();
        if let ServoState::Running { .. } = self.state {
            self.state = ServoState::Off;
        }
    }

    /// One tick towards protraction `setpoint`, unless another was commanded;
    /// off while it `may_run` not.
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

        if let ServoState::Resting { left } = self.state {
            self.rest(left, place, events);
            return;
        }
        if !may_run {
            self.off();
            return;
        }
        if let ServoState::Off = self.state {
            self.state = ServoState::Running {
                pd: pd::State::default(),
                stall: StallGuard::default(),
            };
        }
        let ServoState::Running { pd, stall } = &mut self.state else {
            return;
        };
        let setpoint = self.setpoint.unwrap_or(setpoint);
        let at = counts.wrapping_sub(self.home);
        let duty = config.pd.step(pd, setpoint, at, moved);
        // A rotor that stands on an edge of its encoder flickers by a count.
        let done = if stall.update(config.stall, duty, moved.unsigned_abs() > 1) {
            Err(motor::Fault::Stall)
        } else {
            self.motor.drive(duty)
        };
        if let Err(fault) = done {
            self.fail(fault, config.retry, place, events);
        }
    }

    /// One tick of a motor that rests after a fault.
    #[cold]
    fn rest(&mut self, left: u16, place: Place, events: &mut impl FnMut(Event)) {
        if left > 1 {
            self.state = ServoState::Resting { left: left - 1 };
        } else {
            self.state = ServoState::Off;
            self.motor.clear();
            events(Event::MotorRetry(place));
        }
    }

    #[cold]
    fn fail(
        &mut self,
        fault: motor::Fault,
        retry: u16,
        place: Place,
        events: &mut impl FnMut(Event),
    ) {
        self.motor.off();
        let left = retry.max(1);
        self.state = ServoState::Resting { left };
        events(Event::MotorFault(place, fault));
    }
}
