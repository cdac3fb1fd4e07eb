//! An event as it is written, and what may stand in it.

use std::ops::RangeInclusive;

use scene::{Choice, SensorBytes, SensorSum, SensorWords};
use serde::{Deserialize, Serialize};
use wire::text::Spoken;
use wire::{Command, Load};

use super::{Change, Event, LATEST_S, Part, What};

/// Most bytes of a text.
const MOST_TEXT: usize = 4_096;
/// For how long a button is pressed and power is off, unless the event says so, s.
const SHORT_S: f64 = 0.1;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Kind {
    EncoderStuck,
    EncoderJitter,
    EncoderSlip,
    EncoderScale,
    EncoderReversed,
    MotorReversed,
    Friction,
    Supply,
    Hand,
    Held,
    SensorFrozen,
    SensorGone,
    SensorGarbled,
    SensorUnpowered,
    SelectStuck,
    SensorRestart,
    MagnetGone,
    SensorPart,
    MagnetNear,
    Serial,
    Probe,
    Configuration,
    Button,
    PowerOff,
    ClockLate,
    Reset,
    BusCut,
    BusNoise,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Side {
    Left,
    Right,
}

/// An event as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Written {
    at_s: f64,
    for_s: Option<f64>,
    side: Option<Side>,
    node: Option<u8>,
    kind: Kind,
    counts: Option<u16>,
    share: Option<f64>,
    factor: Option<f64>,
    volts: Option<f64>,
    torque_nm: Option<f64>,
    text: Option<String>,
    request: Option<String>,
    change: Option<Change>,
    words: Option<String>,
    sum_rule: Option<String>,
    byte_order: Option<String>,
    rest_us: Option<f64>,
    update_hz: Option<f64>,
    report: Option<u16>,
    repeat_hz: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WrittenFile {
    pub(super) duration_s: Option<f64>,
    pub(super) seed: Option<u64>,
    #[serde(default)]
    pub(super) event: Vec<Written>,
}

pub(super) fn within(name: &str, value: f64, allowed: RangeInclusive<f64>) -> Result<f64, String> {
    if allowed.contains(&value) {
        return Ok(value);
    }
    let (least, most) = (allowed.start(), allowed.end());
    Err(format!("{name}: found {value}, allowed: {least} to {most}"))
}

fn name_of(kind: Kind) -> String {
    let name = serde_json::to_value(kind).ok();
    name.and_then(|name| Some(name.as_str()?.to_owned()))
        .unwrap_or_default()
}

impl Written {
    pub(super) fn name(&self) -> String {
        name_of(self.kind)
    }

    pub(super) fn read(mut self) -> Result<Event, String> {
        let at_s = within("at_s", self.at_s, 0.0..=LATEST_S)?;
        let for_s = self
            .for_s
            .map(|for_s| within("for_s", for_s, 1e-6..=LATEST_S));
        let for_s = match self.kind {
            Kind::Button | Kind::PowerOff => Some(for_s.unwrap_or(Ok(SHORT_S))?),
            _ => for_s.transpose()?,
        };
        let repeat_hz = match self.kind {
            Kind::Serial | Kind::Probe => self.repeat_hz.take(),
            _ => None,
        };
        if let Some(repeat_hz) = repeat_hz {
            within("repeat_hz", repeat_hz, 1e-3..=1e6)?;
        }
        let what = self.take_what()?;
        self.has_nothing_else()?;
        Ok(Event {
            at_s,
            until_s: for_s.map(|for_s| at_s + for_s),
            side: usize::from(self.side == Some(Side::Right)),
            node: self.node,
            what,
            repeat_hz,
        })
    }

    fn take_what(&mut self) -> Result<What, String> {
        let number = |name: &str, value: Option<f64>, allowed| {
            let value = value.ok_or_else(|| format!("{name}: missing"))?;
            within(name, value, allowed)
        };
        Ok(match self.kind {
            Kind::EncoderStuck => What::Stuck,
            Kind::EncoderJitter => {
                let counts = number("counts", self.counts.take().map(f64::from), 1.0..=10_000.0)?;
                What::Jitter {
                    counts: counts as u16,
                }
            }
            Kind::EncoderSlip => What::Slip {
                share: number("share", self.share.take(), 0.0..=1.0)?,
            },
            Kind::EncoderScale => What::Scale {
                factor: number("factor", self.factor.take(), 0.0..=100.0)?,
            },
            Kind::EncoderReversed => What::Reversed,
            Kind::MotorReversed => What::MotorReversed,
            Kind::Friction => What::Friction {
                factor: number("factor", self.factor.take(), 0.0..=1_000.0)?,
            },
            Kind::Supply => What::Supply {
                volts: number("volts", self.volts.take(), 0.0..=100.0)?,
            },
            Kind::Hand => What::Hand {
                torque_nm: number("torque_nm", self.torque_nm.take(), -1.0..=1.0)?,
            },
            Kind::Held => What::Held,
            Kind::SensorFrozen => What::SensorFrozen,
            Kind::SensorGone => What::SensorGone,
            Kind::SensorGarbled => What::SensorGarbled,
            Kind::SensorUnpowered => What::SensorUnpowered,
            Kind::SelectStuck => What::SelectStuck,
            Kind::SensorRestart => What::SensorRestart,
            Kind::MagnetGone => What::MagnetGone,
            Kind::SensorPart => What::SensorPart { part: self.part()? },
            Kind::MagnetNear => What::MagnetNear,
            Kind::Serial => What::Serial {
                line: text("text", self.text.take())?,
            },
            Kind::Probe => What::Probe {
                command: command(&text("request", self.request.take())?)?,
            },
            Kind::Configuration => What::Configuration {
                change: self.change.take().ok_or("change: missing")?,
            },
            Kind::Button => What::Button,
            Kind::PowerOff => What::PowerOff,
            Kind::ClockLate => What::ClockLate,
            Kind::Reset => What::Reset,
            Kind::BusCut => What::BusCut,
            Kind::BusNoise => What::BusNoise {
                share: number("share", self.share.take(), 0.0..=1.0)?,
            },
        })
    }

    /// The sensor, where it is another than by default.
    fn part(&mut self) -> Result<Part, String> {
        fn choice<T: Choice>(name: &str, word: Option<String>, otherwise: T) -> Result<T, String> {
            let Some(word) = word else {
                return Ok(otherwise);
            };
            let allowed = T::WORDS.join(", ");
            T::of_word(&word).ok_or_else(|| format!("{name}: found {word}, allowed: {allowed}"))
        }
        let words = choice("words", self.words.take(), SensorWords::AlphaBeta)?;
        let sum_rule = choice("sum_rule", self.sum_rule.take(), SensorSum::B1ToB6)?;
        let byte_order = choice("byte_order", self.byte_order.take(), SensorBytes::LowFirst)?;
        let rest_us = self.rest_us.take().unwrap_or_default();
        let update_hz = self.update_hz.take();
        let update_hz = update_hz.map(|hz| within("update_hz", hz, 1.0..=10_000.0));
        Ok(Part {
            decoder: config::decoder_of(words, sum_rule, byte_order),
            rest_us: within("rest_us", rest_us, 0.0..=10_000.0)? as u16,
            update_hz: update_hz.transpose()?.map(|hz| hz as u16),
            report: self.report.take().unwrap_or_default(),
        })
    }

    fn has_nothing_else(&self) -> Result<(), String> {
        let left = [
            ("counts", self.counts.is_some()),
            ("share", self.share.is_some()),
            ("factor", self.factor.is_some()),
            ("volts", self.volts.is_some()),
            ("torque_nm", self.torque_nm.is_some()),
            ("text", self.text.is_some()),
            ("request", self.request.is_some()),
            ("change", self.change.is_some()),
            ("words", self.words.is_some()),
            ("sum_rule", self.sum_rule.is_some()),
            ("byte_order", self.byte_order.is_some()),
            ("rest_us", self.rest_us.is_some()),
            ("update_hz", self.update_hz.is_some()),
            ("report", self.report.is_some()),
            ("repeat_hz", self.repeat_hz.is_some()),
        ];
        let strange = left.iter().find(|(_, is_there)| *is_there);
        strange.map_or(Ok(()), |(name, _)| {
            Err(format!("{name}: not a key of this kind"))
        })
    }
}

fn text(name: &str, text: Option<String>) -> Result<String, String> {
    let text = text.ok_or_else(|| format!("{name}: missing"))?;
    if text.len() > MOST_TEXT {
        let found = text.len();
        return Err(format!("{name}: found {found} bytes, allowed: {MOST_TEXT}"));
    }
    Ok(text)
}

/// What words ask for: as the serial line has them, and two that only programs send.
fn command(words: &str) -> Result<Command, String> {
    let refused = |why: &dyn std::fmt::Display| {
        let allowed = wire::text::ALLOWED;
        Err(format!(
            "request: {words:?}: {why}; allowed: {allowed}, load, restart"
        ))
    };
    match words.trim() {
        // Of a short configuration, which never comes.
        "load" => {
            let load = Load {
                config: 64,
                model: 0,
            };
            return Ok(Command::Load(load));
        }
        "restart" => return Ok(Command::Restart),
        _ => {}
    }
    match wire::text::parse(words.as_bytes()) {
        Ok(Spoken::Command(command)) => Ok(command),
        Ok(_) => refused(&"no command"),
        Err((_, fault)) => refused(&fault),
    }
}
