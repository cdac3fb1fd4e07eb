//! The file: a list of events, each with its time, its kind and its value.

use std::fs::File;
use std::io::Read;
use std::ops::RangeInclusive;
use std::path::Path;

use host_sim::Error;
use scene::Scene;
use serde::{Deserialize, Serialize};
use wire::text::Spoken;
use wire::{Command, Load};

use super::wrong;

/// Bytes of the longest file, and most events in it.
const MOST_BYTES: u64 = 1 << 20;
const MOST_EVENTS: usize = 1_000;
/// Most bytes of a text.
const MOST_TEXT: usize = 4_096;
/// Latest time, s.
const LATEST_S: f64 = 3_600.0;
/// For how long a button is pressed and power is off, unless the event says so, s.
const SHORT_S: f64 = 0.1;

/// What can befall a board and what hangs on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Kind {
    EncoderStuck,
    EncoderJitter,
    EncoderSlip,
    EncoderScale,
    EncoderReversed,
    Friction,
    Supply,
    Hand,
    Held,
    SensorFrozen,
    SensorGone,
    MagnetGone,
    Serial,
    Probe,
    Button,
    PowerOff,
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
struct Written {
    at_s: f64,
    for_s: Option<f64>,
    side: Option<Side>,
    kind: Kind,
    counts: Option<u16>,
    share: Option<f64>,
    factor: Option<f64>,
    volts: Option<f64>,
    torque_nm: Option<f64>,
    text: Option<String>,
    request: Option<String>,
    repeat_hz: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenFile {
    duration_s: Option<f64>,
    seed: Option<u64>,
    #[serde(default)]
    event: Vec<Written>,
}

/// What befalls it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum What {
    Stuck,
    Jitter { counts: u16 },
    Slip { share: f64 },
    Scale { factor: f64 },
    Reversed,
    Friction { factor: f64 },
    Supply { volts: f64 },
    Hand { torque_nm: f64 },
    Held,
    SensorFrozen,
    SensorGone,
    MagnetGone,
    Serial { line: String },
    Probe { command: Command },
    Button,
    PowerOff,
}

/// An event.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Event {
    pub(super) at_s: f64,
    /// When it ends; none: not before the run.
    pub(super) until_s: Option<f64>,
    /// 0: left.
    pub(super) side: usize,
    pub(super) what: What,
    pub(super) repeat_hz: Option<f64>,
}

impl Event {
    /// Whether it is there in a tick that begins then.
    pub(super) fn lasts(&self, t_s: f64) -> bool {
        // Times are those of ticks, but for rounding.
        const ROUNDING: f64 = 1e-9;
        let ends = self.until_s.is_some_and(|until| t_s >= until - ROUNDING);
        t_s >= self.at_s - ROUNDING && !ends
    }
}

/// Everything that befalls a board in a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Scenario {
    pub(super) duration_s: Option<f64>,
    pub(super) seed: Option<u64>,
    /// In the order of their times.
    pub(super) events: Vec<Event>,
}

impl Scenario {
    /// Reads a file.
    pub(super) fn load(path: &Path) -> Result<Self, Error> {
        let text = read(path).map_err(|fault| wrong(path, fault))?;
        Self::parse(&text).map_err(|fault| wrong(path, fault))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let written: WrittenFile = toml::from_str(text).map_err(|fault| fault.to_string())?;
        if written.event.len() > MOST_EVENTS {
            let found = written.event.len();
            return Err(format!("found {found} events, allowed: {MOST_EVENTS}"));
        }
        if let Some(duration_s) = written.duration_s {
            within("duration_s", duration_s, 1e-3..=LATEST_S)?;
        }
        let events = (1..).zip(written.event).map(|(n, event)| {
            let name = serde_name(event.kind);
            event
                .read()
                .map_err(|fault| format!("event {n} ({name}): {fault}"))
        });
        let mut events = events.collect::<Result<Vec<_>, _>>()?;
        events.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
        Ok(Self {
            duration_s: written.duration_s,
            seed: written.seed,
            events,
        })
    }

    /// Checks that a scene has everything that events befall.
    pub(super) fn fits(&self, path: &Path, scene: &Scene) -> Result<(), Error> {
        let sides = scene.head.sides.count();
        for event in &self.events {
            let what = &event.what;
            let missing = match what {
                What::Serial { .. } if scene.telemetry.serial_baud.is_none() => {
                    "a serial event, but the scene has no telemetry.serial_baud"
                }
                What::Probe { .. } if !scene.telemetry.rtt => {
                    "a probe event, but the scene has telemetry.rtt = false"
                }
                _ if what.is_at_motor() && scene.motor.is_none() => {
                    "an event of a motor, but the scene has none"
                }
                _ if event.side >= sides => "an event on the right, which the scene has not",
                _ => continue,
            };
            return Err(wrong(path, format_args!("found {missing}")));
        }
        Ok(())
    }
}

fn read(path: &Path) -> Result<String, String> {
    let said = |fault: std::io::Error| fault.to_string();
    // Opening a pipe would wait for whoever writes it.
    if !std::fs::metadata(path).map_err(said)?.is_file() {
        return Err("found no regular file".to_owned());
    }
    let mut text = String::new();
    let file = File::open(path).map_err(said)?;
    file.take(MOST_BYTES + 1)
        .read_to_string(&mut text)
        .map_err(said)?;
    if text.len() as u64 > MOST_BYTES {
        return Err(format!("found more than {MOST_BYTES} bytes"));
    }
    Ok(text)
}

fn within(name: &str, value: f64, allowed: RangeInclusive<f64>) -> Result<f64, String> {
    if allowed.contains(&value) {
        return Ok(value);
    }
    let (least, most) = (allowed.start(), allowed.end());
    Err(format!("{name}: found {value}, allowed: {least} to {most}"))
}

/// The name of a kind in the file.
fn serde_name(kind: Kind) -> String {
    let name = serde_json::to_value(kind).ok();
    name.and_then(|name| Some(name.as_str()?.to_owned()))
        .unwrap_or_default()
}

impl Written {
    fn read(mut self) -> Result<Event, String> {
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
            Kind::MagnetGone => What::MagnetGone,
            Kind::Serial => What::Serial {
                line: text("text", self.text.take())?,
            },
            Kind::Probe => What::Probe {
                command: command(&text("request", self.request.take())?)?,
            },
            Kind::Button => What::Button,
            Kind::PowerOff => What::PowerOff,
        })
    }

    /// Refuses what belongs to other kinds.
    fn has_nothing_else(&self) -> Result<(), String> {
        let left = [
            ("counts", self.counts.is_some()),
            ("share", self.share.is_some()),
            ("factor", self.factor.is_some()),
            ("volts", self.volts.is_some()),
            ("torque_nm", self.torque_nm.is_some()),
            ("text", self.text.is_some()),
            ("request", self.request.is_some()),
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

impl What {
    const fn is_at_motor(&self) -> bool {
        matches!(
            self,
            Self::Stuck
                | Self::Jitter { .. }
                | Self::Slip { .. }
                | Self::Scale { .. }
                | Self::Reversed
                | Self::Friction { .. }
                | Self::Supply { .. }
                | Self::Hand { .. }
                | Self::Held
        )
    }
}

#[cfg(test)]
mod tests;
