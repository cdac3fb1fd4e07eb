//! The runs of a shard, one after the other, and one run by itself.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::commands::run::Loaded;
use scene::PlantKind;

use super::draw::{self, Has, RUN_S};
use super::judge::{Harm, Judge};
use super::outcome::{Findings, RunRow};
use super::subject::{OnBoard, OnPc, Seen, Subject};
use super::words::Words;
use crate::chip::Fault;
use crate::program::Program;

/// Of the numbers from `first` on, up to `end`, those that leave `remainder` on division by
/// `shards`.
#[derive(Debug, Clone, Copy)]
pub struct Shard {
    /// The first number.
    pub first: u64,
    /// The first number that is no more among them.
    pub end: u64,
    /// Which shard.
    pub remainder: u64,
    /// Of how many.
    pub shards: u64,
}

/// Where scenes run: a scene's file and, on a board, the program that was built for it.
pub type Scenes = Vec<(PathBuf, Option<PathBuf>)>;

/// A scene, ready to be run again and again.
struct Prepared {
    loaded: Loaded,
    board: Option<(Program, Words)>,
    has: Has,
    ticks: u64,
    undisturbed: Vec<Seen>,
}

/// At the end of a run it is compared with the undisturbed one for so long, s.
const COMPARED_S: f64 = 0.5;
/// By how much the angle of an undisturbed whisker may differ, degrees.
const SAME_DEG: f64 = 1.0;
/// A whisker that ranges over less than this share of what it should is parked.
const PARKED: f64 = 0.5;
/// After what time a fault that was taken away is to be recovered from, s: a rest of 1 s,
/// and the approach to the setpoint.
const RECOVERED_S: f64 = 1.4;

impl Prepared {
    fn new(scene: &Path, program: Option<&Path>) -> Result<Self, Error> {
        let loaded = Loaded::new(scene)?;
        let board = match program {
            None => None,
            Some(path) => {
                let program = Program::load(path)?;
                let words = Words::new(&program)?;
                Some((program, words))
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
        let seen: Result<Vec<_>, Fault> = (0..ticks).map(|_| subject.tick()).collect();
        drop(subject);
        prepared.undisturbed = seen?;
        Ok(prepared)
    }

    fn subject(&self) -> Result<Box<dyn Subject + '_>, Error> {
        Ok(match &self.board {
            None => Box::new(OnPc::new(&self.loaded)?),
            Some((program, words)) => Box::new(OnBoard::new(&self.loaded, program, words)?),
        })
    }

    fn run(&self, subject_name: &str, number: u64) -> Result<RunRow, Error> {
        let mut random = draw::random(number);
        let injection = draw::injection(self.has, &mut random);
        let mut subject = self.subject()?;
        let mut judge = Judge::new(&self.loaded.scene, self.has.motors);
        let mut findings = Findings::default();
        let mut disturbed: Vec<Seen> = Vec::new();
        for tick in 1..=self.ticks {
            let done = catch_unwind(AssertUnwindSafe(|| {
                injection.apply(tick, &mut *subject, &mut random)?;
                subject.tick()
            }));
            let seen = match done {
                Ok(Ok(seen)) => seen,
                Ok(Err(Fault::LockUp { .. })) => {
                    findings.harm = Some((tick, Harm::LockedUp));
                    break;
                }
                Ok(Err(fault)) => {
                    findings.unfollowed = Some(fault.to_string());
                    break;
                }
                Err(_) => {
                    findings.harm = Some((tick, Harm::Panicked));
                    break;
                }
            };
            let complaints = subject.complaints();
            if complaints.iter().any(|line| line.contains("panic at")) {
                findings.harm = Some((tick, Harm::Panicked));
                break;
            }
            if tick >= injection.start && findings.told.is_none() {
                let said = first_told(&seen, &complaints);
                findings.told = said.map(|said| (tick, said));
            }
            if let Some(harm) = judge.look(tick, &seen, &injection) {
                findings.harm = Some((tick, harm));
                break;
            }
            disturbed.push(seen);
        }
        let recovered = (RECOVERED_S * f64::from(self.has.tick_hz)) as u64;
        if let (Some(end), Some(last)) = (injection.end(), disturbed.last())
            && !findings.is_over()
            && !injection.kind.is_momentary()
            && end + recovered <= self.ticks
        {
            let tick = self.ticks;
            findings.harm = judge.end(last).map(|harm| (tick, harm));
        }
        if !findings.is_over() {
            findings.difference = self.difference(injection.start as usize, &disturbed);
        }
        let noticed = findings.told.as_ref();
        let noticed_ms = noticed
            .map(|(tick, _)| (tick - injection.start) as f64 * 1e3 / f64::from(self.has.tick_hz));
        let (outcome, reason) = findings.verdict();
        Ok(RunRow {
            subject: subject_name.to_owned(),
            run: number,
            scene: self.loaded.scene.name.clone(),
            kind: injection.kind,
            start: injection.start,
            ticks: injection.ticks,
            outcome,
            reason,
            changed: subject.changed(),
            noticed_ms,
        })
    }

    /// How a run with a fault from tick `start` on ends otherwise than without it.
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
            from.iter()
                .flat_map(|seen| seen.decisions.clone())
                .collect()
        };
        (decisions(disturbed) != decisions(&self.undisturbed)).then_some("decides otherwise")
    }
}

impl Findings {
    const fn is_over(&self) -> bool {
        self.harm.is_some() || self.unfollowed.is_some()
    }
}

/// By how much the angles differ at most; 0 where there are none.
fn extent(angles: &[f64]) -> f64 {
    let lowest = angles.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (highest - lowest).max(0.0)
}

/// What a tick has told first.
fn first_told(seen: &Seen, complaints: &[String]) -> Option<String> {
    let notice = seen.notices.first();
    let notice = notice.map(|(_, notice)| format!("{notice:?}"));
    let reset = seen.reset.map(|cause| format!("reset: {cause:?}"));
    let line = complaints.first().map(|line| stripped(line));
    notice.or(reset).or(line)
}

/// A line of the log without its time and level.
fn stripped(line: &str) -> String {
    let said = line.split_once("ERROR").or_else(|| line.split_once("WARN"));
    said.map_or(line, |(_, said)| said).trim().to_owned()
}

/// Runs what is left of a shard on `subject`; `done` are the numbers of those that were run
/// before, and every other row goes to `take` as soon as it is there.
///
/// # Errors
/// [`Error`] for a scene or a program that is wrong, and what `take` brings.
pub fn run(
    subject: &str,
    scenes: &Scenes,
    shard: Shard,
    done: &[u64],
    mut take: impl FnMut(RunRow) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut prepared: BTreeMap<usize, Prepared> = BTreeMap::new();
    for number in shard.first..shard.end {
        if number % shard.shards != shard.remainder || done.contains(&number) {
            continue;
        }
        take(run_one(subject, scenes, number, &mut prepared)?)?;
    }
    Ok(())
}

fn run_one(
    subject: &str,
    scenes: &Scenes,
    number: u64,
    prepared: &mut BTreeMap<usize, Prepared>,
) -> Result<RunRow, Error> {
    // The scenes in turn, whatever the number of shards.
    let n = (number % scenes.len().max(1) as u64) as usize;
    let (scene, program) = scenes
        .get(n)
        .ok_or_else(|| Error::Input("no scene to run".to_owned()))?;
    let prepared = match prepared.entry(n) {
        Entry::Occupied(prepared) => prepared.into_mut(),
        Entry::Vacant(place) => place.insert(Prepared::new(scene, program.as_deref())?),
    };
    prepared.run(subject, number)
}
