//! Training the second opinion: see [`crate::opinion`] for what it says.
//!
//! Of recordings in one pose it objects, and what poses do to the roughness is learnt from
//! copies whose deflections are scaled: how much may differ between training and use only
//! who trains knows ([`Expect`]). Of recordings in several poses, each of all classes, it names,
//! and what differs between poses is learnt from them. Where touches last, which have neither
//! onset nor way, it objects in either case.
//!
//! Values that were chosen, on recordings of the scene `whisker` with seeds that no page uses:
//! α 1 and 1 + 4/(poses − 1), s 0 and 0.03, what no copy shows, the 0.8 of an objection, the shares
//! of `typical`, `paths` and patience, their shrinking and least deviations, the gains of copies
//! in y, by how much a sensor may be turned and scaled; of `bench-textures` the spread of T; of
//! bearings and of a fingertip's recordings the 0.9, the gains of both axes (and of synthetic
//! ones), and what is near in the mean, typical, and waited for.

mod linear;
mod matrix;
mod named;
mod paths;
pub(super) mod poses;
mod stands;
mod touches;
mod typical;
mod written;

use std::string::String;
use std::vec;
use std::vec::Vec;

use self::linear::{Covariance, HeldOut, Linear, SPREAD, temperature};
use self::matrix::quantile;
use self::paths::{Paths, Sensor};
use self::poses::Poses;
use self::stands::Stands;
use self::touches::{Kind, Sense, Touch};
use self::typical::Typical;
use crate::opinion::Whisked;
use crate::opinion::pose::TARGETS;
use crate::opinion::section::{DEFLECTIONS, LATE, MAX_POSES, Section};
use crate::opinion::{BLOCKS, FEATURES, PARTS, STAGES, WEIGHED};
use crate::quantiser::Quantiser;
use crate::train::joint::{CHANNELS, Trial, Warning};

/// How much may differ between training and use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Expect {
    /// Nothing: from recordings in one pose there is no second opinion, and what is stated
    /// holds in that pose only.
    Same,
    /// What a hand on a bench makes: some degrees, and a fifth of scale.
    #[default]
    Bench,
    /// Another mounting: half to twice of scale.
    Other,
}

impl Expect {
    /// By what copies of a recording are scaled in y; by what others are in x and y, of touches that
    /// last, which have no way that tells their scale (a sixth is enough for a fifth); by how much
    /// the sensor may be turned, radians, and its scale in y be another.
    const fn differs(self) -> (&'static [f64], &'static [f64], [f64; 2]) {
        const HALF_TO_TWICE: &[f64] = &[0.5, 0.7, 1.4, 2.0];
        match self {
            Self::Same => (&[], &[], [0.0; 2]),
            Self::Bench => (&[0.8, 1.25], &[0.83, 1.2], [6_f64.to_radians(), 0.2]),
            Self::Other => (HALF_TO_TWICE, HALF_TO_TWICE, [15_f64.to_radians(), 0.5]),
        }
    }
}

/// A second opinion.
#[derive(Debug, Clone, PartialEq)]
pub struct Opinion {
    /// Its part of a model file.
    pub words: Vec<u32>,
    /// Whether it names classes by itself.
    pub names: bool,
    /// Poses of all classes.
    pub poses: usize,
    /// Root mean square of the errors of tilt and depth, in poses that were held out, of each class
    /// after so many blocks, from 1; empty where recordings do not say how what was touched stood.
    pub pose_errors: Vec<Vec<[f64; TARGETS]>>,
}

/// Poses of which at least an opinion that names is trained.
pub(super) const LEAST_POSES: usize = 3;
/// Touches of each class of which at least one is trained, and in each pose.
const LEAST_TOUCHES: [usize; 2] = [12, 4];
/// Touches of each class that reach a stage.
const LEAST_OF_STAGE: usize = 6;
/// The least posterior by which it does not object to a name: where touches end, and where they
/// last, in which it is asked again and again.
const LEAST_POSTERIOR: [f64; 2] = [0.8, 0.9];
/// The share of touches that end before patience does: where it objects, and names.
const IMPATIENT: [f64; 2] = [0.02, 0.1];
/// Parts in which the touches of one pose are held out.
const FOLDS: usize = 8;

