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

impl Default for Button {
    fn default() -> Self {
        Self::new()
    }
}

impl Button {
    /// A button that has not been asked. It is taken to have been held for long.
    pub const fn new() -> Self {
        Self {
            is_down: true,
            changed: 0,
            held: u16::MAX,
            wait: 0,
        }
    }

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

    fn presses(levels: &str) -> Vec<usize> {
        presses_after_stop(levels, usize::MAX)
    }

    /// After which samples a press has ended, where the `at`-th has stopped the motors; `-` is
    /// down.
    fn presses_after_stop(levels: &str, at: usize) -> Vec<usize> {
        let mut button = Button::new();
        let samples = levels.chars().enumerate();
        samples
            .filter_map(|(n, level)| {
                if n == at {
                    button.has_stopped(LIMITS);
                }
                button.sample(LIMITS, level == '-').then_some(n)
            })
            .collect()
    }

    #[test]
    fn a_press_ends_with_a_release() {
        assert_eq!(presses("'''----'''''"), [9]);
        assert_eq!(presses("'''----'''''---''''"), [9, 17]);
    }

    #[test]
    fn bounces_are_no_presses() {
        assert_eq!(presses("''''-'--''-'--''''"), []);
        assert_eq!(presses("'''-'----'-''-''''"), [16]);
    }

    #[test]
    fn a_push_that_stops_does_not_arm_and_the_next_does() {
        assert_eq!(presses_after_stop("''''----''''''----''''", 4), [20]);
        assert_eq!(
            presses_after_stop("''''-'--'-''''''----''''", 4),
            [22],
            "bounces"
        );
        assert_eq!(
            presses_after_stop("''''-'''''----'''", 4),
            [16],
            "too short to settle"
        );
        assert_eq!(
            presses_after_stop("''''------------------'''''---''''", 4),
            [32],
            "held"
        );
    }

    #[test]
    fn a_button_that_sticks_does_nothing() {
        assert_eq!(presses("------------------"), [], "for ever");
        assert_eq!(presses("-----'''''"), [], "since the start");
        assert_eq!(presses("'''-------------''''"), [], "for long");
        assert_eq!(presses("-----'''---'''"), [13], "and comes loose");
    }
}
