//! A push button: what counts as a press.

/// Durations of a press, in samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ButtonLimits {
    /// Equal samples in succession after which a level counts.
    pub settle: u16,
    /// Longest press.
    pub longest: u16,
}

/// A button that is asked at a steady rate. A press is a release that was seen, a push, and
/// a release soon after: a button that sticks, or that something leans on, arms nothing. A push that
/// [has stopped](Self::has_stopped) the motors is none, until the button has settled again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Button {
    is_down: bool,
    /// Samples in succession that say otherwise.
    changed: u16,
    /// Samples since it went down.
    held: u16,
    /// Samples for which it is to be up before a push counts.
    wait: u16,
}

/// A button that has not been asked is taken to have been held for long.
impl Default for Button {
    fn default() -> Self {
        Self {
            is_down: true,
            changed: 0,
            held: u16::MAX,
            wait: 0,
        }
    }
}

impl Button {
    /// It was down, and that has stopped the motors.
    pub const fn has_stopped(&mut self, limits: ButtonLimits) {
        self.wait = limits.settle;
    }

    /// A sample of its level; whether a press has just ended.
    pub fn sample(&mut self, limits: ButtonLimits, is_down: bool) -> bool {
        self.held = self.held.saturating_add(1);
        let is_waiting = self.wait > 0;
        if is_waiting && is_down {
            self.wait = limits.settle;
        }
        self.wait = self.wait.saturating_sub((!is_down).into());
        if is_down == self.is_down {
            self.changed = 0;
            return false;
        }
        self.changed = self.changed.saturating_add(1);
        if self.changed < limits.settle {
            return false;
        }
        self.is_down = is_down;
        self.changed = 0;
        let held = core::mem::take(&mut self.held);
        !is_down && held <= limits.longest && !is_waiting
    }
}

#[cfg(test)]
mod tests {
    use super::{Button, ButtonLimits};

    const LIMITS: ButtonLimits = ButtonLimits {
        settle: 3,
        longest: 10,
    };

    /// After which samples a press has ended, where the `at`-th has stopped the motors; `-` is
    /// down.
    fn presses(levels: &str, at: Option<usize>) -> Vec<usize> {
        let mut button = Button::default();
        let samples = levels.chars().enumerate();
        samples
            .filter_map(|(n, level)| {
                if Some(n) == at {
                    button.has_stopped(LIMITS);
                }
                button.sample(LIMITS, level == '-').then_some(n)
            })
            .collect()
    }

    #[test]
    fn a_press_ends_with_a_release_and_neither_bounces_nor_sticks() {
        for (levels, expected) in [
            ("'''----'''''", &[9][..]),
            ("'''----'''''---''''", &[9, 17]),
            ("''''-'--''-'--''''", &[]),
            ("'''-'----'-''-''''", &[16]),
            // For ever, since the start, for long, and one that comes loose.
            ("------------------", &[]),
            ("-----'''''", &[]),
            ("'''-------------''''", &[]),
            ("-----'''---'''", &[13]),
        ] {
            assert_eq!(presses(levels, None), expected, "{levels}");
        }
    }

    #[test]
    fn a_push_that_stops_does_not_arm_and_the_next_does() {
        for (levels, expected) in [
            ("''''----''''''----''''", 20),
            // It bounces, is too short to settle, is held.
            ("''''-'--'-''''''----''''", 22),
            ("''''-'''''----'''", 16),
            ("''''------------------'''''---''''", 32),
        ] {
            assert_eq!(presses(levels, Some(4)), [expected], "{levels}");
        }
    }
}
