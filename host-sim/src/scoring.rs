//! A run of a scene, scored: what its decisions are worth, and how long they took by
//! the clock on the wall.

use firmware::{Place, Sample, SampleClassifier};
use scene::{Deciding, Scene};
use tactile::score::Statistics;

use crate::classifier::Classifier;
use crate::decisions::{Decided, UNKNOWN};
use crate::evaluation::{Evaluation, Shown};
use crate::run::Run;
use crate::{Error, bench};

/// A scored run.
#[derive(Debug, Clone, PartialEq)]
pub struct Scored {
    /// What was presented, and what was decided meanwhile.
    pub presentations: Vec<Shown>,
    /// The figures of them.
    pub evaluation: Evaluation,
    /// Mean ticks, those in the air among them, from the first sample that counted
    /// since the decision before, of the whisker that decides or of all together, to a
    /// decision for a class, on surfaces that the model knows; not a number without one.
    pub wall: f64,
}

struct Scoring {
    classes: Vec<String>,
    presentations: Vec<Shown>,
    walls: Vec<f64>,
    ticks: u64,
    /// When evidence for a decision began, of each whisker that is heard.
    began: Vec<Option<u64>>,
    deciding: Deciding,
    whiskers_per_side: usize,
}

impl Scoring {
    fn new(classifier: &Classifier, heard: usize, whiskers_per_side: usize) -> Self {
        Self {
            classes: classifier.classes().to_vec(),
            presentations: Vec::new(),
            walls: Vec::new(),
            ticks: 0,
            began: vec![None; heard],
            deciding: classifier.deciding(),
            whiskers_per_side,
        }
    }

    fn present(&mut self, label: &str) {
        let (label, decided) = (label.to_owned(), Vec::new());
        self.presentations.push(Shown { label, decided });
    }

    fn tick(&mut self, samples: &[Option<Sample>], decided: impl Iterator<Item = Decided>) {
        for (began, sample) in self.began.iter_mut().zip(samples) {
            if sample.is_some_and(|sample| sample.counts) {
                *began = began.or(Some(self.ticks));
            }
        }
        self.ticks += 1;
        for decided in decided {
            let began = self.take_began(decided.place);
            let ticks = began.map_or(1, |began| self.ticks - began);
            if decided.decision != UNKNOWN && self.classes.contains(&decided.label) {
                self.walls.push(ticks as f64);
            }
            if let Some(presentation) = self.presentations.last_mut() {
                presentation.decided.push(decided);
            }
        }
    }

    /// When the evidence for a decision of this whisker began; there is none afterwards.
    fn take_began(&mut self, place: Option<Place>) -> Option<u64> {
        if self.deciding == Deciding::Together {
            let first = self.began.iter().flatten().min().copied();
            self.began.fill(None);
            return first;
        }
        let Place { side, whisker } = place?;
        let n = usize::from(side) * self.whiskers_per_side + usize::from(whisker);
        self.began.get_mut(n)?.take()
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
    let whiskers_per_side = scene.head.whiskers_per_side;
    let mut scoring = Scoring::new(&classifier, bench::heard(scene), whiskers_per_side);
    let mut run = Run::new(scene, Some(classifier))?;
    let mut last = None;
    for _ in 0..run.ticks() {
        run.tick();
        tick();
        let presented = run.presented();
        if last.replace(presented) != Some(presented) {
            scoring.present(presented.0);
        }
        let decided: Vec<Decided> = run.decisions().collect();
        scoring.tick(run.samples(), decided.into_iter());
    }
    Ok(scoring.scored())
}

/// A run as its classifier hears it. No decision changes what a whisker does: one run
/// serves to score any number of models whose gate and gap are those of the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Heard {
    /// Ticks a second.
    pub tick_hz: u32,
    /// How many whiskers are heard.
    pub heard: usize,
    /// Whiskers on each side.
    pub whiskers_per_side: usize,
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
    /// Of each tick those of all whiskers that are heard; none while one has a fault.
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
            let is_same = |last: &HeardPresentation| last.label == label && last.trial == trial;
            if !presentations.last().is_some_and(is_same) {
                presentations.push(HeardPresentation {
                    label: label.to_owned(),
                    trial,
                    samples: Vec::new(),
                });
            }
            if let Some(presentation) = presentations.last_mut() {
                presentation.samples.extend(run.samples());
            }
        }
        Ok(Self {
            tick_hz: scene.tick_hz,
            heard: bench::heard(scene),
            whiskers_per_side: scene.head.whiskers_per_side,
            presentations,
        })
    }

    /// What [`run`] gives.
    pub fn score(&self, mut classifier: Classifier) -> Scored {
        let mut scoring = Scoring::new(&classifier, self.heard, self.whiskers_per_side);
        for presentation in &self.presentations {
            scoring.present(&presentation.label);
            for samples in presentation.samples.chunks(self.heard.max(1)) {
                let t_s = (scoring.ticks + 1) as f64 / f64::from(self.tick_hz);
                let mut decided = Vec::new();
                for (n, sample) in samples.iter().enumerate() {
                    let Some(sample) = sample else {
                        classifier.codes_mut().interrupt(n);
                        continue;
                    };
                    let Some(decision) = classifier.codes_mut().push(n, *sample) else {
                        continue;
                    };
                    let each = self.whiskers_per_side.max(1);
                    let (label, trial) = (&presentation.label, presentation.trial.to_string());
                    decided.push(Decided {
                        t_s: Some(t_s),
                        place: Some(Place::new((n / each) as u8, (n % each) as u8)),
                        ..Decided::new(decision, classifier.classes(), label, &trial)
                    });
                }
                scoring.tick(samples, decided.into_iter());
            }
        }
        scoring.scored()
    }
}
