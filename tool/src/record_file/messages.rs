//! What a module tells as messages of [MCAP](https://mcap.dev), JSON in channels with a schema
//! each, as Foxglove and others read them.

use std::collections::BTreeMap;
use std::io;

use firmware::{Event, EventRecord, Packet};
use host_sim::origin::{self, Origin};
use host_sim::output::Output;
use host_sim::{decisions, report};
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{McapError, WriteOptions, Writer};
use serde_json::{Value, json};
use tactile::{Pose, Reason};
use wire::TickRecord;

use crate::faults::number;
use crate::table;
use crate::tally::{TickCount, TickTime, side};

const NS: u64 = 1_000_000_000;

/// Messages that are being written. Their time is that of the module, from its first tick; it
/// goes on where the module starts again.
pub(super) struct Messages {
    writer: Writer<NoSeek<Output>>,
    channels: Vec<u16>,
    count: u32,
    tick_hz: u32,
    ticks: TickCount,
    time: TickTime,
    classes: Vec<String>,
}

/// Places among [`CHANNELS`], behind the records of the left and of the right.
const ANSWERS: usize = 2;
const DECISIONS: usize = 3;
const POSES: usize = 4;
const EVENTS: usize = 5;
const LOG: usize = 6;

impl Messages {
    pub(super) fn new(
        output: Output,
        origin: &Origin,
        tick_hz: u32,
        classes: &[String],
    ) -> io::Result<Self> {
        let options = WriteOptions::new()
            .disable_seeking(true)
            .compression(None)
            .library(concat!("whisker ", env!("CARGO_PKG_VERSION")));
        let mut writer = options.create(NoSeek::new(output)).map_err(failed)?;
        let origin = origin.clone().with(origin::TICK_HZ, tick_hz);
        let metadata = origin.iter().map(|(key, value)| (key.into(), value.into()));
        let metadata = Metadata {
            name: "origin".to_owned(),
            metadata: metadata.collect(),
        };
        writer.write_metadata(&metadata).map_err(failed)?;
        let schemas = schemas();
        let channel = |(topic, schema)| {
            let schema_text = json!({"type": "object", "properties": schemas[schema]}).to_string();
            let schema = writer.add_schema(schema, "jsonschema", schema_text.as_bytes())?;
            writer.add_channel(schema, topic, "json", &BTreeMap::new())
        };
        let channels = CHANNELS.into_iter().map(channel);
        let channels = channels.collect::<Result<_, _>>().map_err(failed)?;
        Ok(Self {
            writer,
            channels,
            count: 0,
            tick_hz,
            ticks: TickCount::default(),
            time: TickTime::default(),
            classes: classes.to_vec(),
        })
    }

    pub(super) fn packet(&mut self, packet: &Packet) -> io::Result<()> {
        match packet {
            Packet::Record(record) => self.record(record),
            Packet::Answer(answer) => {
                let message = json!({
                    "t_s": self.t_s(answer.sequence),
                    "tag": answer.tag,
                    "command": answer.command,
                    "status": answer.status.code(),
                    "said": answer.status.to_string(),
                    "values": answer.values,
                });
                self.write(ANSWERS, message.to_string().as_bytes())
            }
            Packet::Event(event) => self.event(event),
        }
    }

    fn event(&mut self, EventRecord { sequence, event }: &EventRecord) -> io::Result<()> {
        let t_s = self.t_s(*sequence);
        // It comes before the record of its tick.
        self.ticks.reach(*sequence);
        let (channel, message) = match event {
            Event::Decision(place, decision) => {
                let among = decisions::among(*decision, &self.classes);
                let message = json!({
                    "t_s": t_s,
                    "side": place.side_name(),
                    "decision": decisions::name(*decision, &self.classes),
                    "posterior": decision.posterior().to_f64(),
                    "samples": decision.samples(),
                    "reason": decision.reason().map_or("", Reason::name),
                    "among": among.as_ref().map_or(&[][..], |among| among),
                });
                (DECISIONS, message)
            }
            Event::Pose(place, Pose { tilt, depth }) => {
                let message = json!({
                    "t_s": t_s,
                    "side": place.side_name(),
                    "tilt_deg": tilt.value(),
                    "tilt_error_deg": tilt.error(),
                    "depth_deg": depth.value(),
                    "depth_error_deg": depth.error(),
                });
                (POSES, message)
            }
            event => {
                let Some((_, said)) = report::said(event, &self.classes) else {
                    return Ok(());
                };
                let fault = number(event).unwrap_or(0);
                let message = json!({"t_s": t_s, "fault": fault, "said": said});
                (EVENTS, message)
            }
        };
        self.write(channel, message.to_string().as_bytes())
    }

