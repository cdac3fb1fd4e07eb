//! What a pin is set to: mode, pull and speed, whatever the chip.

/// Number of a pin's alternate function; chips with one a pin ignore it.
pub(crate) type AlternateFunction = u8;

/// What a pin is connected to.
#[derive(Clone, Copy)]
pub(crate) enum Mode {
    /// Input, read by the program.
    Input,
    /// Push-pull output, written by the program.
    Output,
    /// Input of a peripheral.
    AlternateInput(AlternateFunction),
    /// Push-pull output of a peripheral.
    AlternateOutput(AlternateFunction),
    /// Open-drain output of a peripheral.
    AlternateOpenDrain(AlternateFunction),
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pull {
    /// None.
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
    /// What it is connected to.
    pub(crate) mode: Mode,
    /// Its resistor.
    pub(crate) pull: Pull,
    /// Its edges.
    pub(crate) speed: Speed,
}

impl PinConfig {
    /// A push-pull output of the program.
    pub(crate) const OUTPUT: Self = Self::new(Mode::Output);
    /// An input of the program.
    pub(crate) const INPUT: Self = Self::new(Mode::Input);

    /// `mode`, without a pull, with slow edges.
    pub(crate) const fn new(mode: Mode) -> Self {
        Self {
            mode,
            pull: Pull::Floating,
            speed: Speed::Low,
        }
    }

    /// The same with a pull-up.
    pub(crate) const fn pulled_up(self) -> Self {
        let pull = Pull::Up;
        Self { pull, ..self }
    }

    /// The same with fast edges.
    pub(crate) const fn fast(self) -> Self {
        let speed = Speed::High;
        Self { speed, ..self }
    }
}
