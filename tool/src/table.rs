//! Records as a table of comma-separated values.

use std::fmt::Write as _;
use std::io::{self, Write};

use host_sim::origin::{self, Origin};
use host_sim::recording;
use wire::{Flags, TickRecord};

use crate::sample::Sample;
use crate::tally::{SIDES, TickTime, side};

const FLAGS: [(&str, Flags); 10] = [
    ("fresh", Flags::FRESH),
    ("valid", Flags::VALID),
    ("armed", Flags::ARMED),
    ("running", Flags::RUNNING),
    ("homing", Flags::HOMING),
    ("resting", Flags::RESTING),
    ("touching", Flags::TOUCHING),
    ("decided", Flags::DECIDED),
    ("fault", Flags::FAULT),
    ("lost", Flags::LOST),
];

const SIDE: &str = "side";
const NUMBERS: [&str; 10] = [
    "sequence",
    "t_s",
    SIDE,
    "x",
    "y",
    "setpoint_deg",
    "measured_deg",
    "duty",
    "z",
    "contact",
];

const FULL: f32 = 32767.0;

/// The columns of numbers of a record at a time, s, as text; the side is a name.
fn numbers(record: &TickRecord, t_s: f64) -> [String; NUMBERS.len()] {
    let sample = Sample::new(record, t_s);
    let [x, y] = sample.codes;
    // A record has no more digits than these.
    let short = |value: f64| (value as f32).to_string();
    [
        record.sequence.to_string(),
        sample.t_s.to_string(),
        SIDES[side(record)].to_owned(),
        x.to_string(),
        y.to_string(),
        short(sample.setpoint_deg),
        short(sample.measured_deg),
        short(sample.duty),
        short(sample.z),
        short(sample.contact),
    ]
}

/// The keys are the table's columns. Rust writes finite numbers as JSON has them.
pub(crate) fn json(record: &TickRecord, t_s: f64) -> String {
    let mut text = String::with_capacity(320);
    for (name, number) in NUMBERS.iter().zip(numbers(record, t_s)) {
        let before = if text.is_empty() { '{' } else { ',' };
        let quote = if *name == SIDE { "\"" } else { "" };
        // Writing to a string does not fail.
        let _ = write!(text, "{before}\"{name}\":{quote}{number}{quote}");
    }
    for (name, flag) in FLAGS {
        let so = record.flags.contains(flag);
        let _ = write!(text, ",\"{name}\":{so}");
    }
    text.push('}');
    text
}

/// The properties of such an object, as a JSON schema has them.
pub(crate) fn schema() -> serde_json::Value {
    let kind = |name: &str| match name {
        SIDE => "string",
        "sequence" | "x" | "y" => "integer",
        _ => "number",
    };
    let numbers = NUMBERS.iter().map(|name| (*name, kind(name)));
    let flags = FLAGS.iter().map(|(name, _)| (*name, "boolean"));
    let properties = numbers.chain(flags);
    let properties =
        properties.map(|(name, kind)| (name.to_owned(), serde_json::json!({"type": kind})));
    serde_json::Value::Object(properties.collect())
}

pub(crate) struct RecordWriter<W: Write> {
    table: csv::Writer<W>,
    tick_hz: f64,
    time: TickTime,
}

impl<W: Write> RecordWriter<W> {
    /// Writes what is above the first row; `tick_hz` are the module's ticks a second.
    pub(crate) fn new(mut to: W, origin: Origin, tick_hz: u32) -> io::Result<Self> {
        origin.with(origin::TICK_HZ, tick_hz).write(&mut to)?;
        let mut table = csv::Writer::from_writer(to);
        let flags = FLAGS.iter().map(|(name, _)| *name);
        table.write_record(NUMBERS.into_iter().chain(flags))?;
        Ok(Self {
            table,
            tick_hz: f64::from(tick_hz),
            time: TickTime::default(),
        })
    }

