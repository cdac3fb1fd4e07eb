//! The motor's pins: shared wires behind embedded-hal traits.
//!
//! The module has one end, the simulated motor the other.

use core::cell::Cell;
use core::convert::Infallible;
use core::f64::consts::TAU;
use std::rc::Rc;

use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use firmware::AngleInput;

use super::Wire;

/// Duty of a PWM channel that is fully on: the NUCLEO-F446RE's timer of 160 MHz
/// at 20 kHz, so that its steps are the board's.
pub const PWM_MAX: u16 = 8000;

/// What the pins carry.
#[derive(Debug)]
pub(super) struct Wires {
    duty: [Cell<u16>; 3],
    high: [Cell<bool>; 3],
    cut: [Cell<bool>; 3],
    halls_cut: Cell<bool>,
    encoder_cut: Cell<bool>,
    /// Rotor angle, rad.
    angle: Cell<f64>,
    /// Angle that the encoder has not seen, rad.
    missed: Cell<f64>,
    counts_per_rad: f64,
}

impl Wires {
    pub(super) fn new(counts_per_rad: f64) -> Self {
        Self {
            duty: Default::default(),
            high: Default::default(),
            cut: Default::default(),
            halls_cut: Cell::new(false),
            encoder_cut: Cell::new(false),
            angle: Cell::new(0.0),
            missed: Cell::new(0.0),
            counts_per_rad,
        }
    }

    pub(super) fn set_angle(&self, angle: f64) {
        if self.encoder_cut.get() {
            self.missed
                .set(self.missed.get() + angle - self.angle.get());
        }
        self.angle.set(angle);
    }

    pub(super) fn set_cut(&self, wire: Wire, cut: bool) {
        match wire {
            Wire::Winding(i) => {
                if let Some(cell) = self.cut.get(i) {
                    cell.set(cut);
                }
            }
            Wire::Halls => self.halls_cut.set(cut),
            Wire::Encoder => self.encoder_cut.set(cut),
        }
    }

    /// Duty of a PWM, 0 to 1.
    pub(super) fn duty(&self, i: usize) -> f64 {
        let duty = self.duty.get(i).map_or(0, Cell::get);
        f64::from(duty) / f64::from(PWM_MAX)
    }

    pub(super) fn is_high(&self, i: usize) -> bool {
        self.high.get(i).is_some_and(Cell::get)
    }

    pub(super) fn is_cut(&self, i: usize) -> bool {
        self.cut.get(i).is_some_and(Cell::get)
    }
}

/// A PWM output of the module.
#[derive(Debug)]
pub struct SimPwm {
    wires: Rc<Wires>,
    i: usize,
}

/// A digital output of the module: a direction or an enable.
#[derive(Debug)]
pub struct SimPin {
    wires: Rc<Wires>,
    i: usize,
}

/// The direction input of an H-bridge.
pub type SimDir = SimPin;

/// A digital input of the module: Hall sensor k, high while the rotor's magnet
/// is within 90° of axis k.
#[derive(Debug)]
pub struct SimHall {
    wires: Rc<Wires>,
    i: usize,
}

/// The encoder's counter: 0 at rest, up with protraction, to the nearest count;
/// wraps around.
#[derive(Debug)]
pub struct SimEncoder {
    wires: Rc<Wires>,
}

impl SimPwm {
    pub(super) fn new(wires: &Rc<Wires>, i: usize) -> Self {
        let wires = Rc::clone(wires);
        Self { wires, i }
    }
}

impl SimPin {
    pub(super) fn new(wires: &Rc<Wires>, i: usize) -> Self {
        let wires = Rc::clone(wires);
        Self { wires, i }
    }

    fn set(&self, high: bool) {
        if let Some(cell) = self.wires.high.get(self.i) {
            cell.set(high);
        }
    }
}

impl SimHall {
    pub(super) fn new(wires: &Rc<Wires>, i: usize) -> Self {
        let wires = Rc::clone(wires);
        Self { wires, i }
    }
}

impl SimEncoder {
    pub(super) fn new(wires: &Rc<Wires>) -> Self {
        let wires = Rc::clone(wires);
        Self { wires }
    }
}

impl pwm::ErrorType for SimPwm {
    type Error = Infallible;
}

impl SetDutyCycle for SimPwm {
    fn max_duty_cycle(&self) -> u16 {
        PWM_MAX
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        if let Some(cell) = self.wires.duty.get(self.i) {
            cell.set(duty.min(PWM_MAX));
        }
        Ok(())
    }
}

impl digital::ErrorType for SimPin {
    type Error = Infallible;
}

impl OutputPin for SimPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.set(true);
        Ok(())
    }
}

impl digital::ErrorType for SimHall {
    type Error = Infallible;
}

impl InputPin for SimHall {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        let axis = TAU / 3.0 * self.i as f64;
        Ok(self.wires.halls_cut.get() || libm::cos(self.wires.angle.get() - axis) > 0.0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

impl AngleInput for SimEncoder {
    fn counts(&mut self) -> i32 {
        let seen = self.wires.angle.get() - self.wires.missed.get();
        // Through i64, so that the count wraps as a counter does.
        (seen * self.wires.counts_per_rad + 0.5).floor() as i64 as i32
    }
}