    fn record(&mut self, record: &TickRecord) -> io::Result<()> {
        self.ticks.take(record.sequence);
        let message = table::json(record, self.t_s(record.sequence));
        self.write(side(record), message.as_bytes())
    }

    fn t_s(&mut self, sequence: u32) -> f64 {
        self.time.take(sequence) as f64 / f64::from(self.tick_hz)
    }

    pub(super) fn line(&mut self, line: &str) -> io::Result<()> {
        let ns = self.now();
        let level = match line.split(' ').nth(1) {
            Some("DEBUG" | "TRACE") => 1,
            Some("WARN") => 3,
            Some("ERROR") => 4,
            _ => 2,
        };
        let message = json!({
            "timestamp": {"sec": ns / NS, "nsec": ns % NS},
            "level": level,
            "message": line,
            "name": "module",
            "file": "",
            "line": 0,
        });
        self.write(LOG, message.to_string().as_bytes())
    }

    fn now(&self) -> u64 {
        let hz = u64::from(self.tick_hz).max(1);
        // In two steps, lest it overflow.
        let ticks = self.ticks.now();
        ticks / hz * NS + ticks % hz * NS / hz
    }

    fn write(&mut self, channel: usize, data: &[u8]) -> io::Result<()> {
        let now = self.now();
        let header = MessageHeader {
            channel_id: self.channels[channel],
            sequence: self.count,
            log_time: now,
            publish_time: now,
        };
        self.count = self.count.wrapping_add(1);
        self.writer
            .write_to_known_channel(&header, data)
            .map_err(failed)
    }

    /// What it was written to, all messages in it.
    pub(super) fn finish(mut self) -> io::Result<Output> {
        self.writer.finish().map_err(failed)?;
        Ok(self.writer.into_inner().into_inner())
    }
}

fn failed(error: McapError) -> io::Error {
    match error {
        McapError::Io(error) => error,
        error => io::Error::other(error),
    }
}

/// Topic and schema of each channel; the log's is the one that Foxglove's panel of logs reads.
const CHANNELS: [(&str, &str); 7] = [
    ("/left/records", "whisker.Record"),
    ("/right/records", "whisker.Record"),
    ("/answers", "whisker.Answer"),
    ("/decisions", "whisker.Decision"),
    ("/poses", "whisker.Pose"),
    ("/events", "whisker.Event"),
    ("/log", "foxglove.Log"),
];

/// What is in the messages of each schema.
fn schemas() -> Value {
    json!({
        "whisker.Record": table::schema(),
        "whisker.Answer": {
            "t_s": {"type": "number", "description": "when it was carried out, s"},
            "tag": {"type": "integer", "description": "that of the request"},
            "command": {"type": "integer", "description": "its number (docs/protocol.md)"},
            "status": {"type": "integer", "description": "0 done, otherwise refused"},
            "said": {"type": "string", "description": "the status in words"},
            "values": {"type": "array", "items": {"type": "integer"}},
        },
        "whisker.Decision": {
            "t_s": {"type": "number", "description": "when it fell, s"},
            "side": {"type": "string"},
            "decision": {"type": "string", "description": "the class, or unknown"},
            "posterior": {"type": "number", "description": "its probability, 0 to 1"},
            "samples": {"type": "integer", "description": "samples that it used"},
            "reason": {
                "type": "string",
                "description": "why no class is named: unknown, pose or between; otherwise empty",
            },
            "among": {
                "type": "array",
                "items": {"type": "string"},
                "description": "the two classes of between, the likelier one first; otherwise empty",
            },
        },
        "whisker.Pose": {
            "t_s": {"type": "number", "description": "when its decision fell, s"},
            "side": {"type": "string"},
            "tilt_deg": {"type": "number", "description": "tilt of what was named"},
            "tilt_error_deg": {"type": "number", "description": "root mean square of its error"},
            "depth_deg": {"type": "number", "description": "depth of contact"},
            "depth_error_deg": {"type": "number", "description": "root mean square of its error"},
        },
        "whisker.Event": {
            "t_s": {"type": "number", "description": "when it was, s"},
            "fault": {"type": "integer", "description": "its number (docs/faults.md); 0: none"},
            "said": {"type": "string", "description": "what (docs/protocol.md)"},
        },
        "foxglove.Log": {
            "timestamp": {
                "type": "object",
                "title": "time",
                "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}},
            },
            "level": {"type": "integer", "description": "1 debug, 2 info, 3 warning, 4 error"},
            "message": {"type": "string"},
            "name": {"type": "string"},
            "file": {"type": "string"},
            "line": {"type": "integer"},
        },
    })
}
