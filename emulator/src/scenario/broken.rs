//! Boards of which a part breaks: the sensors' wires, or bits of memory.

use host_sim::Error;
use host_sim::bus::WireFault::{BadSum, Frozen, LineLow, LowAfterStart, Silent};
use host_sim::bus::tmag5170::LineFault;
use mlx90333::Faults;
use scene::{Driver, OnFault, Scene, SensorModel};
use tmag5170::StatusFaults;

use super::runner::{Case, Done, Runner, Trouble};
use crate::chip::{Fault, Ps, SIDE_NAMES};
use crate::debug_info::DebugInfo;
use crate::program::Program;
use crate::watch::along;

/// What befalls sensors, the fault that their whiskers then have, and within how many ms that is
/// found.
type Loss = (Trouble, u8, u32);

/// A frozen sensor is found within a quarter of a second, unless the scene has another time.
const LOSSES: [Loss; 6] = [
    (Trouble::Mlx(Some(Silent), Faults::NONE), 18, 100),
    (Trouble::Mlx(Some(LineLow), Faults::NONE), 19, 100),
    (Trouble::Mlx(Some(BadSum), Faults::NONE), 21, 100),
    (Trouble::Mlx(None, Faults::FIELD_TOO_LOW), 22, 100),
    (Trouble::Mlx(Some(LowAfterStart), Faults::NONE), 23, 100),
    (Trouble::Mlx(Some(Frozen), Faults::NONE), 24, 300),
];

/// The same of a TMAG5170: bit 12 of a reply is of its field.
const TMAG_LOSSES: [Loss; 7] = [
    (Trouble::Tmag(Some(LineFault::Silent), WELL), 27, 100),
    (Trouble::Tmag(Some(LineFault::SdoLow), WELL), 28, 100),
    (Trouble::Tmag(Some(LineFault::SdiLow), WELL), 29, 100),
    (Trouble::Tmag(Some(LineFault::FlipReply(12)), WELL), 29, 100),
    (Trouble::Tmag(None, StatusFaults::SUPPLY_LOW), 30, 100),
    (Trouble::Tmag(Some(LineFault::NoField), WELL), 31, 100),
    (Trouble::Tmag(Some(LineFault::Frozen), WELL), 24, 300),
];
const WELL: StatusFaults = StatusFaults::NONE;

/// The sensors of either side and of both fail on their wires: those sides' motors must be off, or
/// all where the scene says so, nothing be felt and decided there, the log say whose sensor fails
/// and why, and all be well again once the sensor is back.
pub(super) fn sensor_loss(scene: &Scene) -> Vec<Case> {
    let losses: &'static [Loss] = match scene.sensor.model {
        SensorModel::Mlx90333 => &LOSSES,
        SensorModel::Tmag5170 => &TMAG_LOSSES,
    };
    let motor = scene.motor.as_ref();
    let stops_all = motor.is_some_and(|motor| motor.on_fault == OnFault::StopAll);
    let steps = move |on: &mut Runner| {
        let sides: Vec<usize> = (0..on.session.sides).collect();
        let both = Some(&*sides).filter(|sides| sides.len() > 1);
        on.pass(100)?;
        for lost in sides.chunks(1).chain(both) {
            let off = if stops_all { &sides[..] } else { lost };
            for loss in losses {
                lose(on, lost, off, *loss)?;
            }
        }
        Ok(())
    };
    vec![Case {
        what: "sensors that are lost".to_owned(),
        may_reset: false,
        steps: Box::new(steps),
    }]
}

/// These sides' sensors are lost, by which motors are off, and come back.
fn lose(on: &mut Runner, lost: &[usize], off: &[usize], loss: Loss) -> Done {
    let (trouble, fault, found_ms) = loss;
    on.forget();
    on.sensors(lost, trouble)?;
    on.pass(found_ms)?;
    on.moves(100, off)?;
    on.has_no_contact(lost)?;
    for (side, name) in SIDE_NAMES.into_iter().enumerate() {
        if lost.contains(&side) {
            on.says(&format!("fault {name} {fault} "))?;
        } else {
            on.says_times(0, &format!("fault {name} "))?;
        }
    }
    if let Trouble::Mlx(_, Faults::FIELD_TOO_LOW) = trouble {
        on.says("field too low")?;
    }
    on.sensors(lost, trouble.over())?;
    on.pass(100)?;
    on.whisk(100)?;
    let mut lost = lost.iter();
    lost.try_for_each(|side| on.says(&format!("back {}", SIDE_NAMES[*side])))
}

