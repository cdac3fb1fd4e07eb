//! How a module moves: the pattern generator, and a motor that follows it for
//! each whisker.

use whisking::motor::{self, MotorDriver, StallConfig, StallGuard};
use whisking::{PatternGenerator, Real, pd};

use crate::io::AngleInput;
use crate::sensing::Reading;
use crate::{Event, Place};

/// Moves the whiskers of a module, or does not.
pub trait Motion<R, const S: usize, const N: usize> {
    /// Its constants.
    type Config;

    /// One tick: contact π of each side and the readings it came from.
    fn step(
        &mut self,
        config: &Self::Config,
        contact: [R; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    );

    /// Switches every motor off.
    fn off(&mut self);
}

/// Whiskers that hang still: no oscillator, muscle, motor or position control.
#[derive(Debug, Clone, Copy, Default)]
pub struct Passive;

impl<R, const S: usize, const N: usize> Motion<R, S, N> for Passive {
    type Config = ();

    #[inline]
    fn step(
        &mut self,
        (): &(),
        _contact: [R; S],
        _readings: &[[Reading; N]; S],
        _events: &mut impl FnMut(Event),
    ) {
    }

    fn off(&mut self) {}
}

/// Motion that is there or not at run time, for simulations of any scene. A
/// configuration without the motion, or the reverse, moves nothing.
impl<R, M: Motion<R, S, N>, const S: usize, const N: usize> Motion<R, S, N> for Option<M> {
    type Config = Option<M::Config>;

    #[inline]
    fn step(
        &mut self,
        config: &Self::Config,
        contact: [R; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        if let (Some(motion), Some(config)) = (self, config) {
            motion.step(config, contact, readings, events);
        }
    }

    fn off(&mut self) {
        if let Some(motion) = self {
            motion.off();
        }
    }
}

/// Constants of an active module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActiveConfig<R: Real> {
    /// Oscillators, muscles and gates.
    pub whisking: whisking::Config<R>,
    /// Position control.
    pub pd: pd::Config<R>,
    /// Ticks a faulty motor rests before it is tried again.
    pub retry: u16,
    /// When a motor counts as stalled.
    pub stall: StallConfig,
}

/// The motor of one whisker, its angle input and its controller.
#[derive(Debug)]
pub struct Servo<R, M, A> {
    motor: M,
    angle: A,
    pd: pd::State<R>,
    /// Counts at rest, θ = 0, and at the last tick.
    home: i32,
    counts: i32,
    stall: StallConfig,
    guard: StallGuard,
    /// Ticks of rest left after a fault; 0: running.
    rest: u16,
}

impl<R: Real, M: MotorDriver, A: AngleInput> Servo<R, M, A> {
    /// A motor that is off, its whisker at rest (θ = 0) where the angle input now is.
    pub fn new(mut motor: M, mut angle: A, stall: StallConfig) -> Self {
        motor.off();
        let home = angle.counts();
        Self {
            motor,
            angle,
            pd: pd::State::default(),
            home,
            counts: home,
            stall,
            guard: StallGuard::default(),
            rest: 0,
        }
    }

    /// The hardware, for a simulation that looks at it.
    pub const fn parts_mut(&mut self) -> (&mut M, &mut A) {
        (&mut self.motor, &mut self.angle)
    }

    fn off(&mut self) {
        self.motor.off();
        self.pd = pd::State::default();
        self.guard = StallGuard::default();
    }

    /// One tick towards protraction `setpoint`; off while `valid` is false.
    #[inline]
    fn step(
        &mut self,
        config: &ActiveConfig<R>,
        setpoint: R,
        valid: bool,
        place: Place,
        events: &mut impl FnMut(Event),
    ) {
        let counts = self.angle.counts();
        let moved = counts.wrapping_sub(self.counts);
        self.counts = counts;
        if self.rest > 0 || !valid {
            self.idle(place, events);
            return;
        }

        let at = counts.wrapping_sub(self.home);
        let duty = config.pd.step(&mut self.pd, setpoint, at, moved);
        // A rotor that stands on an edge of its encoder flickers by a count.
        let done = if self
            .guard
            .update(self.stall, duty, moved.unsigned_abs() > 1)
        {
            Err(motor::Fault::Stall)
        } else {
            self.motor.drive(duty)
        };
        if let Err(fault) = done {
            self.fail(fault, config.retry, place, events);
        }
    }

    /// One tick of a motor that rests after a fault, or whose sensor is invalid.
    #[cold]
    fn idle(&mut self, place: Place, events: &mut impl FnMut(Event)) {
        if self.rest == 0 {
            self.off();
            return;
        }
        self.rest -= 1;
        if self.rest == 0 {
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
        self.off();
        self.rest = retry.max(1);
        events(Event::MotorFault(place, fault));
    }
}

/// Whiskers that whisk: the pattern generator of the module and a servo each.
#[derive(Debug)]
pub struct Active<R: Real, M, A, const S: usize, const N: usize> {
    state: whisking::State<R, S, N>,
    servos: [[Servo<R, M, A>; N]; S],
}

impl<R: Real, M, A, const S: usize, const N: usize> Active<R, M, A, S, N> {
    /// A module at its start.
    pub const fn new(state: whisking::State<R, S, N>, servos: [[Servo<R, M, A>; N]; S]) -> Self {
        Self { state, servos }
    }

    /// Oscillators, gates and whiskers.
    pub const fn state(&self) -> &whisking::State<R, S, N> {
        &self.state
    }

    /// The servos, for a simulation that looks at their hardware.
    pub const fn servos_mut(&mut self) -> &mut [[Servo<R, M, A>; N]; S] {
        &mut self.servos
    }
}

impl<R: Real, M: MotorDriver, A: AngleInput, const S: usize, const N: usize> Motion<R, S, N>
    for Active<R, M, A, S, N>
{
    type Config = ActiveConfig<R>;

    #[inline]
    fn step(
        &mut self,
        config: &ActiveConfig<R>,
        contact: [R; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        config.whisking.step(&mut self.state, contact);
        for (side, (servos, whiskers)) in
            self.servos.iter_mut().zip(&self.state.whiskers).enumerate()
        {
            for (w, (servo, whisker)) in servos.iter_mut().zip(whiskers).enumerate() {
                let place = Place {
                    side: side as u8,
                    whisker: w as u8,
                };
                let valid = readings[side][w].valid;
                servo.step(config, whisker.muscle.theta, valid, place, events);
            }
        }
    }

    fn off(&mut self) {
        for servo in self.servos.iter_mut().flatten() {
            servo.off();
        }
    }
}
