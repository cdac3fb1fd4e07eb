//! The product's own rule on PSIK's papers and corridors, by one vibrissa: the middle one of the
//! longest arc, of the left pad in corridors.

use crate::experiment::product::{section, stream};
use crate::experiment::record::corridor::{COLUMNS, FELT, place as in_corridor};
use crate::experiment::record::pad::place as on_paper;
use crate::experiment::recording::{Dataset, Recordings, of_set};
use crate::experiment::request::Request;
use crate::page::Page;
use crate::paper::psik::{CORRIDORS, RATE_HZ};
use anyhow::Result;

use super::sweeps::NAMES;

fn pairs(samples: &[f32]) -> impl Iterator<Item = [f64; 2]> + '_ {
    samples
        .as_chunks()
        .0
        .iter()
        .map(|pair: &[f32; 2]| pair.map(f64::from))
}

pub(super) fn of_one_vibrissa(
    page: &mut Page,
    request: &Request,
    recordings: &Recordings,
) -> Result<()> {
    let (mut taught, mut asked) = (Vec::new(), Vec::new());
    for (job, sweep) in of_set(recordings, Dataset::Vibrissa).iter().enumerate() {
        let (paper, number) = on_paper(request.extent, job);
        let samples = pairs(&sweep.values).collect();
        // At both ends of a sweep it is in the air.
        let stream = stream(NAMES[paper], job, samples, Some(RATE_HZ))?;
        let is_taught = number < request.extent.sweeps().0;
        if is_taught { &mut taught } else { &mut asked }.push(stream);
    }
    let name = "eight sandpapers by one vibrissa".to_owned();
    let papers = (name, taught, asked);

    let (training, tested, _) = request.extent.runs();
    let (mut taught, mut asked) = (Vec::new(), Vec::new());
    for (job, run) in of_set(recordings, Dataset::Corridor).iter().enumerate() {
        let (case, number) = in_corridor(request.extent, job);
        let windows = run.part(0, run.len()).chunks_exact(COLUMNS);
        let samples = windows.flat_map(|window| pairs(&window[FELT..])).collect();
        let stream = stream(CORRIDORS[case], job, samples, None)?;
        if number < training - tested.min(training) {
            taught.push(stream);
        } else if number >= training {
            asked.push(stream);
        }
    }
    let name = "two corridors, both ways, by one vibrissa".to_owned();
    section(page, RATE_HZ, vec![papers, (name, taught, asked)])
}
