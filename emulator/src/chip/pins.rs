//! What hangs on the chip's pins, from outside: motors, encoders, Hall sensors,
//! sensors. A line whose pin is not its peripheral's is not connected.

use super::Chip;
use super::gpio::Role;
use super::model::Unit;
use super::wiring::{BUTTON, ENABLES, HALLS, PWM, Pin, SIGNALS};

impl Chip {
    fn role(&self, Pin { port, number }: Pin) -> Role {
        self.gpio[port].role(number)
    }

    pub(super) fn drives(&self, pins: &[Pin], function: u32) -> bool {
        let mut roles = pins.iter().map(|&pin| self.role(pin));
        roles.all(|role| role == Role::Alternate(function))
    }

    pub(super) fn hears(&self, pins: &[Pin], function: u32) -> bool {
        let mut pins = pins.iter();
        pins.all(|pin| self.gpio[pin.port].feeds(pin.number, function))
    }

    pub(crate) fn set_encoder(&mut self, side: usize, position: i32) {
        let wires = &self.model.wiring.sides[side];
        let connected = self.hears(&wires.pins.encoder, wires.encoder_function);
        self.timers[wires.encoder_timer].set_position(position, connected);
    }

    pub(crate) fn set_halls(&mut self, levels: [bool; 3]) {
        for (Pin { port, number }, high) in HALLS.into_iter().zip(levels) {
            // A line that the debugger keeps is not the port's.
            let kept = self.has(Unit::Remap) && self.remap.keeps(port, number);
            self.gpio[port].drive(number, high || kept);
        }
    }

    pub(crate) fn set_button(&mut self, is_down: bool) {
        self.gpio[BUTTON.port].drive(BUTTON.number, !is_down);
    }

    /// Duty on the motors' PWM pins, counts of a period of counts; zero where the pin
    /// is not the timer's.
    pub(crate) fn motor_duties(&self) -> [(u32, u32); 3] {
        [0, 1, 2].map(|channel| {
            let (on, period) = self.timers[self.model.wiring.pwm_timer].duty(channel);
            match self.role(PWM[channel as usize]) {
                Role::Alternate(function) if function == self.model.wiring.pwm_function => {
                    (on, period)
                }
                Role::Output(true) => (period, period),
                _ => (0, period),
            }
        })
    }

    pub(crate) fn drives_a_motor(&self) -> bool {
        self.motor_duties().iter().any(|(on, _)| *on > 0)
    }

    fn is_high(&self, pin: Pin) -> bool {
        self.role(pin) == Role::Output(true)
    }

    /// Level of the direction of each side's H-bridge. A pin that is not driven is low.
    pub(crate) fn motor_directions(&self) -> [bool; 2] {
        [0, 1].map(|side| {
            let side = self.model.wiring.sides.get(side);
            side.is_some_and(|side| self.is_high(side.pins.direction))
        })
    }

    pub(crate) fn motor_enables(&self) -> [bool; 3] {
        ENABLES.map(|pin| self.is_high(pin))
    }

    /// Levels of the pins of contact and of decisions. A pin that is not driven is low.
    pub(crate) fn signals(&self) -> [bool; 2] {
        SIGNALS.map(|pin| self.is_high(pin))
    }

    /// Whether the pins and mode of a side's SPI are those that the sensor's wires need.
    pub(super) fn sensor_is_connected(&self, side: usize) -> bool {
        let [sck, miso, mosi] = self.model.wiring.sides[side].pins.spi;
        let function = self.model.wiring.spi_function;
        let (mode, is_joined) = self.lines[side].wires();
        self.drives(&[sck, mosi], function)
            && self.hears(&[miso], function)
            && self.gpio[mosi.port].is_open_drain(mosi.number) == is_joined
            && self.spis[side].mode() == Some(mode)
    }

    pub(super) fn select_sensors(&mut self) {
        for (side, wires) in self.model.wiring.sides.iter().enumerate() {
            let low = self.role(wires.pins.select) == Role::Output(false);
            self.lines[side].select(low, self.now);
        }
    }
}
