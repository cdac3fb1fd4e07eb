//! A run of a scene, scored: what its decisions are worth, and how long they took by
//! the clock on the wall.

use firmware::{Sample, SampleClassifier};
use scene::Scene;
use tactile::score::Statistics;

use crate::Error;
use crate::classifier::Classifier;
use crate::decisions::{self, Decided, UNKNOWN};
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

/// What has been scored so far.
struct Scoring {
    classes: Vec<String>,
    presentations: Vec<Shown>,
    walls: Vec<f64>,
    ticks: u64,
    /// When evidence for a decision began.
    began: Option<u64>,
}

impl Scoring {
    fn new(classes: &[String]) -> Self {
        Self {
            classes: classes.to_vec(),
            presentations: Vec::new(),
            walls: Vec::new(),
            ticks: 0,
            began: None,
        }
    }

    fn present(&mut self, label: &str) {
        self.presentations.push(Shown {
            label: label.to_owned(),
            decided: Vec::new(),
        });
    }

    fn tick(&mut self, sample: Option<Sample>, decided: Option<Decided>) {
        if sample.is_some_and(|sample| sample.counts) {
            self.began = self.began.or(Some(self.ticks));
        }
        self.ticks += 1;
        let Some(decided) = decided else { return };
        let ticks = self.began.take().map_or(1, |began| self.ticks - began);
        if decided.decision != UNKNOWN && self.classes.contains(&decided.label) {
            self.walls.push(ticks as f64);
        }
        if let Some(presentation) = self.presentations.last_mut() {
            presentation.decided.push(decided);
        }
    }

    fn scored(self) -> Scored {
        Scored {
            evaluation: Evaluation::new(&self.classes, &self.presentations),
            presentations: self.presentations,
            wall: Statistics::of(self.walls).map_or(f64::NAN, |walls| walls.mean),
        }
    }
}

/// Runs a scene to its end; `tick` is called after each.
///
/// # Errors
/// As [`Run::new`].
pub fn run(scene: &Scene, classifier: Classifier, mut tick: impl FnMut()) -> Result<Scored, Error> {
    let mut run = Run::new(scene, Some(classifier))?;
    let mut scoring = Scoring::new(run.classes());
    let mut last = None;
    for _ in 0..run.ticks() {
        run.tick();
        tick();
        let presented = run.presented();
        if last.replace(presented) != Some(presented) {
            scoring.present(presented.0);
        }
        scoring.tick(run.sample(), run.decision());
    }
    Ok(scoring.scored())
}

/// A run as its classifier hears it. No decision changes what a whisker does: one run
/// serves to score any number of models whose gate and gap are those of the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Heard {
    /// Ticks a second.
    pub tick_hz: u32,
    /// What was presented, in order.
    pub presentations: Vec<HeardPresentation>,
}

/// What is heard of one presentation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HeardPresentation {
    /// The surface.
    pub label: String,
    /// How often it has been presented before.
    pub trial: u64,
    /// Of each tick; none while the sensor has a fault.
    pub samples: Vec<Option<Sample>>,
}

impl Heard {
    /// Runs a scene to its end, without its classifier.
    ///
    /// # Errors
    /// As [`Run::new`].
    pub fn record(scene: &Scene) -> Result<Self, Error> {
        let mut run = Run::new(scene, None)?;
        let mut presentations: Vec<HeardPresentation> = Vec::new();
        for _ in 0..run.ticks() {
            run.tick();
            let (label, trial) = run.presented();
            if !presentations
                .last()
                .is_some_and(|last| last.label == label && last.trial == trial)
            {
                presentations.push(HeardPresentation {
                    label: label.to_owned(),
                    trial,
                    samples: Vec::new(),
                });
            }
            if let Some(presentation) = presentations.last_mut() {
                presentation.samples.push(run.sample());
            }
        }
        Ok(Self {
            tick_hz: scene.tick_hz,
            presentations,
        })
    }

    /// What [`run`] gives.
    pub fn score(&self, mut classifier: Classifier) -> Scored {
        let mut scoring = Scoring::new(classifier.classes());
        for presentation in &self.presentations {
            scoring.present(&presentation.label);
            for &sample in &presentation.samples {
                let decision = sample.and_then(|sample| classifier.push(sample));
                let ticks = scoring.ticks + 1;
                let decided = decision.map(|decision| Decided {
                    t_s: Some(ticks as f64 / f64::from(self.tick_hz)),
                    label: presentation.label.clone(),
                    trial: presentation.trial.to_string(),
                    decision: decisions::name(decision, classifier.classes()).to_owned(),
                    samples: decision.samples(),
                    posterior: decision.posterior().to_f64(),
                    touch: decision.touch(),
                });
                scoring.tick(sample, decided);
            }
        }
        scoring.scored()
    }
}

#[cfg(test)]
mod tests {
    use scene::{Rule, Scene};
    use tactile::train::joint::Options;

    use super::{Heard, run};
    use crate::classifier::Classifier;
    use crate::recording::Recorder;
    use crate::run::Run;
    use crate::training;

    #[test]
    fn a_run_that_was_heard_scores_as_one_that_is_run() {
        let text = include_str!("../../scenes/textures.toml");
        let mut scene = Scene::from_str("textures.toml", text).unwrap();
        scene.duration_s = 10.0;
        let mut recorder = Recorder::default();
        let mut training = Run::new(&scene, None).unwrap();
        for _ in 0..training.ticks() {
            training.tick();
            recorder.take(&mut training);
        }
        let recordings = [("a run".to_owned(), recorder.into_streams())];
        let joint = training::joint(&recordings, &Options::default()).unwrap();
        let rule = Rule::Sequential { threshold: 0.99 };
        let classifier = Classifier::new(joint.model().unwrap(), rule).unwrap();
        scene.seed = 77;
        let heard = Heard::record(&scene).unwrap();
        let live = run(&scene, classifier.clone(), || ()).unwrap();
        assert!(live.evaluation.calibration.found.count > 50);
        let replayed = heard.score(classifier);
        assert_eq!(replayed.presentations, live.presentations);
        assert_eq!(replayed.wall, live.wall);
        assert_eq!(replayed.evaluation.hits, live.evaluation.hits);
    }
}
