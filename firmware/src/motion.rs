//! What moves the whiskers of a module, or does not.

use wire::{CommandStatus, Flags};

use crate::sensing::Reading;
use crate::{Event, Place};

/// What the last tick has done with a whisker, in the formats of a [`TickRecord`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MotionRecord {
    /// Of its motor.
    pub motor: MotorRecord,
    /// z of its side, Q13.
    pub z: i16,
}

/// What it has done with a motor, alike.
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

/// Moves the whiskers of a module by the constants `C`.
pub trait Motion<R, C, const S: usize, const N: usize> {
    /// One tick: contact π of each side, and what every sensor reads.
    fn step(
        &mut self,
        config: &C,
        contact: [R; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    );

    /// Whether nothing that a whisker (its side and number) feels is of use: its motor rests
    /// after a fault, or is being homed.
    fn is_deaf(&self, side: usize, whisker: usize) -> bool;

    /// What the last tick has done with a whisker (its side and number).
    fn told(&self, config: &C, side: usize, whisker: usize) -> MotionRecord;

    /// Whether the constants allow a command.
    ///
    /// # Errors
    /// [`CommandStatus::OutOfRange`] for a value that is, [`CommandStatus::NotHere`] for what was left out,
    /// [`CommandStatus::NoWhisker`] where nothing moves.
    fn allows(&self, config: &C, command: &Command<R>) -> Result<(), CommandStatus>;
}

/// An intervention between two ticks, for one whisker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command<R> {
    /// Nominal value of the gain g, limited to 0..=2.
    Gain(R),
    /// Protraction θ that takes the place of the pattern generator's, limited
    /// to the range of the position control; `None`: the pattern generator's
    /// again.
    Setpoint(Option<R>),
    /// Runs a motor that was given up, or that rests, again.
    Clear,
    /// Finds rest anew, where it is found.
    Home,
}

/// There is no such whisker, or it is passive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("no such whisker, or it is passive")]
pub struct NoActiveWhisker;

/// What can be done to the whiskers of a module between ticks.
pub trait MotorControl<R> {
    /// Carries out `command` for a whisker.
    ///
    /// # Errors
    /// [`NoActiveWhisker`] if there is none at `place`.
    fn command(&mut self, place: Place, command: Command<R>) -> Result<(), NoActiveWhisker>;

    /// Arms the motors of all whiskers, those that rest or were given up too, or keeps them
    /// off from the next tick on. A module starts with motors that are not armed. Whoever
    /// arms a motor that is off says that its whisker is at rest, unless it is homed.
    fn arm(&mut self, is_armed: bool);
}

/// Whiskers that hang still: no oscillator, muscle, motor or position control.
#[derive(Debug, Clone, Copy, Default)]
pub struct Passive;

impl<R, const S: usize, const N: usize> Motion<R, (), S, N> for Passive {
    #[inline]
    fn step(
        &mut self,
        (): &(),
        _contact: [R; S],
        _readings: &[[Reading; N]; S],
        _events: &mut impl FnMut(Event),
    ) {
    }

    #[inline]
    fn is_deaf(&self, _side: usize, _whisker: usize) -> bool {
        false
    }

    #[inline]
    fn told(&self, (): &(), _side: usize, _whisker: usize) -> MotionRecord {
        MotionRecord::default()
    }

    fn allows(&self, (): &(), _command: &Command<R>) -> Result<(), CommandStatus> {
        Err(CommandStatus::NoWhisker)
    }
}

impl<R> MotorControl<R> for Passive {
    fn command(&mut self, _: Place, _: Command<R>) -> Result<(), NoActiveWhisker> {
        Err(NoActiveWhisker)
    }

    fn arm(&mut self, _: bool) {}
}

/// Motion that is there or not at run time, for simulations of any scene. A
/// configuration without the motion, or the reverse, moves nothing.
impl<R, C, M: Motion<R, C, S, N>, const S: usize, const N: usize> Motion<R, Option<C>, S, N>
    for Option<M>
{
    #[inline]
    fn step(
        &mut self,
        config: &Option<C>,
        contact: [R; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        if let (Some(motion), Some(config)) = (self, config) {
            motion.step(config, contact, readings, events);
        }
    }

    #[inline]
    fn is_deaf(&self, side: usize, whisker: usize) -> bool {
        let motion = self.as_ref();
        motion.is_some_and(|motion| motion.is_deaf(side, whisker))
    }

    fn told(&self, config: &Option<C>, side: usize, whisker: usize) -> MotionRecord {
        let parts = self.as_ref().zip(config.as_ref());
        parts.map_or_else(MotionRecord::default, |(motion, config)| {
            motion.told(config, side, whisker)
        })
    }

    fn allows(&self, config: &Option<C>, command: &Command<R>) -> Result<(), CommandStatus> {
        let parts = self.as_ref().zip(config.as_ref());
        let (motion, config) = parts.ok_or(CommandStatus::NoWhisker)?;
        motion.allows(config, command)
    }
}

impl<R, M: MotorControl<R>> MotorControl<R> for Option<M> {
    fn command(&mut self, place: Place, command: Command<R>) -> Result<(), NoActiveWhisker> {
        match self {
            Some(motion) => motion.command(place, command),
            None => Err(NoActiveWhisker),
        }
    }

    fn arm(&mut self, is_armed: bool) {
        if let Some(motion) = self {
            motion.arm(is_armed);
        }
    }
}
