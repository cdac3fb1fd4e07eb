//! The columns of a trace.

use scene::{PlantKind, Scene};

use crate::bench;
use crate::columns::{Column, columns};

/// Those of every trace, in order. The first nine are fixed: other programs read them.
pub const FIRST: [Column; 17] = columns! {
    "t_s", "s", "end of the tick; the first row is at 1/`tick_hz`";
    "theta_left_deg", "degrees",
        "setpoint θ′ of the side's first whisker, before `min_deg` and `max_deg` limit it; 50 is \
        rest, more is protraction";
    "theta_right_deg", "degrees", "the same of the right side";
    "z_left", "", "suppression of protraction by contact (RCP), 0 without `[rcp]`";
    "z_right", "", "the same of the right side";
    "g_left", "",
        "gain of the muscle of the side's first whisker, with the excitation by contact on \
        either side (CIA)";
    "g_right", "", "the same of the right side";
    "contact_left", "",
        "contact π of the side as the module computes it: the largest of its whiskers'";
    "contact_right", "", "the same of the right side";
    "angle_left_deg", "degrees",
        "angle of the side's first whisker as it is, not as the encoder counts it";
    "angle_right_deg", "degrees", "the same of the right side";
    "x_left", "codes",
        "what the sensor of the side's first whisker is given to send: 14 bits, about 8192 at \
        rest; along the direction of whisking";
    "x_right", "codes", "the same of the right side";
    "y_left", "codes", "the same across the direction of whisking";
    "y_right", "codes", "the same of the right side";
    "touch", "",
        "number of the touch of the left side's first whisker, from 1; 0 in the air, and where a \
        classifier decides by windows";
    "decision", "",
        "class that a whisker of the left side decided for in this tick, or `unknown`; empty \
        where no decision fell";
};

/// Those that follow where whiskers of the right side are heard.
pub const OF_RIGHT: [Column; 2] = columns! {
    "touch_right", "", "`touch` of the right side; only where whiskers of the right side decide";
    "decision_right", "", "`decision` of the right side; likewise";
};

/// Those that then follow in every trace.
pub const SECOND: [Column; 8] = columns! {
    "label", "",
        "the truth, which no module knows: the texture that is in place; `obstacle` or `free` \
        where there are none";
    "trial", "", "how often that texture has been in place before";
    "speed_left_deg_s", "degrees/s", "speed of the side's first whisker as it is";
    "speed_right_deg_s", "degrees/s", "the same of the right side";
    "duty_left", "",
        "duty at the motor driver's pins of the side's first whisker, −1 to 1, positive towards \
        protraction; empty where the motor is ideal or none";
    "duty_right", "", "the same of the right side";
    "fault_left", "",
        "number of the fault that holds the side's first whisker ([faults.md](faults.md)), its \
        sensor's before its motor's; 0: none; empty on the emulated board, whose log has it";
    "fault_right", "", "the same of the right side";
};

/// Those at the end of every row of elastic whiskers, left side first; only sides that exist.
pub const OF_ELASTIC: [Column; 4] = columns! {
    "touch_at_left_m", "m",
        "where along its shaft the side's first whisker touches: arc length from the base; empty \
        in the air";
    "place_left_m", "m",
        "where on the surface: from the point that a straight tip touches first, along the \
        direction of that shaft laid on the plate, positive away from the base; empty in the air";
    "touch_at_right_m", "m", "`touch_at_left_m` of the right side";
    "place_right_m", "m", "`place_left_m` of the right side";
};

/// Those of each further whisker of a side, whose place is put in place of the `*`.
pub const OF_WHISKER: [Column; 8] = columns! {
    "theta_*_deg", "degrees", "setpoint θ′";
    "angle_*_deg", "degrees", "angle as it is";
    "speed_*_deg_s", "degrees/s", "speed as it is";
    "duty_*", "", "duty at the motor driver's pins";
    "x_*", "codes", "what its sensor is given to send, along the direction of whisking";
    "y_*", "codes", "the same across it";
    "contact_*", "", "contact π of this whisker alone";
    "fault_*", "", "number of the fault that holds it; 0: none";
};

/// What decides which columns a trace has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TraceShape {
    /// Sides of the head, 1 or 2.
    pub sides: usize,
    /// Whiskers on each.
    pub whiskers_per_side: usize,
    /// Whether whiskers of the right side are heard.
    pub hears_right: bool,
    /// Whether whiskers bend, and touch somewhere along their shafts.
    pub is_elastic: bool,
}

impl TraceShape {
    /// That of a scene.
    pub fn of(scene: &Scene) -> Self {
        let whiskers_per_side = scene.head.whiskers_per_side;
        Self {
            sides: scene.head.sides.count(),
            whiskers_per_side,
            hears_right: bench::heard(scene) > whiskers_per_side,
            is_elastic: scene.plant.kind == PlantKind::Whisker,
        }
    }

    /// How many sides have whiskers that bend.
    pub(super) fn elastic_sides(self) -> usize {
        if self.is_elastic { self.sides } else { 0 }
    }

    /// The names of the columns, in order.
    pub fn names(self) -> Vec<String> {
        let right: &[Column] = if self.hears_right { &OF_RIGHT } else { &[] };
        let common = FIRST.iter().chain(right).chain(&SECOND);
        let mut names: Vec<String> = common.map(|column| column.name.to_owned()).collect();
        for side in ["left", "right"].into_iter().take(self.sides) {
            for n in 2..=self.whiskers_per_side {
                let place = format!("{side}_{n}");
                names.extend(OF_WHISKER.map(|column| column.name.replace('*', &place)));
            }
        }
        let elastic = OF_ELASTIC.iter().take(2 * self.elastic_sides());
        names.extend(elastic.map(|column| column.name.to_owned()));
        names
    }
}
