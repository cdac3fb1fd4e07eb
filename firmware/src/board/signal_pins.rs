//! The pins that show contact and decisions, where the scene has them.

use embedded_hal::digital::{OutputPin, PinState};
use firmware::design_parameters::{DECIDED_MS, whole_ticks};
use firmware::{Event, Part, Signals};

use super::gpio::Pin;
use super::pace;
use super::pin_config::PinConfig;
use super::wiring::SIGNALS;

pub(crate) struct SignalPins {
    pins: [Pin; 2],
    signals: Signals,
    /// How long the pin of decisions is high, ticks.
    pulse: u32,
}

impl SignalPins {
    /// Low from now on; `None` where the scene has none.
    pub(crate) fn start(has_pins: bool) -> Option<Self> {
        let pin = |name| Pin::new(name, PinConfig::OUTPUT);
        let has_pins = Part::Pins.is_built() && has_pins;
        has_pins.then(|| Self {
            pins: SIGNALS.map(pin),
            signals: Signals::new(),
            pulse: whole_ticks(DECIDED_MS, pace::tick_hz()).into(),
        })
    }

    pub(crate) fn note(&mut self, event: &Event, now: u32) {
        self.signals.note(event, now);
    }

    /// Brings both to their levels after the tick that is the `now`-th.
    pub(crate) fn show(&mut self, now: u32) {
        let levels = self.signals.levels(now, self.pulse);
        for (pin, level) in self.pins.iter_mut().zip(levels) {
            let Ok(()) = pin.set_state(PinState::from(level));
        }
    }
}
