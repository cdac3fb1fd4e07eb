//! `whisker bringup`: what a module and its sensors say at the first power-up, with motors off.

use std::path::PathBuf;

use clap::Args;
use host_sim::output::Output;
use host_sim::{Error, report};
use mlx90333::FRAME_LEN;
use serde::Serialize;
use wire::{Command, CommandStatus, WhiskerId};

use crate::configuration::Running;
use crate::conversation::Conversation;
use crate::frames::Seen;
use crate::source::SourceChoice;
use crate::tally::SIDES;

/// Which module, and where the report goes.
#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: SourceChoice,
    /// Frames to read of each sensor
    #[arg(long, value_name = "N", default_value = "1000",
          value_parser = clap::value_parser!(u32).range(10..=100_000))]
    frames: u32,
    /// Where to write the report, to be sent with a question
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The report.
#[derive(Debug, Serialize)]
struct Report {
    whisker: &'static str,
    firmware: String,
    scene: String,
    tick_hz: u32,
    sensors: Vec<Sensor>,
}

#[derive(Debug, Serialize)]
struct Sensor {
    side: &'static str,
    seen: Seen,
    findings: Vec<String>,
}

/// Asks the module what it is, and looks at each sensor's frames; motors are stopped before.
pub(crate) fn bringup(arguments: &Arguments) -> Result<(), Error> {
    let json = arguments.json.as_deref().map(Output::create).transpose()?;
    let mut module = arguments.source.module()?;
    let about = module.about()?;
    let origin = module.origin()?;
    let firmware = origin.iter().find(|(key, _)| *key == "firmware");
    let firmware = firmware.map(|(_, value)| value.to_string());
    let mut report = Report {
        whisker: env!("CARGO_PKG_VERSION"),
        firmware: firmware.unwrap_or_default(),
        scene: about.scene.clone(),
        tick_hz: about.tick_hz,
        sensors: Vec::new(),
    };
    report::say(format_args!(
        "module: firmware {}, scene {}, {} ticks a second, whiskers: {}",
        report.firmware, report.scene, report.tick_hz, about.whiskers
    ));
    stop(&mut module)?;
    let takes = Running::ask(&mut module)?.decoder;
    for (number, side) in (0..).zip(SIDES).take(about.whiskers) {
        report::say(format_args!(
            "sensor {side}: move the whisker a little, by hand, while {} frames are read",
            arguments.frames
        ));
        let frames = frames(&mut module, number, arguments.frames)?;
        let seen = Seen::of(&frames);
        let findings = seen.findings(takes);
        report::say(seen.text());
        for finding in &findings {
            report::say(format_args!("sensor {side}: {finding}"));
        }
        if findings.is_empty() {
            report::say(format_args!("sensor {side}: as the scene has it"));
        }
        report.sensors.push(Sensor {
            side,
            seen,
            findings,
        });
    }
    if let Some(json) = json {
        let text = serde_json::to_string_pretty(&report);
        let text = text.map_err(|fault| Error::Work(fault.to_string()))?;
        json.whole(text.as_bytes())?;
    }
    if report
        .sensors
        .iter()
        .all(|sensor| sensor.findings.is_empty())
    {
        return Ok(());
    }
    Err(Error::Work(
        "not every sensor is as the scene has it; docs/troubleshooting.md says more".to_owned(),
    ))
}

/// Motors are off from here on, where there are any.
fn stop(module: &mut Conversation) -> Result<(), Error> {
    match module.answer(Command::Stop)?.status {
        CommandStatus::Done => report::say("motors: off until they are armed"),
        CommandStatus::NoWhisker => report::say("motors: the scene has none"),
        status => return Err(Error::Work(format!("motors: {status}"))),
    }
    Ok(())
}

/// The last frame of a sensor, so many times.
fn frames(module: &mut Conversation, side: u8, count: u32) -> Result<Vec<[u8; FRAME_LEN]>, Error> {
    let whisker = WhiskerId { side, number: 0 };
    let mut frames = Vec::new();
    for _ in 0..count {
        let answer = module.answer(Command::Frame(whisker))?;
        // What it tells beside answers is of no interest here.
        module.take_kept();
        match answer.status {
            CommandStatus::Done => {
                let [high, low] = answer.values.map(i32::cast_unsigned);
                frames.push((u64::from(high) << 32 | u64::from(low)).to_be_bytes());
            }
            CommandStatus::NotHere => break,
            status => return Err(Error::Work(format!("frame: {status}"))),
        }
    }
    Ok(frames)
}
