//! A run of a scene, scored: what its decisions are worth, and how long they took by
//! the clock on the wall.

use scene::Scene;
use tactile::score::Statistics;

use crate::Error;
use crate::classifier::Classifier;
use crate::decisions::UNKNOWN;
use crate::evaluation::{Evaluation, Shown};
use crate::run::Run;

/// A scored run.
#[derive(Debug, Clone, PartialEq)]
pub struct Scored {
    /// What was presented, and what was decided meanwhile.
    pub presentations: Vec<Shown>,
    /// The figures of them.
    pub evaluation: Evaluation,
    /// Mean ticks, those in the air among them, from the first sample that counted
    /// since the decision before to a decision for a class, on surfaces that the model
    /// knows; not a number without one.
    pub wall: f64,
}

/// Runs a scene to its end; `tick` is called after each.
///
/// # Errors
/// As [`Run::new`].
pub fn run(scene: &Scene, classifier: Classifier, mut tick: impl FnMut()) -> Result<Scored, Error> {
    let mut run = Run::new(scene, Some(classifier))?;
    let mut presentations: Vec<Shown> = Vec::new();
    let mut walls = Vec::new();
    // What the last presentation is of, and when evidence for a decision began.
    let (mut last, mut began) = (None, None);
    for n in 0..run.ticks() {
        run.tick();
        tick();
        let presented = run.presented();
        if last != Some(presented) {
            last = Some(presented);
            presentations.push(Shown {
                label: presented.0.to_owned(),
                decided: Vec::new(),
            });
        }
        if run.sample().is_some_and(|sample| sample.counts) {
            began = began.or(Some(n));
        }
        let Some(decided) = run.decision() else {
            continue;
        };
        let ticks = (n + 1).saturating_sub(began.take().unwrap_or(n));
        if decided.decision != UNKNOWN && run.classes().contains(&decided.label) {
            walls.push(ticks as f64);
        }
        if let Some(presentation) = presentations.last_mut() {
            presentation.decided.push(decided);
        }
    }
    Ok(Scored {
        evaluation: Evaluation::new(run.classes(), &presentations),
        presentations,
        wall: Statistics::of(walls).map_or(f64::NAN, |walls| walls.mean),
    })
}
