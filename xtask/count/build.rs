//! Memory map of the emulated machine, and what the kernels need: constants of
//! every number format, models to classify with, a filter for the peers.
//!
//! A number format is measured when it has a line in [`constants`].

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use databake::{Bake, CrateEnv, TokenStream, quote};
use tactile::train::{Options, Trainer, joint};
use whisking::motor::GuardSettings;
use whisking::{GateSettings, Integrator, Real, Settings, filter, muscle, oscillator, pd};

/// Ticks a second: BIOTACT's.
const TICK_HZ: f64 = 2000.0;

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
    fs::write(output("constants.rs")?, constants()?)?;
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

/// The constants of every number format.
fn constants() -> Result<String, Box<dyn Error>> {
    Ok([
        format::<f32>("f32")?,
        format::<f64>("f64")?,
        format::<whisking::Fix>("Fix")?,
        sections(),
    ]
    .concat())
}

fn settings(integrator: Integrator) -> Settings {
    let gate = |gain| GateSettings { gain, tau_s: 0.125 };
    Settings {
        tick_hz: TICK_HZ,
        frequency_hz: 2.0,
        integrator,
        coupling: true,
        noise: 0.005,
        rcp: Some(gate(0.7)),
        cia: Some(gate(0.5)),
    }
}

/// The source of constants, of each its name, its type and its value.
macro_rules! constants {
    ($($name:ident: $of_type:ty = $value:expr;)*) => {
        [$(line(
            stringify!($name),
            stringify!($of_type),
            &$value.bake(&CrateEnv::default()),
        )),*]
        .concat()
    };
}

fn format<R: Real>(name: &str) -> Result<String, Box<dyn Error>> {
    let euler = settings(Integrator::Euler);
    let exact = settings(Integrator::Exact);
    let [papers, whisking] = [euler.build::<R>()?, exact.build::<R>()?];
    let none = "settings without a part";
    let (oscillator::Config::Euler(papers_oscillators), muscle::Config::Euler(papers_muscle)) =
        (papers.oscillators, papers.muscle)
    else {
        return Err("not the papers' integrator".into());
    };
    let (oscillator::Config::Exact(oscillators), muscle::Config::Exact(muscle)) =
        (whisking.oscillators, whisking.muscle)
    else {
        return Err("not the exact integrator".into());
    };
    let left = [0.6, -0.8];
    let psi = [left, [0.0, -1.0]];
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
    // What moves here is a counter, which no setpoint leads.
    let guards = GuardSettings::NONE;
    let constants = constants! {
        H50: &'static filter::Config<Self> = filter::Config::<R>::new(filter::CORNER_HZ, TICK_HZ)?;
        RCP: &'static gate::Rcp<Self> = whisking.rcp.ok_or(none)?;
        CIA: &'static gate::Cia<Self> = whisking.cia.ok_or(none)?;
        NOISE: &'static noise::Config<Self> = whisking.noise.ok_or(none)?;
        EULER_OSCILLATORS: &'static oscillator::Euler<Self> = papers_oscillators;
        EULER_MUSCLE: &'static muscle::Euler<Self> = papers_muscle;
        EULER_START: Start<Self, 2, 1> = euler.start::<R, 2, 1>(psi, [[1.0]; 2])?;
        OSCILLATORS: &'static oscillator::Exact<Self> = oscillators;
        MUSCLE: &'static muscle::Exact<Self> = muscle;
        START_1: Start<Self, 1, 1> = exact.start::<R, 1, 1>([left], [[1.0]])?;
        START_2: Start<Self, 2, 1> = exact.start::<R, 2, 1>(psi, [[1.0]; 2])?;
        START_24: Start<Self, 2, 12> = exact.start::<R, 2, 12>(psi, [[1.0; 12]; 2])?;
        PD: &'static pd::Config<Self> = pd.build::<R>(TICK_HZ)?;
        GUARDS: &'static GuardConfig<Self> = guards.build::<R>(TICK_HZ);
    };
    Ok(format!(
        "impl Format for {name} {{\n    const NAME: &'static str = {:?};\n{constants}{}{}}}\n",
        name.to_lowercase(),
        generator("WHISKING", "Exact", whisking),
        generator("EULER_WHISKING", "Euler", papers),
    ))
}

/// `const NAME: TYPE = VALUE;`; of a reference the value is that of its target.
fn line(name: &str, of_type: &str, value: &TokenStream) -> String {
    let by_reference = if of_type.starts_with('&') { "&" } else { "" };
    format!("    const {name}: {of_type} = {by_reference}{value};\n")
}

/// A pattern generator without noise.
fn generator<R: Real>(name: &str, integrator: &str, config: whisking::Config<R>) -> String {
    let quiet = whisking::Config {
        noise: None,
        ..config
    };
    let of_type = format!(
        "&'static Generator<Self, oscillator::{integrator}<Self>, muscle::{integrator}<Self>>"
    );
    let source = quiet.source(&quote!(Self), &CrateEnv::default());
    line(name, &of_type, &source.value)
}

/// H50 as two second-order sections b0, b1, b2, a1, a2 (denominator
/// 1 + a1/z + a2/z²), for the peers: the bilinear transform, pre-warped.
fn sections() -> String {
    let g = (std::f64::consts::PI * filter::CORNER_HZ / TICK_HZ).tan();
    let first = g / (1.0 + g);
    let n = 1.0 / (1.0 + g + g * g);
    let second = g * g * n;
    let sections = [
        [first, first, 0.0, (g - 1.0) / (g + 1.0), 0.0],
        [
            second,
            2.0 * second,
            second,
            2.0 * (g * g - 1.0) * n,
            (1.0 - g + g * g) * n,
        ],
    ];
    format!("/// H50.\npub const SECTIONS: [[f64; 5]; 2] = {sections:?};\n")
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
