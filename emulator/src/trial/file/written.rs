//! An event as it is written, and what may stand in it.

use std::ops::RangeInclusive;

use mlx90333::Decoder;
use scene::Choice;
use serde::Deserialize;
use toml::Table;
use wire::text::Spoken;
use wire::{Command, Load};

use super::{Asked, Event, LATEST_S, Part, What};

const MOST_TEXT: usize = 4_096;
/// For how long a button is pressed and power is off, unless the event says so, s.
const SHORT_S: f64 = 0.1;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Side {
    Left,
    Right,
}

/// What every event has; the other keys are those of its kind.
#[derive(Debug, Deserialize)]
struct Common {
    at_s: f64,
    for_s: Option<f64>,
    side: Option<Side>,
    node: Option<u8>,
    kind: String,
    repeat_hz: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WrittenFile {
    pub(super) duration_s: Option<f64>,
    pub(super) seed: Option<u64>,
    #[serde(default)]
    pub(super) event: Vec<Table>,
}

/// What is left out is as usual.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct WrittenPart {
    words: Option<String>,
    sum_rule: Option<String>,
    byte_order: Option<String>,
    rest_us: f64,
    update_hz: Option<f64>,
    report: u16,
}

pub(super) fn within(name: &str, value: f64, allowed: RangeInclusive<f64>) -> Result<f64, String> {
    if allowed.contains(&value) {
        return Ok(value);
    }
    let (least, most) = (allowed.start(), allowed.end());
    Err(format!("{name}: found {value}, allowed: {least} to {most}"))
}

pub(super) fn read_event(mut event: Table) -> Result<Event, String> {
    let said = |fault: toml::de::Error| fault.message().to_owned();
    let common: Common = event.clone().try_into().map_err(said)?;
    for key in ["at_s", "for_s", "side", "node", "kind"] {
        event.remove(key);
    }
    let is_sent = matches!(&*common.kind, "serial" | "probe");
    if let Some(repeat_hz) = common.repeat_hz
        && is_sent
    {
        within("repeat_hz", repeat_hz, 1e-3..=1e6)?;
        event.remove("repeat_hz");
    }
    let what = what(&common.kind, event)?;
    let at_s = within("at_s", common.at_s, 0.0..=LATEST_S)?;
    let is_short = matches!(what, What::Button | What::PowerOff | What::SensorRestart);
    let for_s = common.for_s.or(is_short.then_some(SHORT_S));
    let for_s = for_s.map(|for_s| within("for_s", for_s, 1e-6..=LATEST_S));
    Ok(Event {
        at_s,
        until_s: for_s.transpose()?.map(|for_s| at_s + for_s),
        side: usize::from(common.side == Some(Side::Right)),
        node: common.node,
        what,
        repeat_hz: common.repeat_hz,
    })
}

/// What befalls the board, by its kind and the keys that only this has.
fn what(kind: &str, keys: Table) -> Result<What, String> {
    let names = keys.keys().cloned().collect::<Vec<_>>().join(", ");
    let what = Table::from_iter([(kind.to_owned(), toml::Value::from(keys))]).try_into();
    let what = what.map_err(|fault: toml::de::Error| match &*names {
        "" => fault.message().to_owned(),
        names => format!("{names}: {}", fault.message()),
    })?;
    match &what {
        What::EncoderJitter { counts } => {
            within("counts", f64::from(*counts), 1.0..=10_000.0)?;
        }
        What::EncoderSlip { share } | What::BusNoise { share } => {
            within("share", *share, 0.0..=1.0)?;
        }
        What::EncoderScale { factor } => _ = within("factor", *factor, 0.0..=100.0)?,
        What::Friction { factor } => _ = within("factor", *factor, 0.0..=1_000.0)?,
        What::Supply { volts } => _ = within("volts", *volts, 0.0..=100.0)?,
        What::Hand { torque_nm } => _ = within("torque_nm", *torque_nm, -1.0..=1.0)?,
        What::Jumpers { number } => _ = within("number", f64::from(*number), 0.0..=31.0)?,
        What::Serial { text } if text.len() > MOST_TEXT => {
            let found = text.len();
            return Err(format!("text: found {found} bytes, allowed: {MOST_TEXT}"));
        }
        _ => {}
    }
    Ok(what)
}

impl TryFrom<WrittenPart> for Part {
    type Error = String;

    fn try_from(part: WrittenPart) -> Result<Self, String> {
        fn choice<T: Choice + Default>(name: &str, word: Option<String>) -> Result<T, String> {
            let Some(word) = word else {
                return Ok(T::default());
            };
            let allowed = T::WORDS.join(", ");
            T::of_word(&word).ok_or_else(|| format!("{name}: found {word}, allowed: {allowed}"))
        }
        let decoder = Decoder {
            mode: choice("words", part.words)?,
            sum_rule: choice("sum_rule", part.sum_rule)?,
            byte_order: choice("byte_order", part.byte_order)?,
        };
        let update_hz = part.update_hz;
        let update_hz = update_hz.map(|hz| within("update_hz", hz, 1.0..=10_000.0));
        Ok(Self {
            decoder,
            rest_us: within("rest_us", part.rest_us, 0.0..=10_000.0)? as u16,
            update_hz: update_hz.transpose()?.map(|hz| hz as u16),
            report: part.report,
        })
    }
}

/// As the serial line has commands, and two that only programs send.
impl TryFrom<String> for Asked {
    type Error = String;

    fn try_from(words: String) -> Result<Self, String> {
        let why = match words.trim() {
            // Of a short configuration, which never comes.
            "load" => {
                return Ok(Self(Command::Load(Load {
                    config: 64,
                    model: 0,
                })));
            }
            "restart" => return Ok(Self(Command::Restart)),
            _ => match wire::text::parse(words.as_bytes()) {
                Ok(Spoken::Command(command)) => return Ok(Self(command)),
                Ok(_) => "no command".to_owned(),
                Err((_, fault)) => fault.to_string(),
            },
        };
        let allowed = wire::text::ALLOWED;
        Err(format!(
            "request: {words:?}: {why}; allowed: {allowed}, load, restart"
        ))
    }
}
