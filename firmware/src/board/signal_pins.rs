//! The pins that show contact and decisions, where the scene has them.

use embedded_hal::digital::{OutputPin, PinState};
use firmware::{Event, Signals, design_parameters};

use super::gpio::Pin;
use super::pin_config::PinConfig;
use super::scene::{HAS_PINS, TICK_HZ};
use super::wiring::SIGNALS;

/// How long the pin of decisions is high, ticks.
const PULSE: u32 = design_parameters::ticks(design_parameters::DECIDED_S, TICK_HZ) as u32;

/// The pins, or none.
pub(crate) struct SignalPins {
    pins: Option<[Pin; 2]>,
    signals: Signals,
}

impl SignalPins {
    /// Low from now on.
    pub(crate) fn start() -> Self {
        let pin = |name| Pin::new(name, PinConfig::OUTPUT);
        Self {
            pins: HAS_PINS.then(|| SIGNALS.map(pin)),
            signals: Signals::new(),
        }
    }

    /// Notes an event of the tick that is the `now`-th.
    pub(crate) fn note(&mut self, event: &Event, now: u32) {
        if HAS_PINS {
            self.signals.note(event, now);
        }
    }

    /// Brings both to their levels after the tick that is the `now`-th.
    pub(crate) fn show(&mut self, now: u32) {
        let Some(pins) = self.pins.as_mut().filter(|_| HAS_PINS) else {
            return;
        };
        let levels = self.signals.levels(now, PULSE);
        for (pin, level) in pins.iter_mut().zip(levels) {
            let Ok(()) = pin.set_state(PinState::from(level));
        }
    }
}
