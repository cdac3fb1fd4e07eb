//! From a scene to the configuration of its module.
//!
//! One place for all who need one: the simulator when a run is built, `cargo xtask firmware` for
//! what is linked into an image, `whisker deploy` and `whisker set` for what is sent to a board.
//! So all of them run by the same numbers.

mod bearable;
mod classes;
mod fits;
mod image;
mod linked;
mod module;
mod numbers;
mod protecting;
mod settling;
mod stability;

pub use bearable::Unbearable;
pub use classes::{classes, classes_of};
pub use fits::Unfit;
pub use image::{AnyConfig, Image, image};
pub use linked::{Unlinked, linked};
pub use module::{GATE, RunsOn, Target, build, bus, decoder, rule_settings};
pub use numbers::{NoSuchFormat, in_simulation, on_board};
pub use protecting::Unprotected;
pub use settling::Unsettled;
pub use stability::{Instability, Unstable};
pub use whisking::FormatCode as NumberFormat;

use scene::{PlantKind, Scene};
use tactile::{ModelBuf, Whisked};
use whisking::{Error, Real, filter};

/// What is wrong with a scene for its module.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum Mismatch {
    #[error("the scene has another number of sides or whiskers")]
    Shape,
    #[error(transparent)]
    Value(#[from] Error),
    #[error("{0}")]
    Unstable(Unstable),
    #[error(transparent)]
    Unbearable(#[from] Unbearable),
    #[error(transparent)]
    Unsettled(#[from] Unsettled),
    #[error(transparent)]
    Unprotected(#[from] Unprotected),
    #[error(
        "motor.counts_per_rev: found {found}; allowed with a gear of {gear} and motor.rest = \
         \"find\": at least {allowed}, or a motor that stands against its stop cannot be told from \
         one that turns slowly"
    )]
    Coarse { found: u32, gear: f64, allowed: f64 },
    #[error(
        "classifier.contact_min: found {found}; allowed: {gate}, from which the model was trained, \
         or nothing"
    )]
    Gate { found: f64, gate: f32 },
    #[error(
        "classifier.model: found one that was trained {}; the scene whisks {}",
        words(.trained),
        words(.scene)
    )]
    Whisked { trained: Whisked, scene: Whisked },
    #[error(
        "classifier.model: found one of {found} channels; allowed with {heard} whiskers that \
         decide: 2, x and y, or 2 of each of them"
    )]
    Whiskers { found: usize, heard: usize },
    #[error(
        "classifier.pose: found true; allowed with this model: false, because it was not trained \
         from poses (tilt_deg and depth_deg of recordings)"
    )]
    Pose,
    #[error(
        "classifier.model: found one that was trained at {trained} samples a second; the scene has \
         tick_hz = {scene}"
    )]
    Rate { trained: u32, scene: u32 },
    #[error("classifier.threshold: found {found}; {fault}")]
    Threshold {
        found: f64,
        fault: tactile::SetupError,
    },
    #[error("classifier.{key}: found {found}; allowed: {allowed}")]
    Classes {
        key: &'static str,
        found: String,
        allowed: String,
    },
    #[error("{0}")]
    Config(#[from] firmware::ConfigError),
}

