//! What a servo does about faults of its motor: it rests and is tried again, or is given up.

use whisking::Real;
use whisking::motor::{self, Guards, MotorDriver};

use super::{FAULTS, HELD, Retry, Servo, ServoConfig, ServoState};
use crate::io::AngleInput;
use crate::{Event, Place};

impl<R: Real, M: MotorDriver, A: AngleInput> Servo<R, M, A> {
    #[cold]
    #[inline(never)]
    pub(super) fn leap(
        &mut self,
        config: &ServoConfig<R>,
        place: Place,
        events: &mut impl FnMut(Event),
    ) {
        if let ServoState::Off | ServoState::GivenUp = self.state {
            return;
        }
        if self.leaps.are_too_many() {
            self.fail(motor::Fault::LostCounts, config, place, events);
        }
    }

    /// The last faults are a tick longer ago. For a motor that was given up they stand still:
    /// where one has passed, it was not its faults that led there but flipped bits.
    #[inline]
    pub(super) fn age(&mut self, retry: Retry) {
        // Nearly always there is none, and nothing to count.
        let [first, second] = self.windows;
        let is_given_up = matches!(self.state, ServoState::GivenUp);
        if is_given_up || first | second | self.until_clear != 0 {
            self.age_faults(retry, is_given_up);
        }
    }

    #[cold]
    #[inline(never)]
    fn age_faults(&mut self, retry: Retry, is_given_up: bool) {
        let limited = |window: u32| window.saturating_sub(1).min(retry.window);
        let [first, second] = self.windows;
        self.until_clear = limited(self.until_clear);
        if !is_given_up {
            self.windows = [limited(first), limited(second)];
        } else if self.held < HELD && self.windows.contains(&0) {
            self.state = ServoState::Off;
        }
    }

    #[cold]
    pub(super) fn rest(&mut self, left: u16, place: Place, events: &mut impl FnMut(Event)) {
        if left > 1 {
            self.state = ServoState::Resting { left: left - 1 };
        } else {
            self.state = ServoState::Off;
            self.motor.clear();
            events(Event::MotorRetry(place));
        }
    }

    #[cold]
    pub(super) fn fail(
        &mut self,
        fault: motor::Fault,
        config: &ServoConfig<R>,
        place: Place,
        events: &mut impl FnMut(Event),
    ) {
        self.motor.off();
        // Whatever it was, the encoder may have lost counts.
        self.is_homed = false;
        if let motor::Fault::LostCounts = fault {
            self.is_known = false;
        }
        events(Event::MotorFault(place, fault));
        let retry = config.retry;
        let did_not_move = matches!(fault, motor::Fault::Stall | motor::Fault::Encoder);
        let running = match &self.state {
            ServoState::Running { guards, .. } if config.guards.model.is_some() => Some(guards),
            _ => None,
        };
        let is_tested = running.is_some_and(Guards::is_tested);
        if did_not_move && running.is_some() {
            self.was_held(retry, place, events);
            return;
        }
        if is_tested {
            // It turned the other way, or left its travel: it is tested first when it runs again,
            // the other way round, as such tests would else add up.
            self.held = self.held.saturating_add(1).min(HELD - 1);
        }
        if fault == motor::Fault::LostCounts && config.homing().is_none() {
            // Nothing finds rest again, and no retry helps.
            self.windows = [retry.window; FAULTS - 1];
        }
        if self.windows.iter().all(|window| *window > 0) {
            self.state = ServoState::GivenUp;
            events(Event::MotorGivenUp(place));
            return;
        }
        // The place of the fault that is longest ago.
        if let Some(oldest) = self.windows.iter_mut().min() {
            *oldest = retry.window;
        }
        let left = retry.rest.max(1);
        self.state = ServoState::Resting { left };
    }

    /// It rests for longer each time, so that what holds it now and then does not meet every test.
    fn was_held(&mut self, retry: Retry, place: Place, events: &mut impl FnMut(Event)) {
        self.held = self.held.saturating_add(1);
        if self.held >= HELD {
            self.state = ServoState::GivenUp;
            events(Event::MotorGivenUp(place));
            return;
        }
        let quarters = 3 + u32::from(self.held);
        let left = (u32::from(retry.rest) * quarters / 4).clamp(1, u32::from(u16::MAX));
        self.state = ServoState::Resting { left: left as u16 };
    }
}