    pub(crate) fn row(&mut self, record: &TickRecord) -> io::Result<()> {
        let t_s = self.time.take(record.sequence) as f64 / self.tick_hz;
        let numbers = numbers(record, t_s);
        let digit = |so| if so { "1" } else { "0" };
        let flags = FLAGS.map(|(_, flag)| digit(record.flags.contains(flag)));
        let numbers = numbers.iter().map(String::as_str);
        self.table.write_record(numbers.chain(flags))?;
        Ok(())
    }

    /// What it was written to, all rows in it.
    pub(crate) fn finish(self) -> io::Result<W> {
        self.table
            .into_inner()
            .map_err(csv::IntoInnerError::into_error)
    }
}

#[derive(Debug)]
pub(crate) struct Kept {
    pub(crate) origin: Origin,
    pub(crate) tick_hz: Option<u32>,
    pub(crate) records: Vec<TickRecord>,
}

/// A flag, as we write it, or as tables of other programs have it.
fn truth(text: &str) -> Option<bool> {
    match text.to_ascii_lowercase().as_str() {
        "1" | "1.0" | "true" => Some(true),
        "0" | "0.0" | "false" => Some(false),
        _ => None,
    }
}

pub(crate) fn read(file: &[u8]) -> Result<Kept, String> {
    if let Some(fault) = origin::foreign(file) {
        return Err(fault);
    }
    let (origin, above, rows) = origin::split(file);
    let tick_hz = origin.tick_hz();
    let mut table = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(rows);
    let broken = |error: csv::Error| recording::broken(&error, rows, above);
    let header = table.headers().map_err(broken)?.clone();
    let place = |name: &str| {
        let found = header.iter().position(|column| column == name);
        found.ok_or_else(|| format!("line {}: no column {name:?}", above + 1))
    };
    let mut numbers = [0; NUMBERS.len()];
    for (number, name) in numbers.iter_mut().zip(NUMBERS) {
        *number = place(name)?;
    }
    let flags = FLAGS.iter().map(|(name, flag)| Ok((place(name)?, *flag)));
    let flags = flags.collect::<Result<Vec<_>, String>>()?;
    let mut records = Vec::new();
    for row in table.records() {
        let row = row.map_err(broken)?;
        let line = recording::line_of(rows, above, row.position());
        let cell = |n: usize| row.get(numbers[n]).unwrap_or_default();
        let wrong = |n: usize, text: &str| format!("line {line}: {} is {text:?}", NUMBERS[n]);
        let number = |n: usize, lowest: f32, highest: f32| {
            let text = cell(n);
            let value = text.parse::<f32>().ok();
            let value = value.filter(|value| (lowest..=highest).contains(value));
            value.ok_or_else(|| wrong(n, text))
        };
        let q13 = |n: usize| Ok::<_, String>((number(n, -4.0, 4.0)? * 8192.0).round() as i16);
        let angle = |n: usize| {
            let protraction = (number(n, -350.0, 450.0)? - 50.0) / 100.0;
            Ok::<_, String>((protraction * 8192.0).round() as i16)
        };
        let code = |n: usize| Ok::<_, String>((number(n, 0.0, 16383.0)? as u16) << 2);
        let side = SIDES.iter().position(|side| cell(2) == *side);
        let side = side.ok_or_else(|| wrong(2, cell(2)))?;
        let mut said = Flags::RIGHT.when(side > 0);
        for (place, flag) in &flags {
            let text = row.get(*place).unwrap_or_default();
            let is_set = truth(text).ok_or_else(|| {
                let name = header.get(*place).unwrap_or_default();
                format!("line {line}: {name} is {text:?}, allowed: 0 or 1")
            })?;
            said = said | flag.when(is_set);
        }
        let sequence = cell(0);
        records.push(TickRecord {
            sequence: sequence.parse().map_err(|_| wrong(0, sequence))?,
            x: code(3)?,
            y: code(4)?,
            setpoint: angle(5)?,
            measured: angle(6)?,
            duty: (number(7, -1.0, 1.0)? * FULL).round() as i16,
            z: q13(8)?,
            contact: q13(9)?,
            flags: said,
        });
    }
    Ok(Kept {
        tick_hz: tick_hz?,
        origin,
        records,
    })
}

