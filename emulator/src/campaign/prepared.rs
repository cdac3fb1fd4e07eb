//! A scene that is run again and again, each time with another fault.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use firmware::faults::number;
use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::{Arm, PlantKind};
use wire::Command;

use super::draw::{self, Has, Plan, RUN_S};
use super::injection::{Injection, Kind};
use super::judge::{Harm, Judge};
use super::on_board::{OnBoard, words};
use super::subject::{Seen, Subject};
use super::table::{Findings, RunRow};
use crate::chip::Fault;
use crate::deployment::flashed;
use crate::program::Program;

pub(super) struct Prepared {
    loaded: Loaded,
    board: Option<(Program, Vec<(u32, String)>)>,
    has: Has,
    ticks: u64,
    undisturbed: Vec<Seen>,
}

/// When somebody arms motors that wait for a command, s.
const ARMED_S: f64 = 0.1;
/// At the end of a run it is compared with the undisturbed one for so long, s.
const COMPARED_S: f64 = 0.5;
/// By how much the angle of an undisturbed whisker may differ, degrees.
const SAME_DEG: f64 = 1.0;
/// What happens once, and in so long, s, changes nothing that can be seen, is taken for masked.
const SETTLED_S: f64 = 0.75;
/// A run that is one of many of its kind ends so long, s, after a program has ended itself with
/// a fault: its wait for the reset is a loop, and costs more than all the rest of the run.
const GIVEN_UP_S: f64 = 0.05;
/// A whisker that ranges over less than this share of what it should is parked.
const PARKED: f64 = 0.5;
/// After what time a fault that was taken away is to be recovered from, s: a rest of 1 s,
/// and the approach to the setpoint.
const RECOVERED_S: f64 = 1.4;

impl Prepared {
    pub(super) fn new(scene: &Path, program: Option<&Path>) -> Result<Self, Error> {
        let (loaded, board) = match program {
            None => (Loaded::new(scene)?, None),
            Some(path) => {
                let (loaded, program) = flashed(scene, path)?;
                let words = words(&program)?;
                (loaded, Some((program, words)))
            }
        };
        let has = Has {
            motors: loaded.scene.motor.is_some() && loaded.scene.plant.kind != PlantKind::Ideal,
            chip: board.is_some(),
            whiskers: loaded.scene.whiskers(),
            tick_hz: loaded.scene.tick_hz,
        };
        let ticks = (RUN_S * f64::from(has.tick_hz)) as u64;
        let mut prepared = Self {
            loaded,
            board,
            has,
            ticks,
            undisturbed: Vec::new(),
        };
        let mut subject = prepared.subject()?;
        let seen = (1..=ticks).map(|tick| prepared.tick(&mut subject, tick));
        let seen: Result<Vec<_>, Fault> = seen.collect();
        drop(subject);
        prepared.undisturbed = seen?;
        Ok(prepared)
    }

