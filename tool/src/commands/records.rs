//! `whisker records`: what a module reports of every tick.

use std::path::PathBuf;

use clap::Args;
use firmware::Packet;
use host_sim::output::is_stdout;
use host_sim::progress::{Progress, Verbosity};
use host_sim::{Error, report};
use scene::file;
use wire::{Command, Flags, TickRecord};

use crate::record_file::{self, RecordFile};
use crate::script::Script;
use crate::source::{SourceChoice, seconds};
use crate::tally::{Tally, TickCount, side};

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: SourceChoice,
    /// Records that were written before: says what is in them
    #[arg(long, value_name = "FILE.csv", group = "source", conflicts_with_all = ["out", "seconds", "seed", "program", "board", "world", "scenario", "flash", "baud", "lay_by", "node"])]
    file: Option<PathBuf>,
    /// For how long; without it as long as the scene lasts
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
    /// Where to write the table; - is standard output. A name that ends in .mcap has all that
    /// the module says, its log and its answers too, as messages that Foxglove reads. An existing
    /// file is not overwritten
    #[arg(
        long,
        value_name = "FILE.csv|FILE.mcap",
        required_unless_present = "file"
    )]
    out: Option<PathBuf>,
    /// Commands for the module: lines TIME COMMAND [SIDE [VALUE]] or TIME set KEY VALUE, such as
    /// 1.5 gain left 0.5;
    /// what became of each is printed
    #[arg(long, value_name = "FILE", conflicts_with = "file")]
    script: Option<PathBuf>,
}

pub(crate) fn records(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Error> {
    if let Some(path) = &arguments.file {
        let bytes = file::read_piped(path, file::TABLE_BYTES);
        let bytes = bytes.map_err(|error| Error::file(path, error))?;
        if bytes.starts_with(mcap::MAGIC) {
            let fault = "messages (.mcap) are not read here; allowed: a table (.csv)";
            return Err(Error::file(path, fault));
        }
        let table = crate::table::read(&bytes).map_err(|fault| Error::file(path, fault))?;
        let mut summary = Summary::default();
        table.records.iter().for_each(|record| summary.take(record));
        if let Some(scene) = table.origin.get("scene") {
            report::say(format_args!("scene {scene}"));
        }
        report::say(summary.text(table.tick_hz));
        return Ok(());
    }
    let Some(out) = &arguments.out else {
        return Err(Error::Input("--out is missing".to_owned()));
    };
    record_file::check_new(out)?;
    // Where the table goes to standard output, nothing else does.
    let say = |line: String| {
        if is_stdout(out) {
            report::warn(line);
        } else {
            report::say(line);
        }
    };
    let mut script = Script::of(arguments.script.as_deref(), &arguments.source)?;
    let mut module = arguments.source.module()?;
    let Some(most) = arguments.seconds.or(module.source().duration_s()) else {
        // Whoever ends it by an interrupt has no file.
        let fault = "--seconds is missing: a module on a bench goes on until it is switched off";
        return Err(Error::Input(fault.to_owned()));
    };
    module.ask(Command::Stream(true))?;
    let lost_before = module.ask(Command::Status)?.values[0];
    let about = module.about()?;
    let classes = module.classes()?;
    let most = (most * f64::from(about.tick_hz)).ceil() as u32;

    let origin = module.origin()?.with("scene", &about.scene);
    let mut kept = RecordFile::create(out, &origin, about.tick_hz, &classes)?;
    let mut summary = Summary {
        tally: Tally::of_every(module.every(about.tick_hz)),
        ..Summary::default()
    };
    let mut progress = Progress::new(verbosity, "records", most.into());
    let mut ticks = TickCount::default();
    let mut first = None;
    let mut listen = || loop {
        if let Some(line) = script.play(&mut module)? {
            progress.pause(|| say(line));
        }
        let incoming = module.receive()?;
        if incoming.has_restarted {
            summary.tally.restart();
            ticks.restart();
        }
        for packet in &incoming.packets {
            if let Some(line) = script.answered(packet, about.tick_hz) {
                progress.pause(|| say(line));
            }
            if let Packet::Record(record) = packet {
                let now = ticks.take(record.sequence);
                let since = now - *first.get_or_insert(now);
                if let Some(beyond) = since.checked_sub(most.into()) {
                    let end = record.sequence.wrapping_sub(beyond as u32);
                    summary.tally.end(end);
                    return Ok(());
                }
                summary.take(record);
                progress.tick(since);
            }
            kept.packets(std::slice::from_ref(packet))?;
        }
        for line in &incoming.lines {
            kept.line(line)?;
        }
    };
    let listened: Result<(), Error> = listen();
    drop(progress);
    // What has come is kept, whatever has ended it.
    let finished = kept.finish();
    listened.and(finished)?;
    module.ask(Command::Stream(false))?;
    let lost = module.ask(Command::Status)?.values[0];
    let text = summary.text(Some(about.tick_hz));
    say(format!("{}: {text}", out.display()));
    // It counts from its last start.
    let lost_before = match summary.tally.restarts {
        0 => lost_before,
        _ => 0,
    };
    let own = lost.wrapping_sub(lost_before).cast_unsigned();
    if summary.tally.lost > 0 || own > 0 {
        say(format!(
            "the module itself counts records that found no room: {own}. Read faster, or have \
             fewer ticks a second; what else is missing was lost on the way"
        ));
    }
    script.end()
}

#[derive(Debug, Default)]
struct Summary {
    tally: Tally,
    /// Records with a fault in their tick, and those that do not count.
    faults: u64,
    invalid: u64,
    touches: [u64; 2],
    decisions: u64,
    touching: [bool; 2],
}

impl Summary {
    fn take(&mut self, record: &TickRecord) {
        self.tally.take(record);
        let has = |flag| record.flags.contains(flag);
        self.faults += u64::from(has(Flags::FAULT));
        self.invalid += u64::from(!has(Flags::VALID));
        self.decisions += u64::from(has(Flags::DECIDED));
        let (side, touching) = (side(record), has(Flags::TOUCHING));
        let before = std::mem::replace(&mut self.touching[side], touching);
        self.touches[side] += u64::from(touching && !before);
    }

    fn text(&self, tick_hz: Option<u32>) -> String {
        let (records, lost) = (self.tally.records, self.tally.lost);
        let (restarts, decisions) = (self.tally.restarts, self.decisions);
        let rate = tick_hz.map_or(String::new(), |hz| format!(" at {hz} ticks a second"));
        let touches: u64 = self.touches.iter().sum();
        let mut lines = vec![format!(
            "{records} records{rate}, {lost} lost, {touches} touches, {decisions} records with \
             decisions"
        )];
        if restarts > 0 {
            lines.push(format!(
                "starts of the module meanwhile: {restarts}; whisker log tells why"
            ));
        }
        if self.invalid > 0 {
            lines.push(format!(
                "records without a valid reading: {}, with a fault: {}; whisker log names it, \
                 docs/faults.md says what to do",
                self.invalid, self.faults
            ));
        }
        lines.join("\n")
    }
}
