//! How the whiskers of a module move, and what can be asked of that.

use core::ops::Range;

use whisking::{Real, State};
use wire::CommandStatus;

use crate::MotionConfig;
use crate::config::Part;
use crate::servo::TooManyFaults;

/// What can be done to a whisker between two ticks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command<R> {
    /// The nominal gain g (BIOTACT eq. 12), limited to 0..=2.
    Gain(R),
    /// Protraction θ in place of the pattern generator's, limited to the range of the position
    /// control; `None`: the pattern generator's again.
    Setpoint(Option<R>),
    /// Runs a motor that was given up, or that rests, again; its faults count on.
    Clear,
    /// Finds rest again, where it is found.
    Home,
}

/// There is no such whisker, or it is passive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("no such whisker, or it is passive")]
pub struct NoActiveWhisker;

/// Why a command is not carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NotDone {
    /// There is no such whisker, or it is passive.
    #[error(transparent)]
    NoWhisker(#[from] NoActiveWhisker),
    /// Its motor was cleared not long ago.
    #[error(transparent)]
    TooManyFaults(#[from] TooManyFaults),
}

impl NotDone {
    /// It in an answer.
    pub const fn status(self) -> CommandStatus {
        match self {
            Self::NoWhisker(_) => CommandStatus::NoWhisker,
            Self::TooManyFaults(_) => CommandStatus::TooManyFaults,
        }
    }
}

/// Oscillators, gates and muscles of an active module.
#[derive(Debug)]
pub struct Motion<R: Real> {
    pub(crate) state: State<R>,
    pub(crate) is_armed: bool,
}

impl<R: Real> Motion<R> {
    pub(crate) fn new(config: &MotionConfig<R>, own: Range<usize>) -> Self {
        Self {
            state: if Part::Bus.is_built() {
                State::of_some(&config.start, own, config.seed)
            } else {
                State::new(&config.start, config.seed)
            },
            is_armed: false,
        }
    }

    /// Oscillators, gates and whiskers.
    pub const fn state(&self) -> &State<R> {
        &self.state
    }

    /// Whether its motors are armed.
    pub const fn is_armed(&self) -> bool {
        self.is_armed
    }

    pub(crate) const fn set_armed(&mut self, is_armed: bool) {
        self.is_armed = is_armed;
    }

    pub(crate) fn set_gain(&mut self, n: usize, gain: R) -> Result<(), NoActiveWhisker> {
        let whisker = self.state.whiskers.get_mut(n).ok_or(NoActiveWhisker)?;
        whisker.set_nominal(gain);
        Ok(())
    }
}

impl<R: Real> MotionConfig<R> {
    /// Whether it allows a command.
    ///
    /// # Errors
    /// [`CommandStatus::OutOfRange`] for a value that is, [`CommandStatus::NotHere`] for what was
    /// left out.
    pub fn allows(&self, command: &Command<R>) -> Result<(), CommandStatus> {
        let pd = &self.servo.pd;
        let in_range = match *command {
            Command::Gain(gain) => R::ZERO <= gain && gain <= R::TWO,
            Command::Setpoint(Some(setpoint)) => pd.min <= setpoint && setpoint <= pd.max,
            Command::Home if !Part::Homing.is_built() || self.servo.homing.is_none() => {
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