#[cfg(test)]
mod tests {
    use host_sim::origin::Origin;
    use wire::{Flags, TickRecord};

    use super::{FLAGS, RecordWriter, read};

    fn written(records: &[TickRecord]) -> Vec<u8> {
        let origin = Origin::default().with("scene", "bench");
        let mut table = RecordWriter::new(Vec::new(), origin, 2000).unwrap();
        for record in records {
            table.row(record).unwrap();
        }
        table.finish().unwrap()
    }

    #[test]
    fn numbers_have_their_units() {
        let record = TickRecord {
            sequence: 500,
            x: 4 * 8200,
            y: 4 * 16383,
            setpoint: 4096,
            measured: -4096,
            duty: -32767,
            z: 2048,
            contact: 8192,
            flags: Flags::RIGHT | Flags::VALID | Flags::TOUCHING,
        };
        let text = String::from_utf8(written(&[record])).unwrap();
        assert_eq!(
            text,
            "# scene = bench\n# tick_hz = 2000\n\
             sequence,t_s,side,x,y,setpoint_deg,measured_deg,duty,z,contact,\
             fresh,valid,armed,running,homing,resting,touching,decided,fault,lost\n\
             500,0.25,right,8200,16383,100,0,-1,0.25,1,0,1,0,0,0,0,1,0,0,0\n"
        );
    }

    #[test]
    fn what_is_written_is_read() {
        let flags = |n: u16| {
            let flags = FLAGS.iter().enumerate();
            let right = Flags::RIGHT.when(n & 1 > 0);
            flags.fold(right, |all, (bit, (_, flag))| {
                all | flag.when(n >> bit & 1 > 0)
            })
        };
        let records: Vec<TickRecord> = (0..=u16::MAX)
            .step_by(17)
            .map(|n| TickRecord {
                sequence: u32::from(n) << 16,
                x: n & !3,
                y: !n & !3,
                setpoint: n.cast_signed(),
                measured: (!n).cast_signed(),
                duty: n.cast_signed().max(-32767),
                z: n.cast_signed().wrapping_mul(3),
                contact: n.cast_signed().wrapping_add(99),
                flags: flags(n),
            })
            .collect();
        let kept = read(&written(&records)).unwrap();
        assert_eq!(kept.records, records);
        assert_eq!(kept.tick_hz, Some(2000));
        assert_eq!(kept.origin.get("scene"), Some("bench"));
    }

    #[test]
    fn faults_name_their_line() {
        let text = String::from_utf8(written(&[TickRecord::default()])).unwrap();
        let fault = |from: &str, to: &str| read(text.replace(from, to).as_bytes()).unwrap_err();
        assert_eq!(fault("0,0,left", "0,0,front"), "line 4: side is \"front\"");
        assert_eq!(fault("left,0,", "left,nan,"), "line 4: x is \"nan\"");
        assert_eq!(fault("left,0,", "left,16384,"), "line 4: x is \"16384\"");
        assert_eq!(fault(",duty", ",force"), "line 3: no column \"duty\"");
        assert!(fault("= 2000", "= 0").starts_with("tick_hz is"));
        let truth = "line 4: lost is \"foo\", allowed: 0 or 1";
        assert_eq!(fault(",0\n", ",foo\n"), truth);
        assert_eq!(fault(",0\n", "\n"), "line 4: 19 cells; the header has 20");
        for (no, yes) in [("0.0", "1.0"), ("False", "True")] {
            let others = text.replace(",0\n", &format!(",{yes}\n"));
            let flags = format!(",0,0,0{},", format!(",{no}").repeat(6));
            let others = others.replacen(",0,0,0,0,0,0,0,0,0,", &flags, 1);
            let flags = read(others.as_bytes()).unwrap().records[0].flags;
            assert_eq!(flags, Flags::LOST, "{others}");
        }
    }
}
