//! The motor's pins: shared wires behind embedded-hal traits.
//!
//! The module has one end, the simulated motor the other. Both ends are on the
//! thread of their run, one after the other: relaxed atomics are enough, and
//! let a run move to another thread as a whole.

use core::convert::Infallible;
use core::f64::consts::TAU;
use core::sync::atomic::{AtomicBool, AtomicI32, AtomicU16, AtomicU64, Ordering::Relaxed};
use std::sync::Arc;

use embedded_hal::digital::{self, InputPin, OutputPin, PinState};
use embedded_hal::pwm::{self, SetDutyCycle};
use firmware::AngleInput;

use super::EncoderFlaws;

/// A wire that can be cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Wire {
    /// Winding terminal 0 or 1 of a brushed motor, 0 to 2 of a brushless one; others are not there.
    Winding(usize),
    /// Both winding terminals of a brushed motor, exchanged: it turns the wrong way round.
    Windings,
    /// The cable of the Hall sensors: their pull-ups read high, code 7.
    Halls,
    /// The cable of the encoder: its count stands still. Once mended it goes on
    /// from there, off by what it has missed.
    Encoder,
    /// The encoder's two channels, exchanged: it counts the wrong way round.
    EncoderChannels,
}

impl Wire {
    const fn place(self) -> usize {
        match self {
            Self::Winding(i @ 0..3) => i,
            Self::Winding(_) => usize::MAX,
            Self::Windings => 3,
            Self::Halls => 4,
            Self::Encoder => 5,
            Self::EncoderChannels => 6,
        }
    }
}

/// A number that both ends of a wire can reach.
#[derive(Debug, Default)]
pub(super) struct Level(AtomicU64);

impl Level {
    pub(super) fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Relaxed))
    }

    pub(super) fn set(&self, value: f64) {
        self.0.store(value.to_bits(), Relaxed);
    }
}

#[derive(Debug)]
pub(super) struct Wires {
    duty: [AtomicU16; 3],
    high: [AtomicBool; 3],
    /// Which wires are cut, or exchanged, by [`Wire::place`].
    cut: [AtomicBool; 7],
    /// Rotor angle, rad.
    angle: Level,
    /// Angle that the encoder has not seen, rad.
    pub(super) missed: Level,
    /// Counts that are read beside those of the angle.
    pub(super) jitter: AtomicI32,
    counts_per_rad: f64,
    pwm_counts: u16,
}

impl Wires {
    pub(super) fn new(counts_per_rad: f64, pwm_counts: u16) -> Self {
        Self {
            duty: Default::default(),
            high: Default::default(),
            cut: Default::default(),
            angle: Level::default(),
            missed: Level::default(),
            jitter: AtomicI32::new(0),
            counts_per_rad,
            pwm_counts,
        }
    }

    /// The rotor has turned to `angle`, of which an encoder with these flaws sees a part.
    pub(super) fn set_angle(&self, angle: f64, flaws: EncoderFlaws) {
        let turned = angle - self.angle.get();
        let seen = if self.is_cut(Wire::Encoder) {
            0.0
        } else {
            flaws.seen(turned)
        };
        self.missed.set(self.missed.get() + turned - seen);
        self.angle.set(angle);
    }

    pub(super) fn set_cut(&self, wire: Wire, cut: bool) {
        if let Some(place) = self.cut.get(wire.place()) {
            place.store(cut, Relaxed);
        }
    }

    /// Duty of a PWM, 0 to 1.
    pub(super) fn duty(&self, i: usize) -> f64 {
        let duty = self.duty.get(i).map_or(0, |duty| duty.load(Relaxed));
        f64::from(duty) / f64::from(self.pwm_counts)
    }

    pub(super) fn is_high(&self, i: usize) -> bool {
        self.high.get(i).is_some_and(|high| high.load(Relaxed))
    }

    pub(super) fn is_cut(&self, wire: Wire) -> bool {
        let cut = self.cut.get(wire.place());
        cut.is_some_and(|cut| cut.load(Relaxed))
    }
}

/// The module's end of one of several like wires.
#[derive(Debug, Clone)]
pub(super) struct End {
    pub(super) wires: Arc<Wires>,
    pub(super) i: usize,
}

/// A PWM output of the module.
#[derive(Debug, Clone)]
pub struct SimPwm(pub(super) End);

/// A digital output of the module: a direction or an enable.
#[derive(Debug, Clone)]
pub struct SimPin(pub(super) End);

/// A digital input of the module: Hall sensor k, high while the rotor's magnet
/// is within 90° of axis k.
#[derive(Debug, Clone)]
pub struct SimHall(pub(super) End);

/// The encoder's counter: 0 at rest, up with protraction, to the nearest count; wraps around.
#[derive(Debug, Clone)]
pub struct SimEncoder(pub(super) Arc<Wires>);

impl pwm::ErrorType for SimPwm {
    type Error = Infallible;
}

impl SetDutyCycle for SimPwm {
    fn max_duty_cycle(&self) -> u16 {
        self.0.wires.pwm_counts
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        if let Some(place) = self.0.wires.duty.get(self.0.i) {
            place.store(duty.min(self.max_duty_cycle()), Relaxed);
        }
        Ok(())
    }
}

impl digital::ErrorType for SimPin {
    type Error = Infallible;
}

impl OutputPin for SimPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.set_state(PinState::Low)
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.set_state(PinState::High)
    }

    fn set_state(&mut self, state: PinState) -> Result<(), Infallible> {
        if let Some(place) = self.0.wires.high.get(self.0.i) {
            place.store(state == PinState::High, Relaxed);
        }
        Ok(())
    }
}

impl digital::ErrorType for SimHall {
    type Error = Infallible;
}

impl InputPin for SimHall {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        let End { wires, i } = &self.0;
        let axis = TAU / 3.0 * *i as f64;
        Ok(wires.is_cut(Wire::Halls) || libm::cos(wires.angle.get() - axis) > 0.0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

impl AngleInput for SimEncoder {
    fn counts(&mut self) -> i32 {
        let seen = self.0.angle.get() - self.0.missed.get();
        let turned = self.0.is_cut(Wire::EncoderChannels);
        let seen = if turned { -seen } else { seen };
        // Through i64, so that the count wraps as a counter does.
        let counts = seen * self.0.counts_per_rad + 0.5;
        let cut = counts as i64;
        // Down, not towards zero.
        let down = cut.wrapping_sub(i64::from(cut as f64 > counts)) as i32;
        down.wrapping_add(self.0.jitter.load(Relaxed))
    }
}