    fn subject(&self) -> Result<Subject<'_>, Error> {
        let board = self.board.as_ref();
        let board = board.map(|(program, words)| (program, &**words));
        Subject::new(&self.loaded, board)
    }

    fn tick(&self, subject: &mut Subject<'_>, tick: u64) -> Result<Seen, Fault> {
        let motor = self.loaded.scene.motor.as_ref();
        let waits = motor.is_some_and(|motor| motor.arm != Some(Arm::AtStart));
        if waits && tick == (ARMED_S * f64::from(self.has.tick_hz)) as u64 {
            subject.send(Command::Arm, false)?;
        }
        subject.tick()
    }

    pub(super) fn words(&self) -> u64 {
        let words = self.board.as_ref().map(|(_, words)| words.len());
        words.unwrap_or(0) as u64
    }

    pub(super) fn run(&self, subject_name: &str, number: u64, plan: Plan) -> Result<RunRow, Error> {
        let mut random = draw::random(number);
        let injections = draw::injections(plan, number, self.has, &mut random);
        let [first, rest @ ..] = injections.as_slice() else {
            return Err(Error::Work("nothing is injected".to_owned()));
        };
        let ends = injections.iter().map(Injection::end);
        let end = ends.collect::<Option<Vec<_>>>().unwrap_or_default();
        let end = end.into_iter().max();
        let mut kinds = injections.iter().map(|injection| injection.kind);
        let all_momentary = kinds.all(Kind::is_momentary);
        let settled = (SETTLED_S * f64::from(self.has.tick_hz)) as u64;
        let given_up = (GIVEN_UP_S * f64::from(self.has.tick_hz)) as u64;
        let [mut same_for, mut late_for] = [0, 0];
        let mut subject = self.subject()?;
        let mut judge = Judge::new(&self.loaded.scene, self.has.motors);
        let mut findings = Findings::default();
        let mut disturbed: Vec<Seen> = Vec::new();
        for tick in 1..=self.ticks {
            let done = catch_unwind(AssertUnwindSafe(|| {
                for injection in &injections {
                    injection.apply(tick, &mut subject, &mut random)?;
                }
                self.tick(&mut subject, tick)
            }));
            let seen = match done {
                Ok(Ok(seen)) => seen,
                Ok(Err(fault)) => {
                    findings.unfollowed = Some(fault.to_string());
                    break;
                }
                Err(_) => {
                    findings.harm = Some((tick, Harm::Panicked));
                    break;
                }
            };
            let complaints = subject.board().map(OnBoard::complaints).unwrap_or_default();
            let panicked = format!("fault board {} ", number::PANIC);
            if complaints.iter().any(|line| line.contains(&panicked)) {
                findings.harm = Some((tick, Harm::Panicked));
                break;
            }
            if tick >= first.start && findings.noticed.is_none() {
                let said = first_notice(&seen, &complaints);
                findings.noticed = said.map(|said| (tick, said));
            }
            if let Some(harm) = judge.look(tick, &seen, findings.noticed.is_some(), &injections) {
                findings.harm = Some((tick, harm));
                break;
            }
            let undisturbed = self.undisturbed.get(disturbed.len());
            let is_same = undisturbed.is_some_and(|undisturbed| seen.is_same(undisturbed));
            same_for = if is_same { same_for + 1 } else { 0 };
            late_for = if seen.is_late { late_for + 1 } else { 0 };
            disturbed.push(seen);
            if plan == Plan::Words && findings.noticed.is_some() && late_for >= given_up {
                break;
            }
            let is_settled = same_for >= settled && end.is_some_and(|end| tick >= end + settled);
            if findings.noticed.is_none() && is_settled {
                break;
            }
        }
        let recovered = (RECOVERED_S * f64::from(self.has.tick_hz)) as u64;
        if let (Some(end), Some(last)) = (end, disturbed.last())
            && !findings.is_over()
            && !all_momentary
            && disturbed.len() as u64 == self.ticks
            && end + recovered <= self.ticks
        {
            findings.harm = judge.end(last).map(|harm| (self.ticks, harm));
        }
        if !findings.is_over() && disturbed.len() as u64 == self.ticks {
            findings.difference = self.difference(first.start as usize, &disturbed);
        }
        let noticed = findings.noticed.as_ref();
        let noticed_ms = noticed
            .map(|(tick, _)| (tick - first.start) as f64 * 1e3 / f64::from(self.has.tick_hz));
        let (outcome, reason) = findings.verdict();
        Ok(RunRow {
            subject: subject_name.to_owned(),
            run: number,
            scene: self.loaded.scene.name.clone(),
            kind: first.kind,
            and: rest.first().map(|injection| injection.kind),
            start: first.start,
            ticks: first.ticks,
            outcome,
            reason,
            changed: subject.board().and_then(|board| board.changed.clone()),
            noticed_ms,
        })
    }

    fn difference(&self, start: usize, disturbed: &[Seen]) -> Option<&'static str> {
        let compared = (COMPARED_S * f64::from(self.has.tick_hz)) as usize;
        let from = disturbed.len().saturating_sub(compared);
        let (found, expected) = (disturbed.get(from..)?, self.undisturbed.get(from..)?);
        for side in 0..2 {
            let angles = |seen: &[Seen]| -> Vec<f64> {
                seen.iter().map(|seen| seen.row.angle_deg[side]).collect()
            };
            let (found, expected) = (angles(found), angles(expected));
            if extent(&found) < PARKED * extent(&expected) {
                return Some("parked");
            }
            let mut pairs = found.iter().zip(&expected);
            if pairs.any(|(a, b)| (a - b).abs() > SAME_DEG) {
                return Some("moves otherwise");
            }
        }
        let decisions = |seen: &[Seen]| -> Vec<(usize, String)> {
            let from = seen.get(start..).unwrap_or_default();
            let decided = from.iter().flat_map(|seen| seen.decisions.clone());
            decided.collect()
        };
        (decisions(disturbed) != decisions(&self.undisturbed)).then_some("decides otherwise")
    }
}

fn extent(angles: &[f64]) -> f64 {
    let lowest = angles.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (highest - lowest).max(0.0)
}

fn first_notice(seen: &Seen, complaints: &[String]) -> Option<String> {
    let notice = seen.notices.first();
    let notice = notice.map(|(_, notice)| format!("{notice:?}"));
    let reset = seen.reset.map(|cause| format!("reset: {cause:?}"));
    let line = complaints.first().map(|line| stripped(line));
    notice.or(reset).or(line)
}

fn stripped(line: &str) -> String {
    let said = line.split_once("ERROR").or_else(|| line.split_once("WARN"));
    said.map_or(line, |(_, said)| said).trim().to_owned()
}
