//! What is chosen where textures are told apart, and the experiments without it: a list of changes
//! of the rigs, each tried by the papers' protocol, cut short, on a few seeds of its own.

use super::asked::Part;
use super::request::{Arm, Name};
use super::verdicts::{Bodies, digits, margins};
use crate::moments::{SURE, Summary};
use crate::page::{Claim, Page};

/// A change: its name, and the keys of rigs that it sets.
type Change = (&'static str, &'static [&'static str]);

const NONE: Change = ("as it is", &[]);

/// LEP10 and LEP12.
const FLOOR: &[Change] = &[
    NONE,
    ("set down again in a trial", &["floor.placements=2"]),
    ("no change of the press", &["floor.press_sd_m=0"]),
    ("no rise and fall", &["floor.wobble_share=0"]),
    ("sensor rolled by 20°", &["floor.roll_deg=20"]),
    ("half of the gain", &["floor.full_scale_rad=[0.13, 0.07]"]),
    ("twice the gain", &["floor.full_scale_rad=[0.0325, 0.0175]"]),
    ("follicle half as stiff", &["floor.follicle=0.5"]),
    ("follicle twice as stiff", &["floor.follicle=2"]),
    (
        "four times as fast",
        &["floor.turn_rad_s=1", "floor.forward_m_s=0.32"],
    ),
    (
        "dead zones and missed pulses",
        &["floor.dead_hz=0.2", "floor.missed_hz=2"],
    ),
];

const HEAD: &[Change] = &[
    NONE,
    ("another spot each whisk", &["head.spot_spread_m=0.005"]),
    ("arm off by 0.1 mm", &["head.placement_sd_m=0.0001"]),
    ("surface pitched by 20°", &["head.pitch_deg=20"]),
    ("sensors rolled by 20°", &["head.roll_deg=20"]),
    ("half of the gain", &["head.full_scale_rad=0.008"]),
    ("twice the gain", &["head.full_scale_rad=0.002"]),
    ("follicles half as stiff", &["head.follicle=0.5"]),
    ("follicles twice as stiff", &["head.follicle=2"]),
    ("motors without error", &["head.motor.follows=false"]),
];

const TABLE: &[Change] = &[
    NONE,
    ("table off by 0.1 mm", &["table.gap_sd_m=0.0001"]),
    ("surface rolled by 20°", &["table.roll_deg=20"]),
    ("half of the gain", &["table.full_scale_rad=0.1"]),
    ("twice the gain", &["table.full_scale_rad=0.025"]),
    ("follicle half as stiff", &["table.follicle=0.5"]),
    ("follicle twice as stiff", &["table.follicle=2"]),
    ("latency always the same", &["table.latency_spread_s=0"]),
    ("templates low-passed at 100 Hz", &["table.low_pass_hz=100"]),
    (
        "templates without less than 6 Hz",
        &["table.high_pass_hz=6"],
    ),
    ("features without a notch", &["table.notch_quality=0"]),
];

/// PSIK: the fixed head, and what the robot of the corridors has too. No roll of sensors: IMP takes
/// r = √(x² + y²), which stays.
const PAD: &[Change] = &[
    NONE,
    ("sheet moved by ± 0.5 m", &["pad.position_spread_m=0.5"]),
    ("sheet off by 1 mm", &["pad.distance_spread_m=0.001"]),
    ("sheet pitched by 20°", &["pad.pitch_deg=20"]),
    (
        "half of the gain",
        &["pad.full_scale_rad=0.03", "corridor.full_scale_rad=0.017"],
    ),
    (
        "twice the gain",
        &[
            "pad.full_scale_rad=0.0075",
            "corridor.full_scale_rad=0.00425",
        ],
    ),
    (
        "follicles half as stiff",
        &["pad.follicle=0.5", "corridor.follicle=0.5"],
    ),
    (
        "follicles twice as stiff",
        &["pad.follicle=2", "corridor.follicle=2"],
    ),
];

pub(super) fn of(part: &Part) -> &'static [Change] {
    match part.names.first() {
        Some(Name::Lep10 | Name::Lep12) => FLOOR,
        Some(Name::Biotact) => HEAD,
        Some(Name::Pose) => TABLE,
        Some(Name::Psikharpax) => PAD,
        None => &[],
    }
}

/// Whether a margin is beyond its noise, and which way.
fn side(margin: &Summary) -> i8 {
    let half = margin.half_interval(&SURE);
    i8::from(margin.mean > half) - i8::from(margin.mean < -half)
}

/// The margins of a part's claims, of `bodies` by changes.
pub(super) fn section(page: &mut Page, changes: &[Change], bodies: &[Bodies]) {
    let all: Vec<&[Page]> = bodies.iter().map(|bodies| bodies.of(Arm::MAIN)).collect();
    let claims = all.first().and_then(|pages| pages.first());
    let claims = claims.map_or(&[][..], |page| &page.claims);
    let is_of_textures = |claim: &&Claim| claim.recognition.is_some();
    let row = |claim: &Claim| {
        let found: Vec<Summary> = all
            .iter()
            .map(|pages| margins(pages, &claim.what))
            .collect();
        let usual = found.first().map_or(0, side);
        let cell = |margin: &Summary| {
            let text = margin.text(digits(claim.unit), true);
            if side(margin) == usual {
                text
            } else {
                format!("**{text}**")
            }
        };
        std::iter::once(format!("{}, {}", claim.what, claim.unit))
            .chain(found.iter().map(cell))
            .collect()
    };
    let names: Vec<&str> = changes.iter().map(|(name, _)| *name).collect();
    let header = format!("claim, margin in | {}", names.join(" | "));
    page.table(&header, claims.iter().filter(is_of_textures).map(row));
}
