//! The pins that show contact and decisions, where the scene has them.

use embedded_hal::digital::{OutputPin, PinState};
use firmware::design_parameters::{DECIDED_MS, whole_ticks};
use firmware::{Event, Part, Place};

use super::gpio::Pin;
use super::pace;
use super::pin_config::PinConfig;
use super::wiring::SIGNALS;

pub(crate) struct SignalPins {
    pins: [Pin; 2],
    /// Whiskers that touch something, a bit each.
    touching: u32,
    /// When the pin of decisions was raised, ticks, and for how long it is high.
    decided: Option<u32>,
    pulse: u32,
}

impl SignalPins {
    /// Low from now on; `None` where the scene has none.
    pub(crate) fn start(has_pins: bool) -> Option<Self> {
        let pin = |name| Pin::new(name, PinConfig::OUTPUT);
        let has_pins = Part::Pins.is_built() && has_pins;
        has_pins.then(|| Self {
            pins: SIGNALS.map(pin),
            touching: 0,
            decided: None,
            pulse: whole_ticks(DECIDED_MS, pace::tick_hz()).into(),
        })
    }

    /// Notes an event of the tick that is the `now`-th.
    pub(crate) fn note(&mut self, event: &Event, now: u32) {
        let bit =
            |place: &Place| 1_u32 << ((u32::from(place.side) * 16 + u32::from(place.whisker)) % 32);
        match event {
            Event::Touch { place, .. } => self.touching |= bit(place),
            Event::TouchEnd { place, .. } => self.touching &= !bit(place),
            Event::Decision(..) => self.decided = Some(now),
            _ => {}
        }
    }

    /// Brings both to their levels after the tick that is the `now`-th.
    pub(crate) fn show(&mut self, now: u32) {
        self.decided = self
            .decided
            .filter(|then| now.wrapping_sub(*then) < self.pulse);
        let levels = [self.touching != 0, self.decided.is_some()];
        for (pin, level) in self.pins.iter_mut().zip(levels) {
            let Ok(()) = pin.set_state(PinState::from(level));
        }
    }
}