pub(super) struct Material<'a> {
    pub(super) trials: &'a [Trial],
    pub(super) names: &'a [String],
    /// Of each trial.
    pub(super) classes: &'a [usize],
    pub(super) scales: &'a [Quantiser; CHANNELS],
    pub(super) block: u32,
    pub(super) expect: Expect,
    pub(super) whisked: Whisked,
    pub(super) poses: &'a Poses,
    /// Of each class the first one from which its trials cannot be distinguished, itself if
    /// there is none.
    pub(super) alike: &'a [usize],
}

struct Felt {
    sense: Sense,
    classes: usize,
    /// Whether touches are mostly longer than nine blocks.
    begins_again: bool,
    /// Of the recordings as they are.
    touches: Vec<Touch>,
    /// The same, and copies behind.
    with_copies: Vec<Touch>,
    /// Recordings in which every class was felt.
    poses: Vec<usize>,
    stages: usize,
    sensor: Sensor,
}

/// Trains from what there is; none where a class was not touched often enough, or nothing is
/// expected to differ. Says as well what there is too little of.
pub(super) fn train(material: &Material<'_>) -> (Option<Opinion>, Vec<Warning>) {
    let felt = Felt::of(material);
    let names = felt.poses.len() >= LEAST_POSES && !felt.begins_again;
    let mut warnings = felt.lacking(material);
    if !names && material.expect == Expect::Same {
        return (None, warnings);
    }
    let scarce = felt.scarce(material.names);
    let is_enough = scarce.is_none() && felt.stages > 0;
    warnings.extend(scarce);
    if !is_enough {
        return (None, warnings);
    }
    let (stands, lacking) = Stands::of(&felt.touches, material.trials, material.names, felt.stages);
    warnings.extend(lacking);
    let opinion = of_felt(&felt, names, material, stands.as_ref());
    (opinion, warnings)
}

