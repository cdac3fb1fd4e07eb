//! How soon a touch is noticed, and how often where there is none, on both plants.
//!
//! The truth is the plant's: a contact begins where something is touched for the first
//! time in 20 ms. What the touch adds to the deflection is the difference of two
//! whiskers without noise on the same way, one before the surface and one in the air.

#![allow(clippy::print_stdout, reason = "a measurement")]

use host_sim::classifier::Classifier;
use host_sim::plant::{Elastic, ElasticSettings, Head, Plant, Textured, TexturedSettings};
use host_sim::recording::{GATE, Recorder, Stream};
use host_sim::run::Run;
use physics::{Biotact, Shaft};
use scene::{ClassifierSection, PlantKind, Rule, Scene, Texture};
use tactile::train::joint::{Options, Trial, train};
use tactile::{TouchDetector, Touching};

const TEXTURES: &str = include_str!("../../../scenes/textures.toml");
const WHISKER: &str = include_str!("../../../scenes/whisker.toml");
const TICK_HZ: f64 = 2000.0;
/// Ticks until the detector has learnt what is in the air.
const LEARNT: u64 = 4000;
/// 100 ms and 20 ms.
const GAP: u32 = 200;
const PARTED: u64 = 40;
/// Three deviations of the sensor's noise, codes.
const NOTICEABLE: f64 = 12.0;

fn scene(text: &str, hz: f64, limit_deg: f64, seconds: f64, seed: u64) -> Scene {
    let mut scene = Scene::from_str("s.toml", text).unwrap();
    scene.whisking.as_mut().unwrap().frequency_hz = hz;
    scene.plant.obstacle.as_mut().unwrap().obstacle_deg = vec![limit_deg];
    scene.classifier = None;
    scene.duration_s = seconds;
    scene.seed = seed;
    scene
}

/// The plant of a scene without noise, or the same whisker in the air.
fn silent(scene: &Scene, in_air: bool) -> Box<dyn Plant> {
    let obstacle = scene.plant.obstacle.as_ref().unwrap();
    let limit = if in_air {
        1000.0
    } else {
        obstacle.obstacle_deg[0]
    };
    let head = Head {
        whiskers_per_side: 1,
        obstacle_deg: vec![limit],
        stiffness: obstacle.stiffness,
    };
    let noise_codes = 0.0;
    if scene.plant.kind == PlantKind::Textured {
        let settings = TexturedSettings {
            noise_codes,
            ..TexturedSettings::default()
        };
        Box::new(Textured::new(head, settings, scene.seed).unwrap())
    } else {
        let settings = ElasticSettings {
            noise_codes,
            ..ElasticSettings::of(Shaft::biotact(Biotact::Middle))
        };
        Box::new(Elastic::new(head, settings, scene.seed).unwrap())
    }
}

/// What happened in some runs.
#[derive(Debug, Default)]
struct Found {
    /// Ticks from the contact, or from when it can be noticed, to the detector's.
    from_contact: Vec<u64>,
    from_noticeable: Vec<u64>,
    /// Contacts that began while the last one still counted, and that were missed.
    already: u64,
    missed: u64,
    /// Touches in truth, and as told.
    touches: u64,
    told: u64,
}

impl Found {
    fn contacts(&mut self, scene: &Scene) {
        let mut run = Run::new(scene, None).unwrap();
        let (mut touched, mut free) = (silent(scene, false), silent(scene, true));
        let mut detector = TouchDetector::new();
        let (mut label, mut still) = ("", u64::MAX);
        // Since when a contact goes on that the detector has not told, and could have.
        let (mut contact, mut noticeable): (Option<u64>, Option<u64>) = (None, None);
        for n in 0..run.ticks() {
            let touches = run.touches();
            let [with, without] = [&touched, &free].map(|plant| plant.deflection(0, 0));
            let added = (0..2).map(|i| (with[i] - without[i]).abs() * 8191.0);
            let row = run.tick();
            if run.presented().0 != label {
                label = run.presented().0;
                touched.present(texture(scene, label));
            }
            for plant in [&mut touched, &mut free] {
                plant.advance(&[row.angle_deg[0]], 1.0 / TICK_HZ);
            }
            let before = detector.in_contact();
            let codes = [row.x[0] as u16, row.y[0] as u16];
            let Touching { is_onset, .. } = detector.step(codes, row.contact[0] >= GATE, GAP);
            if n >= LEARNT {
                self.told += u64::from(is_onset);
                if touches && still >= PARTED {
                    self.touches += u64::from(still >= u64::from(GAP));
                    self.missed += u64::from(contact.is_some());
                    (contact, noticeable) = (None, None);
                    if before {
                        self.already += 1;
                    } else {
                        contact = Some(n);
                    }
                }
                if contact.is_some() && added.fold(0.0, f64::max) >= NOTICEABLE {
                    noticeable = noticeable.or(Some(n));
                }
                if let Some(since) = contact.filter(|_| detector.in_contact()) {
                    self.from_contact.push(n - since);
                    self.from_noticeable.push(n - noticeable.unwrap_or(n));
                    contact = None;
                }
            }
            still = if touches { 0 } else { still.saturating_add(1) };
        }
    }

