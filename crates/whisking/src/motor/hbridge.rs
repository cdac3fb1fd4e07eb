//! A brushed motor on an H-bridge with one PWM and one direction input.

use embedded_hal::digital::{OutputPin, PinState};
use embedded_hal::pwm::SetDutyCycle;

use super::{Duty, Fault, MotorDriver, set_pwm, zero_pwm};

/// Sign-magnitude drive: the PWM carries the size of the duty, the direction
/// pin its sign (high is protraction). The input pair is called PH/EN or
/// DIR/PWM in data sheets; IN1/IN2 bridges are not of this kind.
///
/// At a change of direction the PWM goes to zero first, then the pin changes, then the new duty is
/// set, so that the old duty never acts in the new direction. A zero duty leaves the pin as it is.
///
/// With a buffered PWM (see the [module](super)) that order is not enough: the
/// zero would take effect after the pin has changed. Use
/// [`with_buffered_pwm`](Self::with_buffered_pwm) then.
///
/// [`MotorDriver::off`] sets the PWM to zero and leaves the direction pin
/// alone: a bridge at zero ignores it, and if the PWM has failed, a change of the
/// pin under a live PWM would reverse the motor.
///
/// Stall and encoder are the caller's: see [`Guards`](super::Guards).
#[derive(Debug)]
pub struct HBridge<PWM, DIR> {
    pwm: PWM,
    dir: DIR,
    /// Last state of the direction pin; unknown while the motor is off.
    forward: Option<bool>,
    /// Whether the PWM output may still be at a duty other than zero.
    live: bool,
    buffered: bool,
    fault: Option<Fault>,
}

impl<PWM: SetDutyCycle, DIR: OutputPin> HBridge<PWM, DIR> {
    /// Takes the outputs and switches off. If that fails, the first
    /// [`drive`](MotorDriver::drive) returns the fault.
    pub fn new(pwm: PWM, dir: DIR) -> Self {
        let mut bridge = Self {
            pwm,
            dir,
            forward: None,
            live: true,
            buffered: false,
            fault: None,
        };
        bridge.off();
        bridge
    }

    /// For a PWM whose duty takes effect only at its next period: a change of
    /// direction under drive then rests at zero for one tick before the pin
    /// changes. The PWM period must not exceed the tick.
    #[must_use]
    pub fn with_buffered_pwm(mut self) -> Self {
        self.buffered = true;
        self
    }

    /// Its PWM.
    pub const fn pwm(&self) -> &PWM {
        &self.pwm
    }

    /// The fault that holds the motor off.
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    #[inline]
    fn set_pwm(&mut self, duty: Duty) -> Result<(), Fault> {
        // Set before the write: a failed one may still have taken effect.
        self.live |= duty != Duty::ZERO;
        set_pwm(&mut self.pwm, duty)?;
        self.live = duty != Duty::ZERO;
        Ok(())
    }

    fn zero_pwm(&mut self) -> Result<(), Fault> {
        zero_pwm(&mut self.pwm)?;
        self.live = false;
        Ok(())
    }

    #[inline]
    fn apply(&mut self, duty: Duty) -> Result<(), Fault> {
        let forward = duty.is_forward();
        if duty != Duty::ZERO && self.forward != Some(forward) {
            let rest = self.buffered && self.live;
            self.zero_pwm()?;
            if rest {
                return Ok(());
            }
            self.dir
                .set_state(PinState::from(forward))
                .map_err(|_| Fault::Pin)?;
            self.forward = Some(forward);
        }
        self.set_pwm(duty)
    }
}

impl<PWM: SetDutyCycle, DIR: OutputPin> MotorDriver for HBridge<PWM, DIR> {
    #[inline]
    fn drive(&mut self, duty: Duty) -> Result<(), Fault> {
        let fault = match self.fault {
            Some(fault) => fault,
            None => match self.apply(duty) {
                Ok(()) => return Ok(()),
                Err(fault) => fault,
            },
        };
        self.fault = Some(fault);
        self.off();
        Err(fault)
    }

    fn off(&mut self) {
        if let Err(fault) = self.zero_pwm() {
            self.fault.get_or_insert(fault);
        }
        // The next drive sets the pin, whatever came of it or of this note of it.
        self.forward = None;
    }

    fn clear(&mut self) {
        self.fault = None;
    }
}