/// Where a condition that holds for small values ends, from 0 to `high`: at 0 if it never does.
fn edge(mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let mut low = 0.0;
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn words(whisked: &Whisked) -> String {
    let frequency = whisked.frequency_mhz;
    let frequency = frequency.map(|mhz| format!("at {} Hz", f64::from(mhz) / 1000.0));
    let rcp = whisked.has_rcp.map(|has_rcp| {
        let rcp = if has_rcp { "with RCP" } else { "without RCP" };
        rcp.to_owned()
    });
    let known: Vec<String> = frequency.into_iter().chain(rcp).collect();
    known.join(" ")
}

/// How a scene whisks; nothing is known of a passive one.
pub fn whisked(scene: &Scene) -> Whisked {
    let whisking = scene.whisking.as_ref();
    Whisked {
        frequency_mhz: whisking.map(|whisking| (whisking.frequency_hz * 1000.0).round() as u32),
        has_rcp: whisking.map(|_| scene.rcp.is_some()),
    }
}

/// What a model holds decisions against is of the motion that it was trained in.
fn whisks_as(scene: &Scene, trained: Whisked) -> Result<(), Mismatch> {
    let scene = whisked(scene);
    if trained.differs(&scene) {
        return Err(Mismatch::Whisked { trained, scene });
    }
    Ok(())
}

/// Whether a scene moves and ticks as its model was trained, as far as that is known, and has
/// its whiskers.
///
/// # Errors
/// [`Mismatch::Whiskers`]: there are tables of others; [`Mismatch::Whisked`]; [`Mismatch::Rate`]:
/// blocks, gaps and roughness would be of other times; [`Mismatch::Pose`].
pub fn suits(scene: &Scene, model: &ModelBuf) -> Result<(), Mismatch> {
    whisks_as(scene, model.whisked())?;
    let heard = scene.classifier.as_ref();
    let heard = heard.map_or(1, |of| of.whiskers.heard(scene.whiskers()));
    if ![2, 2 * heard].contains(&model.channels()) {
        return Err(Mismatch::Whiskers {
            found: model.channels(),
            heard,
        });
    }
    if scene.classifier.as_ref().is_some_and(|of| of.pose) && !model.has_pose() {
        return Err(Mismatch::Pose);
    }
    let scene = scene.tick_hz;
    match model.rate_hz() {
        Some(trained) if trained != scene => Err(Mismatch::Rate { trained, scene }),
        _ => Ok(()),
    }
}

/// The pattern generator's settings; `None` for a passive scene.
pub fn settings(scene: &Scene) -> Option<whisking::Settings> {
    let whisking = scene.whisking.as_ref()?;
    Some(whisking::Settings {
        tick_hz: f64::from(scene.tick_hz),
        frequency_hz: whisking.frequency_hz,
        integrator: whisking.integrator,
        coupling: whisking.coupling,
        noise: whisking.noise,
        rcp: scene.rcp,
        cia: scene.cia,
    })
}

/// Whether the scene's integrator can carry it: `exact` can carry any scene, forward Euler none
/// whose muscles swing up; and its motor can bear its whisking. [`build`] checks both too.
///
/// # Errors
/// [`Mismatch::Unstable`], [`Mismatch::Unbearable`].
pub fn check(scene: &Scene) -> Result<(), Mismatch> {
    let is_ideal = scene.plant.kind == PlantKind::Ideal;
    if let (Some(whisking), Some(motor)) = (&scene.whisking, &scene.motor)
        && !is_ideal
    {
        bearable::check(whisking, motor)?;
    }
    let Some(settings) = settings(scene) else {
        return Ok(());
    };
    match stability::check(&settings, true)? {
        None => Ok(()),
        Some(unstable) => Err(Mismatch::Unstable(unstable)),
    }
}

/// What forward Euler carries badly in a scene that it can carry: oscillators
/// and gates that live by their clamps. For a word to the user.
pub fn cautions(scene: &Scene) -> Option<Unstable> {
    stability::check(&settings(scene)?, false).ok()?
}

/// The contact below which the classifier of a scene does not listen: that of its model,
/// `gate`, or the scene's. None: it always listens.
///
/// # Errors
/// [`Mismatch::Gate`] if both have one and not the same: the model's weights and floors
/// hold for what it was trained on.
pub fn contact_min(scene: &Scene, gate: Option<f32>) -> Result<Option<f64>, Mismatch> {
    let classifier = scene.classifier.as_ref();
    let found = classifier.and_then(|classifier| classifier.contact_min);
    match (found, gate) {
        (Some(found), Some(gate)) if found as f32 != gate => Err(Mismatch::Gate { found, gate }),
        (found, gate) => Ok(found.or(gate.map(f64::from))),
    }
}

/// H50 for the contact signals, where the scene has something that uses them:
/// RCP, CIA, zeros that are found in silences, or a classifier that `listens` only during
/// contact, or whose model is deployed later and may have it listen so.
///
/// # Errors
/// [`Mismatch::Value`] for a tick rate that leaves no room for 50 Hz.
pub fn contact<R: Real>(
    scene: &Scene,
    listens: bool,
) -> Result<Option<filter::Config<R>>, Mismatch> {
    let listens = listens || scene.awaits_model() || scene.sensor.zero_after_s.is_some();
    if scene.rcp.is_none() && scene.cia.is_none() && !listens {
        return Ok(None);
    }
    Ok(Some(filter::Config::new(
        filter::CORNER_HZ,
        f64::from(scene.tick_hz),
    )?))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::{RunsOn, Target, Whisked, build, check, contact, contact_min, whisked, whisks_as};
    use firmware::{Config, MotionConfig};
    use scene::Scene;
    use whisking::{Fix, State};

    const BOARD: Target<'static> = Target::of(RunsOn::Board);

    fn motion(scene: &Scene) -> MotionConfig<f64> {
        build::<f64>(scene, BOARD).unwrap().motion.unwrap()
    }

    const SCENE: &str = r#"
name = "rcp7"
tick_hz = 2000
duration_s = 6.0
seed = 1
[head]
whiskers_per_side = 2
[whisking]
frequency_hz = 2.0
integrator = "exact"
coupling = true
noise = 0.0
gain = [0.5, 1.0, 1.5, 2.0]
start = [[1.0, 0.0], [0.6, 0.5]]
[rcp]
gain = 0.7
tau_s = 0.125
[plant]
kind = "ideal"
"#;

    const PASSIVE: &str = "name=\"p\"\ntick_hz=2000\nduration_s=1\nseed=1\n\
        [head]\nwhiskers_per_side=1\n[plant]\nkind=\"ideal\"\n";

    /// The scene with these keys, `KEY=VALUE`, in the place of its own.
    pub(crate) fn scene(keys: &[&str]) -> Scene {
        let keys = keys.iter().map(|key| key.parse().unwrap());
        let read = Scene::from_str_with("rcp7.toml", SCENE, &keys.collect::<Vec<_>>());
        read.unwrap_or_else(|problems| panic!("{problems}")).0
    }

    pub(crate) fn passive() -> Scene {
        Scene::from_str("p.toml", PASSIVE).unwrap()
    }

    #[test]
    fn every_value_reaches_its_place_left_side_first() {
        let scene = scene(&[]);
        let motion = motion(&scene);
        let whiskers = motion.start.whiskers.iter();
        assert!(whiskers.map(|whisker| (whisker.side, whisker.gain)).eq([
            (0, 0.5),
            (0, 1.0),
            (1, 1.5),
            (1, 2.0)
        ]));
        let psi = State::new(&motion.start, 0).oscillators;
        let psi = motion.whisking.oscillators.psi(&psi);
        for (found, said) in psi.iter().flatten().zip([1.0, 0.0, 0.6, 0.5]) {
            assert!((found - said).abs() < 1e-12);
        }
        let rcp = motion.whisking.rcp.unwrap();
        assert!((1.0 - rcp.decay.tick - (-1.0_f64 / 250.0).exp()).abs() < 1e-15);
        assert_eq!(rcp.gain, 0.7);
        assert!(motion.whisking.cia.is_none() && motion.whisking.noise.is_none());
        // 512 counts a turn of the motor and a gear of 11: 0.0639 degrees a count.
        let counts_to_90_deg = 512.0 * 11.0 / 4.0;
        let theta = motion.servo.pd.theta_per_count * counts_to_90_deg;
        assert!((theta - 0.9).abs() < 1e-12);
        assert!(contact::<f64>(&scene, false).unwrap().is_some());
    }

    #[test]
    fn guards_are_in_counts_of_the_encoder() {
        let scene = scene(&[]);
        let guards = motion(&scene).servo.guards;
        let hard = guards.stall.threshold.q15();
        assert_eq!(hard, 16_384, "half of a full duty");
        // 40 degrees; 30 - 20 and 160 + 20 from a rest of 50; 15,000 degrees in 2000 ticks.
        assert_eq!((guards.error, guards.error_ticks), (0.4, 80));
        assert_eq!(guards.travel, [-625, 2034]);
        assert_eq!((guards.speed, guards.against), (118, 704));
        // 0.4 squared, and 8.2 s.
        assert!((f64::from(guards.heat) / f64::from(1 << 30) - 0.16).abs() < 1e-4);
        assert_eq!(guards.heat_shift, 14);
        let model = guards.model.expect("a motor that is real");
        // 0.8 of full duty, for 4.0 ms, in which a motor without friction would turn three times half
        // a degree, and half of the 2 ms of its rise; 8 counts of 0.064 degrees.
        assert_eq!((model.test, model.turned), (13_421_772, 8));
        assert_eq!((model.stroke, model.grace), (11, 20));
    }

    fn whisks<R: whisking::Real>(scene: &Scene, mhz: f64, ticks: f64) {
        // Not all that is whisked here is borne by a motor.
        let runs_on = RunsOn::Simulation { records: false };
        let target = Target { runs_on, ..BOARD };
        let module = build::<R>(scene, target).unwrap().whisked();
        assert_eq!(module.has_rcp, whisked(scene).has_rcp);
        let found = f64::from(module.frequency_mhz.unwrap());
        // Two units of 2^-24 whisks a tick, and rounded down.
        let most = 0.002 * mhz + 2.0 * ticks * 1000.0 / f64::from(1 << 24) + 1.0;
        assert!((found - mhz).abs() <= most, "{found} {mhz} {ticks}");
    }

    #[test]
    fn module_and_scene_whisk_alike() {
        for (hz, ticks) in [
            (0.05, 200),
            (2.0, 2000),
            (25.0, 200),
            (0.5, 10_000),
            (7.5, 1000),
        ] {
            for integrator in ["exact", "euler"] {
                let scene = scene(&[
                    &format!("whisking.frequency_hz={hz:?}"),
                    &format!("tick_hz={ticks}"),
                    &format!("whisking.integrator={integrator}"),
                ]);
                assert_eq!(whisked(&scene).frequency_mhz, Some((hz * 1000.0) as u32));
                // Forward Euler does not carry all of them.
                if check(&scene).is_err() {
                    continue;
                }
                whisks::<f32>(&scene, hz * 1000.0, f64::from(ticks));
                whisks::<f64>(&scene, hz * 1000.0, f64::from(ticks));
                whisks::<Fix>(&scene, hz * 1000.0, f64::from(ticks));
            }
        }
    }

    #[test]
    fn a_model_that_was_whisked_otherwise_is_refused_in_words() {
        let scene = scene(&[]);
        let trained = |frequency_mhz, has_rcp| Whisked {
            frequency_mhz,
            has_rcp,
        };
        assert_eq!(whisks_as(&scene, trained(None, None)), Ok(()));
        assert_eq!(whisks_as(&scene, trained(Some(2050), Some(true))), Ok(()));
        for (trained, says) in [
            (trained(Some(2500), Some(true)), "at 2.5 Hz with RCP"),
            (trained(None, Some(false)), "without RCP"),
        ] {
            let refused = whisks_as(&scene, trained).unwrap_err().to_string();
            let expected = format!(
                "classifier.model: found one that was trained {says}; the scene whisks at 2 Hz \
                 with RCP"
            );
            assert_eq!(refused, expected);
        }
    }

    #[test]
    fn scene_and_model_have_one_gate() {
        let window = [
            "classifier.rule=window",
            "classifier.model=m",
            "classifier.window=20",
        ];
        let silent = scene(&window);
        let says = scene(&[&window[..], &["classifier.contact_min=0.05"]].concat());
        assert_eq!(contact_min(&says, None), Ok(Some(0.05)));
        assert_eq!(contact_min(&says, Some(0.05)), Ok(Some(0.05)));
        assert_eq!(contact_min(&silent, Some(0.25)), Ok(Some(0.25)));
        assert_eq!(contact_min(&silent, None), Ok(None));
        let refused = contact_min(&says, Some(0.25)).unwrap_err().to_string();
        assert!(refused.contains("found 0.05; allowed: 0.25"), "{refused}");
        // A scene that is only scored has a classifier all the same.
        assert_eq!(contact_min(&scene(&[]), Some(0.25)), Ok(Some(0.25)));
    }

    #[test]
    fn what_a_scene_leaves_out_is_none() {
        let config: Config<f32> = build(&passive(), BOARD).unwrap();
        assert!(config.motion.is_none() && config.contact.is_none());
        assert!(config.classifier.is_none());
        assert_eq!(config.check(), Ok(()));
    }
}
