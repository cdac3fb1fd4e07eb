//! A sensor that fails on its wires, on either side or on both: does the board switch
//! that side's motor off, or all where the scene says so, feel nothing there, say why,
//! and carry on once the sensor is back?

use std::path::Path;

use firmware::Event;
use host_sim::Error;
use host_sim::bus::{Slave, WireFault};
use mlx90333::Faults;
use scene::OnFault;

use crate::chip::SIDE_NAMES;
use crate::deployment::flashed;
use crate::trouble::Trouble;

/// What befalls a sensor, and which fault its whisker then has.
struct Loss {
    befall: fn(&mut Slave),
    mend: fn(&mut Slave),
    fault: u8,
    /// A line that follows.
    reason: Option<&'static str>,
    /// Tenths of a second within which it is found.
    tenths: u32,
}

const fn on_the_wire(befall: fn(&mut Slave), fault: u8) -> Loss {
    Loss {
        befall,
        mend: |slave| slave.set_fault(None),
        fault,
        reason: None,
        tenths: 1,
    }
}

const LOSSES: [Loss; 6] = [
    on_the_wire(|slave| slave.set_fault(Some(WireFault::Silent)), 18),
    on_the_wire(|slave| slave.set_fault(Some(WireFault::LineLow)), 19),
    on_the_wire(|slave| slave.set_fault(Some(WireFault::BadSum)), 21),
    Loss {
        befall: |slave| slave.set_error_word(Faults::FIELD_TOO_LOW),
        mend: |slave| slave.set_error_word(Faults::NONE),
        fault: 22,
        reason: Some("field too low"),
        tenths: 1,
    },
    on_the_wire(|slave| slave.set_fault(Some(WireFault::LowAfterStart)), 23),
    Loss {
        // A quarter of a second, unless the scene has another.
        tenths: 3,
        ..on_the_wire(|slave| slave.set_fault(Some(WireFault::Frozen)), 24)
    },
];

/// Of the ticks in which a motor is to whisk, how many it is driven in at least: it rests
/// where it turns round, and where it is on its setpoint.
const DRIVEN: f64 = 0.5;

/// Breaks the sensors of the scene in `path`, of either side and of both, in every way
/// and mends them again. Meanwhile there must be no contact on those sides, their motors
/// must be off and the others driven, unless all are to stop, and the log must say whose
/// sensor fails, and why. Returns the lines of the log.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn lose(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (loaded, program) = flashed(path, program)?;
    let mut trouble = Trouble::new(&loaded.scene, &program)?;
    let tenth = loaded.scene.tick_hz / 10;
    let sides: Vec<usize> = (0..loaded.scene.head.sides.count()).collect();
    let mut lost: Vec<&[usize]> = sides.chunks(1).collect();
    if sides.len() > 1 {
        lost.push(&sides);
    }
    trouble.pass(tenth)?;
    let motor = loaded.scene.motor.as_ref();
    let stops_all = motor.is_some_and(|motor| motor.on_fault == OnFault::StopAll);
    let mut lines = Vec::new();
    for lost in lost {
        let off = if stops_all { &sides } else { lost };
        for loss in &LOSSES {
            lines.extend(pass_through(&mut trouble, tenth, lost, off, loss)?);
        }
    }
    Ok(lines)
}

/// Broken for as long as it takes to be found, mended for a tenth of a second, each seen to
/// its end for a tenth more; the sensors of the sides `lost` break, and the motors of those
/// `off` must rest.
fn pass_through(
    trouble: &mut Trouble,
    tenth: u32,
    lost: &[usize],
    off: &[usize],
    loss: &Loss,
) -> Result<Vec<String>, Error> {
    trouble.log.clear();
    for &side in lost {
        (loss.befall)(sensor(trouble, side)?);
    }
    trouble.pass(loss.tenths * tenth)?;
    check(trouble, tenth, off, &format!("after fault {}", loss.fault))?;
    let contact = trouble.run.row().contact;
    if let Some(side) = lost.iter().find(|&&side| contact[side] != 0.0) {
        let what = format!(
            "the {} still has contact, after fault {}",
            SIDE_NAMES[*side], loss.fault
        );
        return Err(Error::Work(what));
    }
    let mut lines = Vec::new();
    for (side, name) in SIDE_NAMES.into_iter().enumerate() {
        let line = format!("fault {name} ");
        if lost.contains(&side) {
            lines.push(trouble.line(&format!("{line}{} ", loss.fault))?);
        } else if trouble.log.iter().any(|said| said.contains(&line)) {
            let what = format!(
                "the log has a fault of the {name} too, after fault {}",
                loss.fault
            );
            return Err(Error::Work(what));
        }
    }
    if let Some(reason) = loss.reason {
        lines.push(trouble.line(reason)?);
    }

    for &side in lost {
        (loss.mend)(sensor(trouble, side)?);
    }
    trouble.pass(tenth)?;
    check(
        trouble,
        tenth,
        &[],
        &format!("mended from fault {}", loss.fault),
    )?;
    for &side in lost {
        lines.push(trouble.line(&format!("back {}", SIDE_NAMES[side]))?);
    }
    Ok(lines)
}

fn sensor(trouble: &mut Trouble, side: usize) -> Result<&mut Slave, Error> {
    let slave = trouble.run.slave_mut(side);
    slave.ok_or_else(|| Error::Work("the scene has no such sensor".to_owned()))
}

/// Lets so many ticks pass: the motors of the sides `off` must rest in all of them, the
/// others be driven in [`DRIVEN`] of them, and nothing be decided on the sides `off`.
fn check(trouble: &mut Trouble, ticks: u32, off: &[usize], when: &str) -> Result<(), Error> {
    let mut driven = [0; 2];
    for _ in 0..ticks {
        trouble.pass(1)?;
        let events = trouble.run.events().iter();
        let mut deciding = events.filter_map(|event| match event {
            Event::Decision(place, _) => Some(usize::from(place.side)),
            _ => None,
        });
        if let Some(side) = deciding.find(|side| off.contains(side)) {
            let name = SIDE_NAMES[side];
            return Err(Error::Work(format!("{when} the {name} still decides")));
        }
        for (count, is_driven) in driven.iter_mut().zip(trouble.driven()) {
            *count += u32::from(is_driven);
        }
    }
    let sides = trouble.driven().len();
    for (side, count) in driven.into_iter().enumerate().take(sides) {
        let must = if off.contains(&side) { "off" } else { "driven" };
        let is_right = match must {
            "off" => count == 0,
            _ => f64::from(count) >= DRIVEN * f64::from(ticks),
        };
        if !is_right {
            return Err(Error::Work(format!(
                "{when} the {} motor is driven in {count} of {ticks} ticks, and should be {must}",
                SIDE_NAMES[side]
            )));
        }
    }
    Ok(())
}