    fn print(&mut self, title: &str) {
        let list = |ticks: &mut Vec<u64>| {
            ticks.sort_unstable();
            let at = |share: f64| {
                let place = (share * ticks.len() as f64) as usize;
                let ticks = ticks.get(place.min(ticks.len().saturating_sub(1)));
                ticks.map_or(f64::NAN, |ticks| *ticks as f64 * 1000.0 / TICK_HZ)
            };
            let within = ticks.iter().filter(|ticks| **ticks <= 4).count();
            let mean = ticks.iter().sum::<u64>() as f64 / ticks.len() as f64 * 1000.0 / TICK_HZ;
            let within = 100.0 * within as f64 / ticks.len() as f64;
            format!(
                "{mean:.2} | {:.1} | {:.1} | {:.1} | {within:.1} %",
                at(0.5),
                at(0.9),
                at(1.0)
            )
        };
        println!(
            "| {title} | {} | {} | {} | {} | {} | {} | {} |",
            self.from_contact.len(),
            list(&mut self.from_noticeable),
            list(&mut self.from_contact),
            self.already,
            self.missed,
            self.touches,
            self.told
        );
    }
}

fn texture(scene: &Scene, label: &str) -> Texture {
    let textured = scene.plant.textured.as_ref().unwrap();
    let mut textures = textured.textures.iter();
    *textures.find(|texture| texture.name() == label).unwrap()
}

/// Touches told in the air.
fn in_air(scene: &Scene) -> u64 {
    let mut run = Run::new(scene, None).unwrap();
    let mut detector = TouchDetector::new();
    let mut told = 0;
    for _ in 0..run.ticks() {
        let row = run.tick();
        let codes = [row.x[0] as u16, row.y[0] as u16];
        let touching = detector.step(codes, row.contact[0] >= GATE, GAP);
        told += u64::from(touching.is_onset);
    }
    told
}

fn cases() -> impl Iterator<Item = (&'static str, &'static str, f64)> {
    [("textured", TEXTURES), ("whisker", WHISKER)]
        .into_iter()
        .flat_map(|(name, text)| [2.0, 8.0].map(|hz| (name, text, hz)))
}

#[test]
fn at_2_hz_each_touch_is_told_within_2_ms_on_average() {
    for text in [TEXTURES, WHISKER] {
        let mut found = Found::default();
        found.contacts(&scene(text, 2.0, 100.0, 20.0, 3201));
        let ticks: u64 = found.from_noticeable.iter().sum();
        assert!(
            found.touches > 30 && ticks <= 4 * found.touches,
            "{found:?}"
        );
        assert_eq!((found.missed, found.told), (0, found.touches));
    }
}

/// With a model that knows touches.
#[test]
fn nothing_is_decided_in_the_air() {
    let mut run = Run::new(&scene(WHISKER, 2.0, 100.0, 20.0, 3301), None).unwrap();
    let mut recorder = Recorder::default();
    for _ in 0..run.ticks() {
        run.tick();
        recorder.take(&mut run);
    }
    let trial = |stream: Stream| Trial {
        counts: stream.counts(GATE).collect(),
        label: stream.label,
        recording: "run".to_owned(),
        samples: stream.samples,
    };
    let trials: Vec<_> = recorder.into_streams().into_iter().map(trial).collect();
    let model = train(&trials, &Options::default())
        .unwrap()
        .model()
        .unwrap();
    let rule = Rule::Sequential { threshold: 0.99 };
    for (limit_deg, hz) in [(300.0, 2.0), (300.0, 8.0), (100.0, 2.0)] {
        let mut scene = scene(WHISKER, hz, limit_deg, 20.0, 3302);
        scene.classifier = Some(ClassifierSection {
            rule,
            model: String::new(),
            contact_min: None,
        });
        let classifier = Classifier::new(model.clone(), rule).unwrap();
        let mut run = Run::new(&scene, Some(classifier)).unwrap();
        let decisions = (0..run.ticks()).filter(|_| {
            run.tick();
            run.decision().is_some()
        });
        assert_eq!(decisions.count() > 0, limit_deg < 200.0, "{limit_deg} {hz}");
    }
}

#[test]
#[ignore = "minutes: prints the measurement"]
fn measurement() {
    println!(
        "| plant, Hz | contacts | ms since three deviations: mean, median, 90 %, worst, within 2 ms | the same since contact | already | missed | touches | told |"
    );
    for (name, text, hz) in cases() {
        let mut found = Found::default();
        for seed in 4001..4011 {
            found.contacts(&scene(text, hz, 100.0, 40.0, seed));
        }
        found.print(&format!("{name}, {hz} Hz"));
    }
    for (name, text, hz) in cases() {
        let told = (4101..4105).map(|seed| in_air(&scene(text, hz, 300.0, 600.0, seed)));
        println!(
            "| {name}, {hz} Hz | in ten minutes of air, each seed | {:?} |",
            told.collect::<Vec<_>>()
        );
    }
}
