//! Decisions of a whisker that touches nothing.

use anyhow::Result;
use firmware::Event;
use host_sim::classifier::Classifier;
use host_sim::run::Run;
use scene::Rule;

use super::{Extent, Ground};
use crate::page::{Page, verdict};

const FREQUENCIES_HZ: [f64; 2] = [2.0, 8.0];
const OUT_OF_REACH_DEG: f64 = 300.0;
/// A seed that is neither trained on nor scored.
const SEED: u64 = 400;

/// Each plant with its shipped model, the obstacle out of reach.
pub(super) fn section(page: &mut Page, grounds: &[Ground], extent: &Extent) -> Result<()> {
    let at_each = |ground| FREQUENCIES_HZ.map(|hz| (ground, hz));
    let jobs: Vec<(&Ground, f64)> = grounds.iter().flat_map(at_each).collect();
    let found = extent.cores.each("free air", &jobs, |&(ground, hz)| {
        let mut scene = ground.scene.clone();
        (scene.seed, scene.duration_s) = (SEED, extent.air_s);
        if let Some(whisking) = &mut scene.whisking {
            whisking.frequency_hz = hz;
        }
        if let Some(obstacle) = &mut scene.plant.obstacle {
            obstacle.obstacle_deg.fill(OUT_OF_REACH_DEG);
        }
        let rule = Rule::Sequential { threshold: 0.99 };
        let classifier = Classifier::new(ground.shipped().model.clone(), rule)?;
        let mut run = Run::new(&scene, Some(classifier))?;
        let (mut decisions, mut touches) = (0_u32, 0_u32);
        for _ in 0..run.ticks() {
            run.tick();
            decisions += u32::from(run.decisions().next().is_some());
            let is_onset = |event: &&Event| matches!(event, Event::Touch { .. });
            touches += run.events().iter().filter(is_onset).count() as u32;
        }
        Ok((decisions, touches))
    })?;

    page.heading(2, "Free air");
    page.say(format_args!(
        "The obstacle is out of reach for {} s: decisions, \"unknown\" among them, and touches \
         that the module tells although there is none.",
        extent.air_s
    ));
    let rows = jobs.iter().zip(&found).map(|((ground, hz), found)| {
        let (decisions, touches) = *found;
        let minutes = extent.air_s / 60.0;
        vec![
            format!("{}, {hz} Hz", ground.name),
            decisions.to_string(),
            verdict(decisions == 0).to_owned(),
            format!("{:.2}", f64::from(touches) / minutes),
            verdict(f64::from(touches) < minutes).to_owned(),
        ]
    });
    let header = "scene | decisions (goal: 0) | | touches a minute (goal: below 1) |";
    page.table(header, rows);
    Ok(())
}
