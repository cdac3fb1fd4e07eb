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
/// a release soon after: a button that sticks, or that something leans on, does nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Button {
    is_down: bool,
    /// Samples in succession that say otherwise.
    changed: u16,
    /// Samples since it went down.
    held: u16,
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
        }
    }

    /// A sample of its level; whether a press has just ended.
    pub fn sample(&mut self, limits: ButtonLimits, is_down: bool) -> bool {
        self.held = self.held.saturating_add(1);
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
        !is_down && held <= limits.longest
    }
}

#[cfg(test)]
mod tests {
    use super::{Button, ButtonLimits};

    const LIMITS: ButtonLimits = ButtonLimits {
        settle: 3,
        longest: 10,
    };

    /// After which samples a press has ended; `-` is down.
    fn presses(levels: &str) -> Vec<usize> {
        let mut button = Button::new();
        let samples = levels.chars().enumerate();
        samples
            .filter_map(|(n, level)| button.sample(LIMITS, level == '-').then_some(n))
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
    fn a_button_that_sticks_does_nothing() {
        assert_eq!(presses("------------------"), [], "for ever");
        assert_eq!(presses("-----'''''"), [], "since the start");
        assert_eq!(presses("'''-------------''''"), [], "for long");
        assert_eq!(presses("-----'''---'''"), [13], "and comes loose");
    }
}
