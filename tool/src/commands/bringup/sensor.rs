//! The sensor's frames, and the rest between two.

use firmware::boards::BoardFacts;
use host_sim::Error;
use mlx90333::FRAME_LEN;
use serde::Serialize;
use wire::{Command, CommandStatus, WhiskerId};

use super::bench::Bench;
use super::report::{Done, Ended, Part, not_done};
use crate::frames::Seen;
use crate::interrupt;

pub(super) const NO_FRAMES: &str = "not done: its sensor has no frames of its own, as a TMAG5170; whisker log \
                         names faults 27 to 31, and the steps below look at its readings";

/// Reads frames, whatever the module takes them for, and says how the sensor sends them.
pub(super) fn frames(bench: &mut Bench, side: u8) -> Done {
    bench.ask("move the whisker a little, to and fro, by hand, until the next step")?;
    let seen = Seen::of(&read(bench, side, bench.frames)?);
    let mut part = Part::new(format!("read {} frames, with motors off", seen.frames));
    part.saw(seen.text());
    for finding in seen.findings(bench.running.decoder) {
        part.find(finding);
    }
    let part = part.with(&seen);
    let is_silent = seen.is_silent_at_times();
    bench.seen[usize::from(side)] = Some(seen);
    Ok(if part.is_well() && is_silent {
        part.means("what the sensor answers is as the scene has it, but not each frame is answered")
    } else if part.is_well() {
        part.means("the sensor answers, as the scene has it")
    } else {
        part.means("the sensor is not as the scene has it, or is not read")
    })
}

/// The last frame of a sensor, so many times.
pub(super) fn read(bench: &mut Bench, side: u8, count: u32) -> Result<Vec<[u8; FRAME_LEN]>, Ended> {
    let whisker = WhiskerId { side, number: 0 };
    let mut frames = Vec::new();
    for n in 0..count {
        interrupt::check()?;
        // Where an answer takes an even number of ticks, of a sensor that is silent in every second
        // frame all of one kind would be seen.
        if n % 3 == 2 {
            bench.module.source().next()?;
        }
        let answer = bench.module.answer(Command::Frame(whisker))?;
        // What it tells beside answers is of no interest here.
        bench.module.take_kept();
        match answer.status {
            CommandStatus::Done => {
                let [high, low] = answer.values.map(i32::cast_unsigned);
                frames.push((u64::from(high) << 32 | u64::from(low)).to_be_bytes());
            }
            CommandStatus::NotHere => return not_done(NO_FRAMES),
            status => return Err(Error::Work(format!("frame: {status}")).into()),
        }
    }
    Ok(frames)
}

#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct Leaves {
    pub(super) tick_hz: u32,
    pub(super) rest_us: u32,
}

/// Rates that are named beside the one that runs.
const RATES: [u32; 4] = [2_000, 1_000, 500, 200];

/// From the frames that were read: whether the rest between them is enough.
pub(super) fn rest(bench: &mut Bench, side: u8) -> Done {
    let Some(seen) = &bench.seen[usize::from(side)] else {
        return not_done("not done: no frames were read, by the step before");
    };
    let facts = bench.facts()?;
    let tick_hz = bench.about.tick_hz;
    let leaves = |tick_hz| bench.leaves(facts, tick_hz);
    let mut part =
        Part::new("worked out the rest between two frames, and looked at the frames again");
    let Some(now) = leaves(tick_hz) else {
        return Ok(part.means("this rate of ticks leaves no rest that the scene allows"));
    };
    part.saw(format!(
        "/SS is high for {} us between two frames at tick_hz = {tick_hz}; {} of {} frames are all \
         ones, {} begin as frames do",
        now.rest_us,
        seen.silent,
        seen.frames,
        seen.begun()
    ));
    let others = RATES.into_iter().filter(|hz| *hz < tick_hz);
    let others: Vec<Leaves> = others.filter_map(leaves).collect();
    let named = others
        .iter()
        .map(|of| format!("{} us at {} Hz", of.rest_us, of.tick_hz));
    let named = named.collect::<Vec<_>>().join(", ");
    if !named.is_empty() {
        part.saw(format!("slower ticks leave more: {named}"));
    }
    part = part.with(&(now, &others));
    Ok(if seen.is_silent_at_times() {
        part.find(format!(
            "the sensor answers some frames and not others: {} us may be too short a rest. \
             --find-rest scenes/bringup.toml finds the shortest that is long enough; then set \
             sensor.rest_us to it, so that no board takes a faster tick",
            now.rest_us
        ));
        part.means("the sensor may need a longer rest than this rate of ticks leaves it")
    } else if seen.begun() == 0 {
        part.means("nothing, as no frame was answered: the step before comes first")
    } else {
        part.means(format!(
            "a rest of {} us is enough for this sensor; a shorter one needs a scene with faster ticks",
            now.rest_us
        ))
    })
}

impl Bench {
    /// Of its board.
    pub(super) fn facts(&self) -> Result<&'static BoardFacts, Ended> {
        let facts = self.running.program().facts();
        let why = "not done: no time passes between the frames of a simulated module";
        facts.map_or_else(|| not_done(why), Ok)
    }

    /// The rest that a rate of ticks leaves the sensors of this board; `None`: one that the scene
    /// does not allow.
    pub(super) fn leaves(&self, facts: &BoardFacts, tick_hz: u32) -> Option<Leaves> {
        let clocks = if self.running.has_slow_sensors {
            facts.clocks.halved()
        } else {
            facts.clocks
        };
        let rest_ns = clocks.rest_ns(tick_hz, self.running.rest_us)?;
        let rest_us = rest_ns / 1_000;
        Some(Leaves { tick_hz, rest_us })
    }
}
