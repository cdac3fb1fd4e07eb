//! A sensor that fails on its wires: does the board switch its motor off, say
//! why, and carry on once the sensor is back?

use std::path::Path;

use host_sim::Error;
use host_sim::bus::{Slave, WireFault};
use host_sim::commands::run::Loaded;
use mlx90333::Faults;

use crate::chip::Chip;
use crate::trouble::Trouble;

/// What befalls the sensor's frames, and what the log then says.
const TROUBLES: [(WireFault, &str); 3] = [
    (WireFault::Silent, "fault 18"),
    (WireFault::LineLow, "fault 19"),
    (WireFault::BadSum, "fault 21"),
];

/// Whether the motor is driven.
fn is_driven(trouble: &mut Trouble) -> bool {
    let machine = &mut trouble.board_mut().machine;
    let duties = machine.with_chip(|chip: &mut Chip| chip.motor_duties());
    duties.iter().any(|(on, _)| *on > 0)
}

fn sensor(trouble: &mut Trouble) -> Result<&mut Slave, Error> {
    let slave = trouble.run.slave_mut(0);
    slave.ok_or_else(|| Error::Work("the scene has no sensor".to_owned()))
}

/// Breaks the sensor of the scene in `path` in every way and mends it again;
/// while it is broken the motor must be off, and the log must say why. Returns
/// the lines of the log.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn lose(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let loaded = Loaded::new(path)?;
    let mut trouble = Trouble::new(&loaded.scene, program)?;
    let tenth = loaded.scene.tick_hz / 10;
    let mut heard = Vec::new();
    trouble.pass(tenth)?;
    for (fault, text) in TROUBLES {
        sensor(&mut trouble)?.set_fault(Some(fault));
        let mend = |slave: &mut Slave| slave.set_fault(None);
        heard.extend(pass_through(&mut trouble, tenth, text, mend)?);
    }
    sensor(&mut trouble)?.set_error_word(Faults::FIELD_TOO_LOW);
    let mend = |slave: &mut Slave| slave.set_error_word(Faults::NONE);
    heard.extend(pass_through(&mut trouble, tenth, "field too low", mend)?);
    Ok(heard)
}

/// A tenth of a second broken, a tenth mended.
fn pass_through(
    trouble: &mut Trouble,
    tenth: u32,
    text: &str,
    mend: impl Fn(&mut Slave),
) -> Result<[String; 2], Error> {
    trouble.log.clear();
    trouble.pass(tenth)?;
    if is_driven(trouble) {
        let fault = format!("the motor is driven, after {text}");
        return Err(Error::Work(fault));
    }
    let said = trouble.hear(text)?;
    mend(sensor(trouble)?);
    trouble.pass(tenth)?;
    let mut driven = is_driven(trouble);
    // A motor that turns round rests for a tick.
    for _ in 0..tenth {
        trouble.pass(1)?;
        driven |= is_driven(trouble);
    }
    if !driven {
        let fault = format!("the motor stays off, after {text}");
        return Err(Error::Work(fault));
    }
    Ok([said, trouble.hear("sensor is back")?])
}