fn of_felt(
    felt: &Felt,
    names: bool,
    material: &Material<'_>,
    stands: Option<&Stands>,
) -> Option<Opinion> {
    // Which are alike the tables have found, and they hold in one pose.
    let itself: Vec<usize> = (0..felt.classes).collect();
    let how = if names {
        // A few poses say little of how far poses spread.
        let freedom = felt.poses.len() - 1;
        Covariance {
            between: 1.0 + 4.0 / freedom as f64,
            shrink: 0.03,
            has_unseen: false,
            alike: &itself,
            weighed: WEIGHED,
            sensor: material.expect.differs().2,
        }
    } else {
        Covariance {
            between: 1.0,
            shrink: 0.0,
            has_unseen: true,
            alike: material.alike,
            weighed: FEATURES,
            sensor: [0.0; 2],
        }
    };
    let recordings = felt.with_copies.iter().map(|touch| touch.recording + 1);
    let apart = if names {
        material.poses.count()
    } else {
        recordings.max()?
    };
    let fits: Vec<(Linear, Vec<HeldOut<'_>>)> = (1..=felt.stages)
        .map(|stage| Linear::of(&felt.with_copies, (stage, felt.classes, apart), how))
        .collect();
    let classes = felt.of_classes(names);
    let mut words = felt.head(names, material.whisked, classes.first()?.1.means.len());
    // What is said earlier is not heeded.
    let first = Section::new(&words, 0).first_stage();
    let of_all = names.then(|| {
        let held_out = fits.iter().skip(first - 1).flat_map(|(_, of)| of);
        temperature(
            &felt.named(held_out.cloned().collect(), apart),
            Some(SPREAD),
        )
    });
    for (stage, (linear, held_out)) in (1..).zip(fits).skip(first - 1) {
        let of_stage = of_all.unwrap_or_else(|| temperature(&held_out, None));
        written::stage(&mut words, (stage, how.weighed), &linear.at(of_stage));
    }
    if let Some(stands) = stands {
        written::stands(&mut words, stands);
    }
    if names && felt.poses.len() <= MAX_POSES {
        written::bounds(&mut words, felt.sensor);
    }
    if felt.lasts() {
        written::means(&mut words, classes.iter().map(|(typical, _)| typical));
    }
    for (typical, _) in &classes {
        written::typical(&mut words, typical);
    }
    for (_, paths) in &classes {
        written::paths(&mut words, paths);
    }
    Some(Opinion {
        words,
        names,
        poses: felt.poses.len(),
        pose_errors: stands.map(Stands::errors).unwrap_or_default(),
    })
}

impl Felt {
    fn of(material: &Material<'_>) -> Self {
        let Material {
            trials,
            names,
            scales,
            block,
            expect,
            ..
        } = *material;
        let Poses { of_trial, .. } = material.poses;
        let recordings = material.poses.count();
        let sense = Sense::of(trials, scales, block);
        let numbers = (material.classes, of_trial.as_slice());
        let of = |gains, kind| sense.touches(trials, scales, numbers, (gains, kind));
        let poses = |touches: &[Touch]| -> Vec<usize> {
            let all = |recording: usize| {
                let of = touches.iter().filter(|touch| touch.recording == recording);
                let count = |class| of.clone().filter(|touch| touch.class == class).count();
                (0..names.len()).all(|class| count(class) >= LEAST_TOUCHES[1])
            };
            (0..recordings)
                .filter(|recording| all(*recording))
                .collect()
        };
        // Until it is known whether the opinion names.
        let mut kind = Kind {
            lasts: false,
            has_tables: false,
        };
        let mut touches = of([1.0; CHANNELS], kind);
        let long = touches.iter().filter(|touch| touch.goes_on).count();
        let begins_again = long * 3 > touches.len();
        touches.retain(|touch| !touch.goes_on);
        kind.lasts = begins_again;
        kind.has_tables = begins_again || poses(&touches).len() < LEAST_POSES;
        if kind.has_tables {
            touches = of([1.0; CHANNELS], kind);
        }
        touches.retain(|touch| begins_again || !touch.goes_on);
        let mut with_copies = touches.clone();
        let (of_y, of_both, [turn, scale]) = expect.differs();
        let of_both = of_both.iter().filter(|_| begins_again);
        let of_both = of_both.map(|gain| [*gain; CHANNELS]);
        let gains = of_y.iter().map(|gain| [1.0, *gain]);
        for (n, gains) in gains.chain(of_both).enumerate() {
            let mut copies = of(gains, kind);
            copies.retain(|touch| begins_again || !touch.goes_on);
            for copy in &mut copies {
                copy.recording += (n + 1) * recordings;
            }
            with_copies.append(&mut copies);
        }
        let count = |class: usize, stage: usize| {
            let of_class = touches.iter().filter(|touch| touch.class == class);
            of_class.filter(|touch| touch.len() >= stage).count()
        };
        let classes = names.len();
        let reach = |stage: usize| (0..classes).all(|class| count(class, stage) >= LEAST_OF_STAGE);
        let poses = poses(&touches);
        let stages = (1..=STAGES).take_while(|stage| reach(*stage)).count();
        let sensor = Sensor {
            turn,
            scale,
            rest: sense.rest.map(|rest| f64::from(rest) / 256.0),
        };
        Self {
            sense,
            classes,
            begins_again,
            touches,
            with_copies,
            poses,
            stages,
            sensor,
        }
    }

    /// Whether nearly all touches last for so many parts that their means can be waited for.
    fn lasts(&self) -> bool {
        let mut parts: Vec<usize> = Vec::new();
        for touch in &self.touches {
            if !touch.goes_on {
                parts.push(0);
            }
            if let Some(last) = parts.last_mut() {
                *last += usize::from(touch.len() == BLOCKS);
            }
        }
        let long = parts.iter().filter(|parts| **parts >= PARTS).count();
        self.begins_again && 10 * long >= 9 * parts.len()
    }

    fn count(&self, class: usize, pose: Option<usize>) -> usize {
        let of = self.touches.iter().filter(|touch| touch.class == class);
        of.filter(|touch| pose.is_none_or(|pose| touch.recording == pose))
            .count()
    }

    /// The first class of which there are too few touches.
    fn scarce(&self, names: &[String]) -> Option<Warning> {
        let [least, _] = LEAST_TOUCHES;
        let mut classes = (0..self.classes).map(|class| (class, self.count(class, None)));
        let (class, touches) = classes.find(|(_, touches)| *touches < least)?;
        Some(Warning::NoOpinion {
            name: names.get(class)?.clone(),
            touches,
            least,
        })
    }

    /// Poses, of several, that have too few touches of a class to count as one.
    fn lacking(&self, material: &Material<'_>) -> Vec<Warning> {
        let [_, least] = LEAST_TOUCHES;
        let named = material.poses.names.iter().enumerate();
        let named = named.filter(|_| material.poses.count() > 1);
        let mut warnings = Vec::new();
        for (pose, called) in named {
            let Some(called) = called else { continue };
            for (class, name) in material.names.iter().enumerate() {
                let touches = self.count(class, Some(pose));
                if touches < least {
                    warnings.push(Warning::Pose {
                        pose: called.clone(),
                        name: name.clone(),
                        touches,
                        least,
                    });
                }
            }
        }
        warnings
    }

    fn of_classes(&self, names: bool) -> Vec<(Typical, Paths)> {
        (0..self.classes)
            .map(|class| self.class(class, names))
            .collect()
    }

    fn class(&self, class: usize, names: bool) -> (Typical, Paths) {
        let of: Vec<&Touch> = self.touches.iter().filter(|t| t.class == class).collect();
        let mut trials: Vec<usize> = of.iter().map(|touch| touch.trial).collect();
        trials.dedup();
        let trial_of = |touch: &Touch| trials.iter().position(|t| *t == touch.trial).unwrap_or(0);
        // Trials are held out where there are several, otherwise touches.
        let has_trials = trials.len() > 3;
        let part = |(n, touch): (usize, &&Touch)| {
            if has_trials {
                trial_of(touch) % FOLDS
            } else {
                n % FOLDS
            }
        };
        let parts: Vec<usize> = of.iter().enumerate().map(part).collect();
        if !names {
            return (
                Typical::of(&of, &parts, (self.stages, typical::SHARE[0])),
                Paths::of_one(&of, &parts),
            );
        }
        let by_recording: Vec<usize> = of.iter().map(|touch| touch.recording).collect();
        let typical = Typical::of(&of, &by_recording, (self.stages, typical::SHARE[1]));
        if self.poses.len() > MAX_POSES {
            return (typical, Paths::of_one(&of, &by_recording));
        }
        let pose = |recording: &usize| -> Vec<&Touch> {
            of.iter()
                .copied()
                .filter(|touch| touch.recording == *recording)
                .collect()
        };
        let poses: Vec<Vec<&Touch>> = self.poses.iter().map(pose).collect();
        (typical, Paths::of_several(&poses, self.sensor))
    }

    /// Blocks after which most touches have not yet ended.
    fn patience(&self, names: bool) -> u8 {
        let mut lengths: Vec<f64> = self.touches.iter().map(|t| t.len() as f64).collect();
        let patience = quantile(&mut lengths, IMPATIENT[usize::from(names)]).unwrap_or(1.0);
        // At most nine.
        patience.floor().clamp(1.0, BLOCKS as f64) as u8
    }

    fn head(&self, names: bool, whisked: Whisked, poses: usize) -> Vec<u32> {
        // One that names says what it has to say of a touch once: what would follow depends on it.
        let deflections = if names { DEFLECTIONS } else { 0 };
        let begins_again = u8::from(self.begins_again) << 1;
        let kind = u8::from(names) | begins_again | LATE | deflections;
        // At most twelve, and eight.
        let head = [kind, poses as u8, self.stages as u8, self.patience(names)];
        let least = LEAST_POSTERIOR[usize::from(self.begins_again)];
        let odds = (1.0 / least - 1.0) * f64::from(1 << 26);
        let Sense { narrow, rest, .. } = self.sense;
        vec![
            u32::from_le_bytes(head),
            odds as u32,
            narrow.centre.cast_unsigned(),
            narrow.shift,
            rest[0].cast_unsigned(),
            rest[1].cast_unsigned(),
            whisked.frequency_mhz.unwrap_or(0),
            whisked.has_rcp.map_or(0, |has_rcp| 1 + u32::from(has_rcp)),
        ]
    }
}
