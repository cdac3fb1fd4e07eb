//! Memory map of the emulated machine, and what the kernels need: configurations in
//! every number format, models to classify with.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use firmware::design_parameters::{Plausible, retry, sensor_limits};
use firmware::{ClassifierConfig, Config, Driver, MotionConfig, ServoConfig};
use tactile::train::{Options, Trainer, joint};
use tactile::{Deciding, RuleSettings, Threshold};
use whisking::motor::GuardSettings;
use whisking::{Fix, GateSettings, Integrator, Real, Settings, filter, pd};

/// Ticks a second: BIOTACT's.
const TICK_HZ: u32 = 2000;

/// A machine of the emulator: the target it stands for, its name, its memory.
const MACHINES: [(&str, &str, &str); 2] = [
    (
        "thumbv7em-none-eabihf",
        "mps2-an386",
        "CODE : ORIGIN = 0, LENGTH = 4M\n  RAM : ORIGIN = 0x20000000, LENGTH = 4M",
    ),
    (
        "thumbv6m-none-eabi",
        "microbit",
        "CODE : ORIGIN = 0, LENGTH = 256K\n  RAM : ORIGIN = 0x20000000, LENGTH = 16K",
    ),
];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(machine, values(\"mps2-an386\", \"microbit\"))");
    if env::var("CARGO_CFG_TARGET_OS")? == "none" {
        link(&env::var("TARGET")?)?;
    }
    configurations::<f32>("f32")?;
    configurations::<f64>("f64")?;
    configurations::<Fix>("fix")?;
    for classes in [4, 9] {
        // No block ends within a count, or every sample ends one.
        for (name, block) in [("open", 10_000), ("block", 1)] {
            let path = output(&format!("{name}{classes}.model"))?;
            fs::write(path, model(2, classes, block)?)?;
        }
    }
    fs::write(output("single4.model")?, model(1, 4, 10_000)?)?;
    fs::write(output("joint4.model")?, joint_model(4)?)?;
    Ok(())
}

fn output(name: &str) -> Result<PathBuf, Box<dyn Error>> {
    Ok(PathBuf::from(env::var("OUT_DIR")?).join(name))
}

fn link(target: &str) -> Result<(), Box<dyn Error>> {
    let (_, machine, memory) = MACHINES
        .into_iter()
        .find(|(known, _, _)| *known == target)
        .ok_or_else(|| format!("no emulated machine for {target}"))?;
    println!("cargo::rustc-cfg=machine={machine:?}");
    println!("cargo::rerun-if-changed=count.x");
    let script = output("count.x")?;
    let sections = fs::read_to_string("count.x")?;
    fs::write(&script, format!("MEMORY\n{{\n  {memory}\n}}\n\n{sections}"))?;
    println!("cargo::rustc-link-arg-bins=--nmagic");
    println!("cargo::rustc-link-arg-bins=-T{}", script.display());
    Ok(())
}

/// The pattern generator of every module, with this integrator.
fn settings(integrator: Integrator) -> Settings {
    let gate = |gain| GateSettings { gain, tau_s: 0.125 };
    Settings {
        tick_hz: TICK_HZ.into(),
        frequency_hz: 2.0,
        integrator,
        coupling: true,
        noise: 0.0,
        rcp: Some(gate(0.7)),
        cia: Some(gate(0.5)),
    }
}

/// The configurations in a number format: `NAME-FORMAT`.
fn configurations<R: Real>(format: &str) -> Result<(), Box<dyn Error>> {
    let exact = settings(Integrator::Exact);
    let noisy = Settings {
        noise: 0.005,
        ..exact
    };
    for (name, settings, sides, whiskers) in [
        ("1x1", exact, 1, 1),
        ("2x1", exact, 2, 1),
        ("2x12", exact, 2, 12),
        ("2x1-euler", settings(Integrator::Euler), 2, 1),
        ("2x1-noise", noisy, 2, 1),
    ] {
        let bytes = postcard::to_allocvec(&configuration::<R>(&settings, sides, whiskers)?)?;
        fs::write(output(&format!("{name}-{format}"))?, bytes)?;
    }
    Ok(())
}

