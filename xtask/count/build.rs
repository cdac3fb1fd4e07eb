//! The memory map of the counting program, and the models that its classifiers read.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use tactile::train::{Options, Trainer, joint};

/// More than any chip has: both number formats of software are in it at once.
const MEMORY: &str = "MEMORY
{
  FLASH : ORIGIN = 0x08000000, LENGTH = 1M
  RAM : ORIGIN = 0x20000000, LENGTH = 256K
}
";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let output = PathBuf::from(env::var("OUT_DIR")?);
    if env::var("CARGO_CFG_TARGET_OS")? == "none" {
        // The workspace's memory.x, which cortex-m-rt reads, includes this.
        fs::write(output.join("board.x"), MEMORY)?;
        println!("cargo::rustc-link-search={}", output.display());
        println!(
            "cargo::rustc-link-search={}",
            env::var("CARGO_MANIFEST_DIR")? + "/../.."
        );
        for argument in ["--nmagic", "-Tlink.x"] {
            println!("cargo::rustc-link-arg-bins={argument}");
        }
    }
    // No block ends within a count, or every sample ends one.
    for (name, classes, block) in [
        ("open4", 4, 10_000),
        ("open9", 9, 10_000),
        ("block4", 4, 1),
        ("block9", 9, 1),
    ] {
        let path = output.join(format!("{name}.model"));
        fs::write(path, model(classes, block)?)?;
    }
    fs::write(output.join("joint4.model"), joint_model(4)?)?;
    Ok(())
}

fn model(classes: u32, block: u32) -> Result<Vec<u8>, Box<dyn Error>> {
    let options = Options {
        block,
        ..Options::default()
    };
    let mut trainer = Trainer::new(2, options)?;
    let mut sample = samples();
    for class in 0..classes {
        let name = format!("class {class}");
        for _ in 0..500 {
            trainer.add(&name, &sample(class))?;
        }
    }
    Ok(trainer.train()?.as_bytes().to_vec())
}

fn joint_model(classes: u32) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut sample = samples();
    let mut trials = Vec::new();
    for class in 0..classes {
        for _ in 0..4 {
            let samples: Vec<[f64; 2]> = (0..400).map(|_| sample(class)).collect();
            trials.push(joint::Trial {
                label: format!("class {class}"),
                recording: String::new(),
                pose: None,
                stands: None,
                touches: vec![1; samples.len()],
                samples,
            });
        }
    }
    let trained = joint::train(&trials, &joint::Options::default())?;
    Ok(trained.model()?.as_bytes().to_vec())
}

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
