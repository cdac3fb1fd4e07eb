//! The smallest rest between two frames in which a sensor answers each: by a scene at slower and
//! slower ticks, which are deployed one after the other.

use std::path::Path;

use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::Override;

use super::bench::Bench;
use super::report::{Done, Ended, Part, not_done};
use super::sensor::{Leaves, NO_FRAMES, read};
use crate::deployment::{Deployment, model_of};
use crate::frames::Seen;

/// Rates of ticks by the rest that they leave, the shortest first: from 64 us to 1.3 ms on an F446.
const RATES: [u32; 6] = [2_000, 1_800, 1_600, 1_500, 1_000, 500];

/// Leaves the module at the first rate at which each frame is answered.
pub(super) fn find(bench: &mut Bench, scene: &Path) -> Done {
    bench.facts()?;
    let mut part = Part::new(format!(
        "deployed {} at slower and slower ticks, and read frames at each",
        scene.display()
    ));
    for tick_hz in RATES {
        deploy(bench, scene, tick_hz)?;
        let (leaves, answered) = tried(bench)?;
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

fn deploy(bench: &mut Bench, scene: &Path, tick_hz: u32) -> Result<(), Error> {
    let rate = Override::new("--find-rest".to_owned(), "tick_hz", &tick_hz.to_string());
    let loaded = Loaded::checked(scene, &[rate])?;
    let model = model_of(scene, &loaded.scene)?;
    let what = Deployment::of(scene, loaded, model, bench.running.program())?;
    what.try_out(&mut bench.module)?;
    bench.module.source().deploy(&what)?;
    bench.ask_again()?;
    bench.stop()
}

/// The rest, and how many frames were answered, of the side that answers least.
fn tried(bench: &mut Bench) -> Result<(Leaves, usize), Ended> {
    let mut answered = usize::MAX;
    for side in bench.sides() {
        let frames = read(bench, side, bench.frames)?;
        answered = answered.min(Seen::of(&frames).begun());
    }
    let leaves = bench.leaves(bench.facts()?, bench.about.tick_hz);
    leaves.map_or_else(|| not_done(NO_FRAMES), |leaves| Ok((leaves, answered)))
}
