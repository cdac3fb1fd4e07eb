//! Traits for the three PWM channels, enables and Hall inputs of a three-phase
//! motor.
//!
//! Tuples of any three embedded-hal parts implement them, so that each pin may
//! have its own type. An error becomes a [`Fault`], which does not say which of
//! the three it was. A board that reads all Hall sensors in one port access may
//! implement [`HallInputs`] itself.

use embedded_hal::digital::{InputPin, OutputPin, PinState};
use embedded_hal::pwm::SetDutyCycle;

use super::{Duty, Fault, Phase};

/// The PWM inputs IN1 to IN3 of the power stage.
pub trait PhasePwms {
    /// Sets one phase to the magnitude of a duty, scaled to that channel's
    /// largest.
    ///
    /// # Errors
    ///
    /// [`Fault::Pwm`].
    fn set(&mut self, phase: Phase, duty: Duty) -> Result<(), Fault>;

    /// Sets one phase to zero.
    ///
    /// # Errors
    ///
    /// [`Fault::Pwm`].
    fn zero(&mut self, phase: Phase) -> Result<(), Fault>;
}

#[inline]
fn set_one(pwm: &mut impl SetDutyCycle, duty: Duty) -> Result<(), Fault> {
    let counts = duty.scaled_to(pwm.max_duty_cycle());
    pwm.set_duty_cycle(counts).map_err(|_| Fault::Pwm)
}

#[inline]
fn zero_one(pwm: &mut impl SetDutyCycle) -> Result<(), Fault> {
    pwm.set_duty_cycle_fully_off().map_err(|_| Fault::Pwm)
}

impl<A: SetDutyCycle, B: SetDutyCycle, C: SetDutyCycle> PhasePwms for (A, B, C) {
    #[inline]
    fn set(&mut self, phase: Phase, duty: Duty) -> Result<(), Fault> {
        match phase {
            Phase::One => set_one(&mut self.0, duty),
            Phase::Two => set_one(&mut self.1, duty),
            Phase::Three => set_one(&mut self.2, duty),
        }
    }

    #[inline]
    fn zero(&mut self, phase: Phase) -> Result<(), Fault> {
        match phase {
            Phase::One => zero_one(&mut self.0),
            Phase::Two => zero_one(&mut self.1),
            Phase::Three => zero_one(&mut self.2),
        }
    }
}

/// The enables EN1 to EN3 of the power stage: low floats the phase.
pub trait PhaseEnables {
    /// Enables or floats one phase.
    ///
    /// # Errors
    ///
    /// [`Fault::Pin`].
    fn enable(&mut self, phase: Phase, on: bool) -> Result<(), Fault>;
}

impl<A: OutputPin, B: OutputPin, C: OutputPin> PhaseEnables for (A, B, C) {
    #[inline]
    fn enable(&mut self, phase: Phase, on: bool) -> Result<(), Fault> {
        let state = PinState::from(on);
        match phase {
            Phase::One => self.0.set_state(state).map_err(|_| Fault::Pin),
            Phase::Two => self.1.set_state(state).map_err(|_| Fault::Pin),
            Phase::Three => self.2.set_state(state).map_err(|_| Fault::Pin),
        }
    }
}

/// The three Hall sensors.
pub trait HallInputs {
    /// The Hall code, 0 to 7: bit 0 is sensor 1, set when high.
    ///
    /// Sensors may be read one after another: only one changes at a time, so
    /// the code is that of before or after the change.
    ///
    /// # Errors
    ///
    /// [`Fault::Pin`].
    fn code(&mut self) -> Result<u8, Fault>;
}

impl<A: InputPin, B: InputPin, C: InputPin> HallInputs for (A, B, C) {
    #[inline]
    fn code(&mut self) -> Result<u8, Fault> {
        let one = self.0.is_high().map_err(|_| Fault::Pin)?;
        let two = self.1.is_high().map_err(|_| Fault::Pin)?;
        let three = self.2.is_high().map_err(|_| Fault::Pin)?;
        Ok(u8::from(one) | u8::from(two) << 1 | u8::from(three) << 2)
    }
}
