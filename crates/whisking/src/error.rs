//! The error of settings: one small value that names the parameter.

use core::fmt;
use core::ops::RangeInclusive;

use crate::{MAX_SIDES, MAX_WHISKERS, ranges};

/// A setting that can be refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// Control rate, Hz.
    TickHz,
    /// Whisk frequency f_W, Hz.
    Frequency,
    /// Standard deviation σ_η of the oscillators' noise.
    Noise,
    /// A nominal gain g.
    Gain,
    /// A start state ψ.
    Start,
    /// The number of sides or of whiskers.
    Size,
    /// Gain or time constant of RCP.
    Rcp,
    /// Gain or time constant of CIA.
    Cia,
    /// Corner frequency of the low-pass filter, Hz.
    Corner,
    /// A gain of the position control.
    Pd,
}

/// A setting is not finite or outside its range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Error {
    /// The setting.
    pub parameter: Parameter,
}

impl Error {
    /// A NaN lies in no range.
    pub(crate) fn check(
        parameter: Parameter,
        value: f64,
        range: &RangeInclusive<f64>,
    ) -> Result<f64, Self> {
        if range.contains(&value) {
            Ok(value)
        } else {
            Err(Self { parameter })
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let gate = format_args!(
            "a gain of {}, a time constant of {:e} to {:e} s",
            Allowed(&ranges::GATE_GAIN),
            ranges::GATE_TAU_S.start(),
            ranges::GATE_TAU_S.end(),
        );
        let (name, allowed) = match self.parameter {
            Parameter::TickHz => (
                "tick rate",
                format_args!("{} Hz", Allowed(&ranges::TICK_HZ)),
            ),
            Parameter::Frequency => (
                "whisk frequency",
                format_args!("{} Hz", Allowed(&ranges::FREQUENCY_HZ)),
            ),
            Parameter::Noise => ("noise", format_args!("{}", Allowed(&ranges::NOISE))),
            Parameter::Gain => ("nominal gain", format_args!("{}", Allowed(&ranges::GAIN))),
            Parameter::Start => ("start state", format_args!("{}", Allowed(&ranges::PSI))),
            Parameter::Size => (
                "number of sides or whiskers",
                format_args!("1 to {MAX_SIDES} sides, {MAX_WHISKERS} whiskers in all"),
            ),
            Parameter::Rcp => ("RCP", gate),
            Parameter::Cia => ("CIA", gate),
            Parameter::Corner => (
                "corner frequency",
                format_args!("above zero, below half the tick rate"),
            ),
            Parameter::Pd => (
                "position control",
                format_args!("finite, not negative, minimum below maximum"),
            ),
        };
        write!(f, "{name} out of range: allowed is {allowed}")
    }
}

struct Allowed<'a>(&'a RangeInclusive<f64>);

impl fmt::Display for Allowed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", self.0.start(), self.0.end())
    }
}

impl core::error::Error for Error {}
