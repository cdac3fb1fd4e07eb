//! The module itself: what it is, how it started, its clock and its supply.

use firmware::Started;
use firmware::faults::{self, TABLE};
use host_sim::Error;
use wire::{Command, CommandStatus};

use super::bench::Bench;
use super::report::Part;
use crate::configuration::RunsBy;
use crate::faults::plain;

const BROWN_OUT: &str = "the brown-out level is below what the clock needs, as it is delivered: \
                         whisker flash sets it";

pub(super) fn module(bench: &mut Bench) -> Result<Part, Error> {
    let mut part = Part::new("stopped its motors, and asked what it is and how it started");
    let module = &mut bench.module;
    let origin = module.origin()?;
    let of_origin = origin.iter().map(|(key, value)| format!("{key} {value}"));
    part.saw(of_origin.collect::<Vec<_>>().join(", "));
    let runs = RunsBy::ask(module)?;
    let (tick_hz, whiskers) = (bench.about.tick_hz, bench.about.whiskers);
    part.saw(format!(
        "{runs}, {tick_hz} ticks a second, whiskers: {whiskers}"
    ));
    let [lost, missed] = module.ask(Command::Status)?.values.map(i32::cast_unsigned);
    part.saw(format!("{missed} ticks missed, {lost} records lost"));
    if missed > 0 {
        part.find(of_fault(faults::number::MISSED));
    }
    let answer = module.answer(Command::Started)?;
    match answer.status {
        CommandStatus::Done => of_start(Started::of(answer.values), &mut part),
        CommandStatus::NotHere => part.saw("it is simulated: no start, clock or supply to ask for"),
        status => part.saw(format!("how it started is not known: {status}")),
    }
    Ok(if part.is_well() {
        part.means("the board runs its program: its supply and clock are good enough for that")
    } else {
        part.means("the board runs, but its supply, its clock or a reset wants a look")
    })
}

fn of_start(started: Started, part: &mut Part) {
    let (number, cause, fault) = (started.number, started.cause.name(), started.fault);
    part.saw(format!(
        "start {number} since power-up, for {cause}; last fault: {fault}"
    ));
    if fault != 0 {
        part.find(of_fault(fault));
    }
    if started.is_internal {
        part.saw("clock: the chip's own oscillator");
        part.find(of_fault(faults::number::INTERNAL_CLOCK));
    } else {
        part.saw("clock: the one that the board is made for");
    }
    if started.browns_out_late {
        part.saw(BROWN_OUT);
    }
}

pub(super) fn of_fault(number: u8) -> String {
    match TABLE.iter().find(|row| row.number == number) {
        None => format!("fault {number}: a newer version of this program knows it"),
        Some(row) => format!(
            "fault or limit {number}, {}: {}. Check: {}",
            row.name,
            row.causes,
            plain(row.check)
        ),
    }
}
