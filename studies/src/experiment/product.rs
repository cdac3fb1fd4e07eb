//! The product's own classifier in the place of the papers': tables of both channels together,
//! weighted by what training holds out, and the sequential rule at a stated 99 %.

use anyhow::Result;
use host_sim::evaluation::{Evaluation, presentations};
use host_sim::recording::Stream;
use host_sim::training::{How, Tables};
use whisking::filter;

use crate::page::{Page, bold, figure};

const THRESHOLD: f64 = 0.99;

const NAME: &str = "the product's: joint tables, stated 99 %";

/// A question, with its streams to train on and to decide in.
pub(super) type Task = (String, Vec<Stream>, Vec<Stream>);

/// A stream of two channels in sensor codes. Where there is a body whose whisker may be in the
/// air, contact is the module's own signal, |H50(x)|.
pub(super) fn stream(
    label: &str,
    trial: usize,
    samples: Vec<[f64; 2]>,
    in_the_air: Option<f64>,
) -> Result<Stream> {
    let contact = in_the_air.map(|rate_hz| {
        let h50 = filter::Config::<f64>::new(filter::CORNER_HZ, rate_hz)?;
        let mut state = filter::State::default();
        let mut pi = |[x, _]: &[f64; 2]| h50.process(&mut state, x / 8192.0).abs();
        anyhow::Ok(samples.iter().map(&mut pi).collect())
    });
    Ok(Stream {
        label: label.to_owned(),
        trial: trial.to_string(),
        samples,
        contact: contact.transpose()?,
        touch: None,
        pose: None,
        stands: None,
    })
}

pub(super) fn section(page: &mut Page, rate_hz: f64, tasks: Vec<Task>) -> Result<()> {
    page.say(
        "**The product's own rule** on the same recordings: joint tables, weighted by what \
         training holds out; a decision falls at a posterior of 99 %, or not at all.",
    );
    let mut rows = Vec::new();
    for (name, training, testing) in tasks {
        let recordings = [("training".to_owned(), training)];
        let trained = How::of(Tables::Joint).train(&recordings, rate_hz.round() as u32);
        let model = trained?.model;
        let classes = host_sim::classifier::names(&model);
        let shown = presentations(&model, THRESHOLD, &testing)?;
        let found = Evaluation::new(&classes, &shown);
        let right = 100.0 * found.calibration.found.share;
        let decided = 100.0 * (1.0 - found.undecided.share);
        let chance = 100.0 / classes.len() as f64;
        page.score(NAME, &name, right, (chance, Some(chance)))
            .decided = Some(decided);
        let cells = [
            figure(right, 1),
            figure(100.0 * found.calibration.stated, 1),
            figure(decided, 0),
            figure(1000.0 * found.samples / rate_hz, 0),
            figure(model.as_bytes().len() as f64, 0),
        ];
        rows.push(bold(name, cells));
    }
    page.table(
        "on | right of what was decided, % | stated, % | with a decision, % | time, ms | tables, bytes",
        rows,
    );
    Ok(())
}