/// A module with frames, contact filter, RCP, CIA, oscillators, muscles, position control
/// and a classifier of its first whisker.
fn configuration<R: Real>(
    settings: &Settings,
    sides: usize,
    whiskers: usize,
) -> Result<Config<R>, Box<dyn Error>> {
    let psi = [[0.6, -0.8], [0.0, -1.0]];
    let gains = vec![1.0; whiskers];
    let pd = pd::Settings {
        kp: 0.05,
        kd: 0.001,
        limit: 0.8,
        slew_per_s: 400.0,
        min_deg: 30.0,
        max_deg: 160.0,
        // BIOTACT's motor: 512 counts a turn, a gear of 11.
        degrees_per_count: 360.0 / (512.0 * 11.0),
    };
    let mut config = Config::still();
    config.head.tick_hz = TICK_HZ;
    config.head.sides = sides as u8;
    config.head.whiskers_per_side = whiskers as u8;
    // The samples are not a whisker's course; what is compared is the same.
    config.sensor.limits = sensor_limits(TICK_HZ, Plausible::ANY);
    config.contact = Some(filter::Config::new(filter::CORNER_HZ, TICK_HZ.into())?);
    config.motion = Some(MotionConfig {
        whisking: settings.build()?,
        start: settings.start(&psi[..sides], &vec![&gains[..]; sides])?,
        seed: 1,
        servo: ServoConfig {
            pd: pd.build(TICK_HZ.into())?,
            retry: retry(TICK_HZ),
            // What moves here is a counter, which no setpoint leads.
            guards: GuardSettings::NONE.build(TICK_HZ.into()),
            approach: R::ONE,
            homing: None,
        },
        driver: Driver::HBridge,
        stops_all: false,
        arms_at_start: true,
    });
    config.classifier = Some(ClassifierConfig {
        rule: Some(RuleSettings::Sequential(Threshold::new(0.99)?)),
        deciding: Deciding::First,
        contact_min: None,
    });
    Ok(config)
}

/// A model of sensor codes of one or two channels whose classes overlap.
fn model(channels: usize, classes: u32, block: u32) -> Result<Vec<u8>, Box<dyn Error>> {
    let options = Options {
        block,
        ..Options::default()
    };
    let mut trainer = Trainer::new(channels, options)?;
    let mut sample = samples();
    for class in 0..classes {
        let name = format!("class {class}");
        for _ in 0..500 {
            let sample = sample(class);
            trainer.add(&name, sample.get(..channels).unwrap_or(&sample))?;
        }
    }
    Ok(trainer.train()?.as_bytes().to_vec())
}

/// A joint model of the same.
fn joint_model(classes: u32) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut sample = samples();
    let mut trials = Vec::new();
    for class in 0..classes {
        for _ in 0..4 {
            let samples: Vec<[f64; 2]> = (0..400).map(|_| sample(class)).collect();
            trials.push(joint::Trial {
                label: format!("class {class}"),
                recording: String::new(),
                touches: vec![1; samples.len()],
                samples,
            });
        }
    }
    let trained = joint::train(&trials, &joint::Options::default())?;
    Ok(trained.model()?.as_bytes().to_vec())
}

/// Sensor codes x and y of a class.
fn samples() -> impl FnMut(u32) -> [f64; 2] {
    let mut random = 1_u32;
    let mut code = move |middle: u32| {
        // The sum of two is a triangle around the middle; a common generator
        // for a quick recording (Numerical Recipes, 7.1).
        let mut part = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            random >> 20
        };
        f64::from(middle + part() + part())
    };
    move |class| [code(2_000 + 400 * class), code(5_000 - 300 * class)]
}
