//! Active whiskers: the pattern generator of the module, and a servo for each.

use whisking::motor::{HomingConfig, MotorDriver};
use whisking::{Absent, Optional, PatternGenerator, Real};
use wire::{CommandStatus, Flags, q13};

use crate::io::AngleInput;
use crate::motion::{Command, Motion, MotionRecord, MotorControl, NoActiveWhisker};
use crate::sensing::Reading;
use crate::servo::{Servo, ServoConfig};
use crate::{Event, Place};

/// A fault of any whisker switches every motor off until it is gone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StopAll;

/// Constants of an active module; `W` is its pattern generator, `A` says whether it has
/// [`StopAll`], `H` whether its motors are homed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActiveConfig<R: Real, W = whisking::Config<R>, A = Absent, H = Absent> {
    /// Oscillators, muscles and gates.
    pub whisking: W,
    /// Position control, and what is done about faults of a motor.
    pub servo: ServoConfig<R, H>,
    /// [`StopAll`]; absent: a fault switches off the motor of its whisker alone.
    pub stop_all: A,
}

/// Whiskers that whisk.
#[derive(Debug)]
pub struct Active<R: Real, M, A, const S: usize, const N: usize> {
    state: whisking::State<R, S, N>,
    servos: [[Servo<R, M, A>; N]; S],
    is_armed: bool,
}

impl<R: Real, M, A, const S: usize, const N: usize> Active<R, M, A, S, N> {
    /// A module at its start, its motors not armed.
    pub const fn new(state: whisking::State<R, S, N>, servos: [[Servo<R, M, A>; N]; S]) -> Self {
        Self {
            state,
            servos,
            is_armed: false,
        }
    }

    /// Whether its motors are armed: otherwise they are off, and all else goes on.
    pub const fn is_armed(&self) -> bool {
        self.is_armed
    }

    /// Oscillators, gates and whiskers.
    pub const fn state(&self) -> &whisking::State<R, S, N> {
        &self.state
    }

    /// The servo of every whisker, left side first.
    pub const fn servos(&self) -> &[[Servo<R, M, A>; N]; S] {
        &self.servos
    }

    /// The servos, for a simulation that looks at their hardware.
    pub const fn servos_mut(&mut self) -> &mut [[Servo<R, M, A>; N]; S] {
        &mut self.servos
    }
}

impl<R, W, O, H, M, A, const S: usize, const N: usize> Motion<R, ActiveConfig<R, W, O, H>, S, N>
    for Active<R, M, A, S, N>
where
    R: Real,
    W: PatternGenerator<R>,
    O: Optional<StopAll>,
    H: Optional<HomingConfig>,
    M: MotorDriver,
    A: AngleInput,
{
    #[inline]
    fn step(
        &mut self,
        config: &ActiveConfig<R, W, O, H>,
        contact: [R; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        config.whisking.step(&mut self.state, contact);
        let all_stop = config.stop_all.part().is_some()
            && (readings.iter().flatten().any(|reading| !reading.valid)
                || self.servos.iter().flatten().any(Servo::rests));
        let sides = self.servos.iter_mut().zip(&self.state.whiskers);
        for (side, (servos, whiskers)) in sides.enumerate() {
            for (w, (servo, whisker)) in servos.iter_mut().zip(whiskers).enumerate() {
                let place = Place::new(side as u8, w as u8);
                let may_run = self.is_armed && readings[side][w].valid && !all_stop;
                servo.step(&config.servo, whisker.muscle.theta, may_run, place, events);
            }
        }
    }

    #[inline]
    fn is_deaf(&self, side: usize, whisker: usize) -> bool {
        let servo = self.servos.get(side).and_then(|side| side.get(whisker));
        servo.is_some_and(Servo::is_deaf)
    }

    #[inline]
    fn told(&self, config: &ActiveConfig<R, W, O, H>, side: usize, whisker: usize) -> MotionRecord {
        let servo = self.servos.get(side).and_then(|side| side.get(whisker));
        let state = self.state.whiskers.get(side).zip(self.state.z.get(side));
        let whiskers = state.and_then(|(side, z)| side.get(whisker).zip(Some(z)));
        let (Some(servo), Some((whisker, z))) = (servo, whiskers) else {
            return MotionRecord::default();
        };
        let mut motor = servo.told(&config.servo, whisker.muscle.theta);
        motor.flags = motor.flags | Flags::ARMED.when(self.is_armed);
        MotionRecord {
            motor,
            z: q13(z.value.to_q24()),
        }
    }

    fn allows(
        &self,
        config: &ActiveConfig<R, W, O, H>,
        command: &Command<R>,
    ) -> Result<(), CommandStatus> {
        let pd = &config.servo.pd;
        let in_range = match *command {
            Command::Gain(gain) => R::ZERO <= gain && gain <= R::TWO,
            Command::Setpoint(Some(setpoint)) => pd.min <= setpoint && setpoint <= pd.max,
            Command::Home if config.servo.homing.part().is_none() => {
                return Err(CommandStatus::NotHere);
            }
            Command::Setpoint(None) | Command::Clear | Command::Home => true,
        };
        if in_range {
            Ok(())
        } else {
            Err(CommandStatus::OutOfRange)
        }
    }
}

impl<R: Real, M: MotorDriver, A: AngleInput, const S: usize, const N: usize> MotorControl<R>
    for Active<R, M, A, S, N>
{
    fn command(&mut self, place: Place, command: Command<R>) -> Result<(), NoActiveWhisker> {
        fn at<T, const S: usize, const N: usize>(
            whiskers: &mut [[T; N]; S],
            place: Place,
        ) -> Result<&mut T, NoActiveWhisker> {
            let side = whiskers.get_mut(usize::from(place.side));
            side.and_then(|side| side.get_mut(usize::from(place.whisker)))
                .ok_or(NoActiveWhisker)
        }
        match command {
            Command::Gain(gain) => at(&mut self.state.whiskers, place)?.set_nominal(gain),
            Command::Setpoint(setpoint) => at(&mut self.servos, place)?.set_setpoint(setpoint),
            Command::Clear => at(&mut self.servos, place)?.clear(),
            Command::Home => at(&mut self.servos, place)?.home(),
        }
        Ok(())
    }

    fn arm(&mut self, is_armed: bool) {
        self.is_armed = is_armed;
        if is_armed {
            self.servos.iter_mut().flatten().for_each(Servo::arm);
        }
    }
}