/// A bit flips in the settings in RAM, in the model in flash, in what the classifier holds of it in
/// RAM, or in what a motor is driven by, each on a new board: the motors must be off once idle has
/// looked at all of it, and the log must say fault 55 or 56.
pub(super) fn damage(scene: &Scene, program: &Program) -> Result<Vec<Case>, Error> {
    /// The settings, and how fast the module ticks by them; and in the module what the classifier
    /// holds that no sample changes.
    const SETTINGS: [&[&str]; 2] = [&["SETTINGS", "val"], &["PACE"]];
    const CONSTANTS: [&[&str]; 2] = [
        &[
            "INNER",
            "perception",
            "classifier",
            "found",
            "classifier",
            "constants",
        ],
        &["INNER", "perception", "classifier", "found", "factors"],
    ];
    /// Bytes of the largest model that is damaged here, and where in it: in the row of a table.
    const MODEL_BYTES: u32 = 12 * 1024;
    const ROW: u32 = 1_024;

    let info = DebugInfo::new(program)?;
    let mut flips = Vec::new();
    for path in SETTINGS {
        flips.extend(evenly(&info, path)?.map(|flip| (55, flip)));
    }
    let classifier = scene.classifier.as_ref();
    if classifier.is_some_and(|classifier| classifier.model.is_some()) {
        for path in CONSTANTS {
            flips.extend(evenly(&info, path)?.map(|flip| (56, flip)));
        }
        let [slot, _] = program.model()?.facts.flash.slots;
        flips.push((56, (slot.model.start + ROW, 0, MODEL_BYTES)));
    }
    if let Some(driver) = scene.motor.as_ref().map(|motor| motor.driver) {
        let whisker = info.variable("INNER")?.member("whiskers")?.element(0)?;
        let motor = whisker.member("servo")?.member("motor")?;
        if driver == Driver::HBridge {
            let (kind, _, brushed) = motor.variant("Brushed")?;
            // Any other tag is that of a brushless one.
            flips.push((55, (kind, 6, 4)));
            let pwm = brushed.member("pwm")?;
            flips.push((55, (pwm.address, 4, pwm.size()?)));
        } else {
            let pwms = motor.held("Brushless")?.member("pwms")?;
            for phase in 0..3 {
                flips.push((55, (pwms.element(phase)?.address, 4, pwms.size()?)));
            }
        }
    }
    let has_motor = scene.motor.is_some();
    let cases = flips.into_iter().map(|(fault, (address, bit, bytes))| {
        let steps = move |on: &mut Runner| {
            on.pass(100)?;
            if has_motor {
                on.until_driven(false)?;
            }
            on.session.machine().memories.flip(address, 1 << bit)?;
            on.stand(Ps::from(looked_at_within(bytes)) * on.session.period())?;
            on.says(&format!("fault board {fault} "))
        };
        Case {
            what: format!("bit {bit} at {address:#010x}"),
            may_reset: false,
            steps: Box::new(steps),
        }
    });
    Ok(cases.collect())
}

/// Ticks after which every word of so many bytes was looked at: that of a walk which had just
/// passed the word, and a whole one; and two in which idle is late.
const fn looked_at_within(bytes: u32) -> u32 {
    /// Words of each that idle looks at in a tick.
    const LOOKED_AT: u32 = 16;
    2 * (bytes / 4).div_ceil(LOOKED_AT) + 2
}

/// Bits of four words of what these names lead to, evenly spread: address, bit, and the bytes of
/// all of it.
fn evenly(info: &DebugInfo, path: &[&str]) -> Result<impl Iterator<Item = (u32, u32, u32)>, Fault> {
    const WORDS: u32 = 4;
    let [variable, members @ ..] = path else {
        return Err(Fault::Program("no variable".to_owned()));
    };
    let found = along(info.variable(variable)?, members)?;
    let (first, bytes) = (found.address, found.size()?);
    let last = bytes / 4 - 1;
    let mut words: Vec<u32> = (0..WORDS).map(|n| last * n / (WORDS - 1)).collect();
    words.dedup();
    let words = words.into_iter();
    Ok(words.map(move |word| (first + 4 * word, word % 8, bytes)))
}
