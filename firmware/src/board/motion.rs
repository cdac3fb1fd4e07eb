//! How the module moves, as the scene names it: the type it has on this board,
//! its constants, its start and its lines in the log.

use core::marker::PhantomData;

use firmware::design_parameters::{RETRY_S, stall, ticks};
use firmware::{Active, ActiveConfig, Motion, Passive, Place, Servo};
use whisking::motor::{Fault, MotorDriver, StallConfig};

use super::encoder::Encoder;
use super::log;
use super::motors::Motor;
use super::scene::{Number, TICK_HZ};
use crate::here::clock_motor;

/// Constants of a [`Moves`].
pub(crate) type Config<M> = <<M as Moves>::Motion as Motion<Number, 1, 1>>::Config;

/// How a module with one whisker moves.
pub(crate) trait Moves {
    /// Its type in the library.
    type Motion: Motion<Number, 1, 1>;

    /// Its constants.
    const CONFIG: Config<Self>;

    /// The motion from its start, the whisker being at rest now.
    fn start() -> Self::Motion;

    /// A line for a motor that was switched off.
    fn tell_fault(place: Place, fault: Fault);

    /// A line for a motor that is tried again.
    fn tell_retry(place: Place);
}

/// It does not: no oscillator, muscle, motor or position control.
pub(crate) struct Still;

impl Moves for Still {
    type Motion = Passive;

    const CONFIG: () = ();

    fn start() -> Passive {
        Passive
    }

    // What cannot happen has no words.
    fn tell_fault(_: Place, _: Fault) {}

    fn tell_retry(_: Place) {}
}

/// What an active scene says.
pub(crate) trait Whisking {
    /// The motor and its stage.
    type Motor: Motor;
    /// Oscillators, muscles and gates.
    const WHISKING: whisking::Config<Number>;
    /// Where they start.
    const START: whisking::Start<Number, 1, 1>;
    /// Position control.
    const PD: whisking::pd::Config<Number>;
    /// Duty above which a motor that stands still is stalled, Q15.
    const STALL_Q15: i16;
    /// Seed of the noise.
    const SEED: u64;
}

/// It whisks, and a motor with an encoder follows.
pub(crate) struct Whisks<S>(PhantomData<S>);

impl<S: Whisking> Whisks<S> {
    const STALL: StallConfig = stall(TICK_HZ, S::STALL_Q15);
}

impl<S: Whisking> Moves for Whisks<S>
where
    <S::Motor as Motor>::Driver: MotorDriver,
{
    type Motion = Active<Number, <S::Motor as Motor>::Driver, Encoder, 1, 1>;

    const CONFIG: ActiveConfig<Number> = ActiveConfig {
        whisking: S::WHISKING,
        pd: S::PD,
        retry: ticks(RETRY_S, TICK_HZ),
        stall: Self::STALL,
    };

    fn start() -> Self::Motion {
        clock_motor();
        let encoder = Encoder::start();
        let motor = S::Motor::start(Self::STALL);
        let state = whisking::State::new(&S::START, S::SEED);
        Active::new(state, [[Servo::new(motor, encoder, Self::STALL)]])
    }

    fn tell_fault(place: Place, fault: Fault) {
        log::motor_fault(place, fault);
    }

    fn tell_retry(place: Place) {
        log::motor_retry(place);
    }
}
