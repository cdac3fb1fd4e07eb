//! The file: a list of events, each with its time, its kind and its value.

mod written;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use host_sim::Error;
use mlx90333::Decoder;
use scene::{Scene, SensorModel};
use serde::Deserialize;
use wire::Command;

use written::{WrittenFile, WrittenPart, read_event, within};

/// Bytes of the longest file, and most events in it.
const MOST_BYTES: u64 = 1 << 20;
const MOST_EVENTS: usize = 1_000;
const LATEST_S: f64 = 3_600.0;

/// What befalls a board, by the words and keys of the file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum What {
    EncoderStuck,
    EncoderJitter { counts: u16 },
    EncoderSlip { share: f64 },
    EncoderScale { factor: f64 },
    EncoderReversed,
    MotorReversed,
    Friction { factor: f64 },
    Supply { volts: f64 },
    Hand { torque_nm: f64 },
    Held,
    SensorFrozen,
    SensorGone,
    SensorGarbled,
    SensorUnpowered,
    SelectStuck,
    SensorRestart,
    MagnetGone,
    SensorPart(Part),
    MagnetNear,
    Serial { text: String },
    Probe { request: Asked },
    Configuration { change: Change },
    Button,
    PowerOff,
    ClockLate,
    Reset,
    Jumpers { number: u8 },
    BusCut,
    BusNoise { share: f64 },
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(try_from = "String")]
pub(super) struct Asked(pub(super) Command);

/// A sensor that is another part, or programmed otherwise, than the scene has it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(try_from = "WrittenPart")]
pub(super) struct Part {
    pub(super) decoder: Decoder,
    /// It is silent in frames that come sooner after the last, µs.
    pub(super) rest_us: u16,
    /// So often it has a new reading; none: in each frame.
    pub(super) update_hz: Option<u16>,
    pub(super) report: u16,
}

/// What a configuration that is sent has in place of the board's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Change {
    /// No guard is ever met.
    NoLimits,
    /// Some guards are as wide as a board takes them.
    WideLimits,
    /// Twenty times `kp`, and no `kd`.
    WildGains,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Event {
    pub(super) at_s: f64,
    /// When it ends; none: not before the run.
    pub(super) until_s: Option<f64>,
    /// 0: left.
    pub(super) side: usize,
    /// Which board of a head it befalls; none: of a scene that is one, the first.
    pub(super) node: Option<u8>,
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

    /// Whether this one, other than `event` but of its kind and node, has begun before `t_s` and lasts.
    pub(super) fn goes_on(&self, event: &Self, t_s: f64) -> bool {
        let kind = std::mem::discriminant(&self.what) == std::mem::discriminant(&event.what);
        let lasts = self.what.lasts_at_board() && self.at_s < t_s && self.lasts(t_s);
        kind && lasts && self.node == event.node && !std::ptr::eq(self, event)
    }
}

#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Scenario {
    pub(super) duration_s: Option<f64>,
    pub(super) seed: Option<u64>,
    /// In the order of their times.
    pub(super) events: Vec<Event>,
}

impl Scenario {
    pub(super) fn load(path: &Path) -> Result<Self, Error> {
        let parsed = read(path).and_then(|text| Self::parse(&text));
        parsed.map_err(|fault| Error::file(path, fault))
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
            let kind = event.get("kind").and_then(toml::Value::as_str);
            let kind = kind.unwrap_or("of no kind").to_owned();
            read_event(event).map_err(|fault| format!("event {n} ({kind}): {fault}"))
        });
        let mut events = events.collect::<Result<Vec<_>, _>>()?;
        events.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
        Ok(Self {
            duration_s: written.duration_s,
            seed: written.seed,
            events,
        })
    }

    pub(super) fn fits(&self, path: &Path, scene: &Scene) -> Result<(), Error> {
        let sides = scene.head.sides.count();
        for event in &self.events {
            let what = &event.what;
            let missing = match what {
                What::Reset | What::Jumpers { .. } | What::BusCut | What::BusNoise { .. }
                    if scene.head.nodes.is_none() =>
                {
                    "an event of a head, but the scene has no head.nodes"
                }
                _ if event.node.unwrap_or(0) >= scene.head.nodes.unwrap_or(1) => {
                    "an event of a node that the scene has not"
                }
                _ if scene.head.nodes.is_some() && !what.is_of_head() => {
                    "an event that befalls no board of a head"
                }
                _ if scene.head.nodes.is_some() && event.repeat_hz.is_some() => {
                    "repeat_hz, which events of a head do not have"
                }
                What::Serial { .. } | What::Configuration { .. }
                    if scene.telemetry.serial_baud.is_none() =>
                {
                    "a serial event, but the scene has no telemetry.serial_baud"
                }
                What::Probe { .. } if !scene.telemetry.rtt => {
                    "a probe event, but the scene has telemetry.rtt = false"
                }
                _ if what.is_at_motor() && scene.motor.is_none() => {
                    "an event of a motor, but the scene has none"
                }
                What::SensorPart(_) | What::SelectStuck | What::SensorUnpowered
                    if scene.sensor.model != SensorModel::Mlx90333 =>
                {
                    "an event of an MLX90333, but the scene has another sensor"
                }
                What::SensorRestart | What::MagnetNear
                    if scene.sensor.model != SensorModel::Tmag5170 =>
                {
                    "an event of a TMAG5170, but the scene has another sensor"
                }
                _ if event.side >= sides => "an event on the right, which the scene has not",
                _ => continue,
            };
            return Err(Error::file(path, format_args!("found {missing}")));
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
    let mut file = file.take(MOST_BYTES + 1);
    file.read_to_string(&mut text).map_err(said)?;
    if text.len() as u64 > MOST_BYTES {
        return Err(format!("found more than {MOST_BYTES} bytes"));
    }
    Ok(text)
}

impl What {
    /// Whether it is a state of a board of a head, which ends.
    const fn lasts_at_board(&self) -> bool {
        matches!(self, Self::PowerOff | Self::BusCut | Self::BusNoise { .. })
    }

    const fn is_of_head(&self) -> bool {
        matches!(
            self,
            Self::Serial { .. }
                | Self::Probe { .. }
                | Self::PowerOff
                | Self::Reset
                | Self::Jumpers { .. }
                | Self::BusCut
                | Self::BusNoise { .. }
        )
    }

    const fn is_at_motor(&self) -> bool {
        matches!(
            self,
            Self::EncoderStuck
                | Self::EncoderJitter { .. }
                | Self::EncoderSlip { .. }
                | Self::EncoderScale { .. }
                | Self::EncoderReversed
                | Self::MotorReversed
                | Self::Friction { .. }
                | Self::Supply { .. }
                | Self::Hand { .. }
                | Self::Held
                | Self::Configuration { .. }
        )
    }
}

#[cfg(test)]
mod tests;
