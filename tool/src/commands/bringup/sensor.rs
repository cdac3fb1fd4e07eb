//! The sensor's frames, the rest between two, and its readings.

use std::path::Path;

use firmware::boards::BoardFacts;
use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::Override;
use serde::Serialize;
use serde_json::json;
use wire::{Command, CommandStatus, Flags, WhiskerId};

use super::bench::Bench;
use super::report::{Done, Ended, Part, not_done};
use crate::calibrate::Zero;
use crate::deployment::{Deployment, model_of};
use crate::frames::{Frame, Seen};
use crate::interrupt;
use crate::loading;
use crate::sample::Sample;

const NO_FRAMES: &str = "not done: its sensor has no frames of its own, as a TMAG5170; whisker log \
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
fn read(bench: &mut Bench, side: u8, count: u32) -> Result<Vec<Frame>, Ended> {
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
struct Leaves {
    tick_hz: u32,
    rest_us: u32,
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
    let named = |of: &Leaves| format!("{} us at {} Hz", of.rest_us, of.tick_hz);
    let named = others.iter().map(named);
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
    fn facts(&self) -> Result<&'static BoardFacts, Ended> {
        let facts = self.running.program().facts();
        let why = "not done: no time passes between the frames of a simulated module";
        facts.map_or_else(|| not_done(why), Ok)
    }

    /// The rest that a rate of ticks leaves the sensors of this board; `None`: one that the scene
    /// does not allow.
    fn leaves(&self, facts: &BoardFacts, tick_hz: u32) -> Option<Leaves> {
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

/// Rates of ticks by the rest that they leave, the shortest first: from 64 us to 1.3 ms on an F446.
const FROM_FASTEST: [u32; 6] = [2_000, 1_800, 1_600, 1_500, 1_000, 500];

/// Leaves the module at the first rate at which each frame is answered.
pub(super) fn find(bench: &mut Bench, scene: &Path) -> Done {
    bench.facts()?;
    let mut part = Part::new(format!(
        "deployed {} at slower and slower ticks, and read frames at each",
        scene.display()
    ));
    for tick_hz in FROM_FASTEST {
        set_rate(bench, scene, tick_hz)?;
        let (leaves, answered) = least_answered(bench)?;
        part.saw(format!(
            "{} us at {tick_hz} Hz: {answered} of {} frames were answered",
            leaves.rest_us, bench.frames
        ));
        if answered == bench.frames as usize {
            let part = part.with(&leaves);
            return Ok(part.means(format!(
                "a rest of {} us is enough. The module is left with this scene and tick_hz = {tick_hz}; \
                 sensor.rest_us = {} has any board refuse faster ticks",
                leaves.rest_us, leaves.rest_us
            )));
        }
    }
    part.find(
        "no rest is long enough: the steps frames and rest say what to look for, with the scene at \
         the slowest ticks, as it is now",
    );
    Ok(part.means("it is not the rest by which the sensor does not answer"))
}

fn set_rate(bench: &mut Bench, scene: &Path, tick_hz: u32) -> Result<(), Error> {
    let rate = Override::new("--find-rest".to_owned(), "tick_hz", &tick_hz.to_string());
    let loaded = Loaded::checked(scene, &[rate])?;
    let model = model_of(scene, &loaded.scene)?;
    let what = Deployment::of(scene, loaded, model, bench.running.program())?;
    what.try_out(&mut bench.module)?;
    loading::deploy(&mut bench.module, &what)?;
    bench.ask_again()?;
    bench.stop()
}

/// The rest, and how many frames were answered, of the side that answers least.
fn least_answered(bench: &mut Bench) -> Result<(Leaves, usize), Ended> {
    let mut answered = usize::MAX;
    for side in bench.sides() {
        // The module has just started, and may not have read a frame when it is first asked.
        read(bench, side, 1)?;
        let frames = read(bench, side, bench.frames)?;
        answered = answered.min(Seen::of(&frames).begun());
    }
    let leaves = bench.leaves(bench.facts()?, bench.about.tick_hz);
    leaves.map_or_else(|| not_done(NO_FRAMES), |leaves| Ok((leaves, answered)))
}

/// Of a hundred ticks so many have a new reading, at least.
const NEW: f64 = 0.9;
/// Readings at rest scatter by less, codes, root mean square: `check` asks for a look from about
/// there, which is twice what the simulated sensor does.
const NOISY_CODES: f64 = 9.0;

const INVALID: &str = "not done: no reading counts; the step frames comes first, and whisker log names \
                       the fault";

/// Readings that count, of so many ticks.
fn watched(bench: &mut Bench, side: u8) -> Result<Vec<Sample>, Ended> {
    bench.stream()?;
    let frames = f64::from(bench.frames);
    let mut whisker = bench.whisker(side)?;
    let seconds = frames * whisker.tick_s();
    let samples = whisker.watch(seconds, |_| true)?;
    let counts = |sample: &Sample| sample.is_valid() && sample.flags.contains(Flags::FRESH);
    let counts: Vec<Sample> = samples.into_iter().filter(counts).collect();
    if counts.len() < 2 {
        return not_done(INVALID);
    }
    Ok(counts)
}

pub(super) fn rate(bench: &mut Bench, side: u8) -> Done {
    bench.ask("move the whisker to and fro, by hand, until the next step")?;
    let samples = watched(bench, side)?;
    let pairs = samples.windows(2);
    let new = pairs.filter(|pair| pair[0].words != pair[1].words).count();
    let new = new as f64 / (samples.len() - 1) as f64;
    let tick_hz = f64::from(bench.about.tick_hz);
    let (readings, update_hz) = (samples.len(), new * tick_hz);
    let rate = json!({"readings": readings, "new": new, "update_hz": update_hz});
    let mut part = Part::new(format!("watched {readings} readings")).with(&rate);
    part.saw(format!(
        "{:.1} % of them are new, {update_hz:.0} a second at {tick_hz} ticks a second",
        100.0 * new
    ));
    if new >= NEW {
        return Ok(part.means("the sensor has a new reading for each tick, or nearly so"));
    }
    part.find(format!(
        "if the whisker moved all the time, the sensor has {update_hz:.0} new readings a second: set \
         tick_hz to that or less, or another mode or filter in the sensor's EEPROM. What repeats says \
         nothing new to the classifier"
    ));
    Ok(part.means("readings repeat: the sensor converts less often than the module reads it"))
}

pub(super) fn noise(bench: &mut Bench, side: u8) -> Done {
    bench.ask("let go of the whisker, and of the bench")?;
    let samples = watched(bench, side)?;
    let Some(Zero { channels, .. }) = Zero::of(&samples) else {
        return not_done(INVALID);
    };
    let noise = channels.map(|channel| channel.sd);
    let mut part = Part::new(format!("watched {} readings at rest", samples.len())).with(&noise);
    let [x, y] = noise;
    let [at_x, at_y] = channels.map(|channel| channel.mean);
    part.saw(format!(
        "x scatters by {x:.1} codes about {at_x:.0}, y by {y:.1} about {at_y:.0} (root mean square)"
    ));
    if noise.iter().all(|noise| *noise <= NOISY_CODES) {
        return Ok(part.means(format!("quiet: at most {NOISY_CODES} codes")));
    }
    part.find(format!(
        "more than {NOISY_CODES} codes: a field too weak (a gap too wide), a capacitor that lacks at the \
         sensor's supply, grounds joined at two points, or something that moves; whisker check tells \
         slow from fast"
    ));
    Ok(part.means("what is felt has to be larger than this noise"))
}
