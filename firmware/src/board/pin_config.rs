//! What a pin is set to: mode, pull and speed, whatever the chip.

/// Number of a pin's alternate function; chips with one a pin ignore it.
pub(crate) type AlternateFunction = u8;

#[derive(Clone, Copy)]
pub(crate) enum Mode {
    Input,
    /// Push-pull.
    Output,
    AlternateInput(AlternateFunction),
    /// Push-pull.
    AlternateOutput(AlternateFunction),
    AlternateOpenDrain(AlternateFunction),
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pull {
    Floating,
    /// To the supply; for inputs.
    Up,
}

/// How steep an output's edges are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Speed {
    /// The chip's slowest: 2 MHz and more.
    Low,
    /// 10 MHz and more.
    High,
}

#[derive(Clone, Copy)]
pub(crate) struct PinConfig {
    pub(crate) mode: Mode,
    pub(crate) pull: Pull,
    pub(crate) speed: Speed,
}

impl PinConfig {
    pub(crate) const OUTPUT: Self = Self::new(Mode::Output);
    pub(crate) const INPUT: Self = Self::new(Mode::Input);

    pub(crate) const fn new(mode: Mode) -> Self {
        Self {
            mode,
            pull: Pull::Floating,
            speed: Speed::Low,
        }
    }

    pub(crate) const fn pulled_up(self) -> Self {
        let pull = Pull::Up;
        Self { pull, ..self }
    }

    pub(crate) const fn fast(self) -> Self {
        let speed = Speed::High;
        Self { speed, ..self }
    }
}
