//! `[motor]`: motor, gear, encoder and position control.

use whisking::motor::Driver;
use whisking::ranges;

use crate::choice::choice;
use crate::key::Condition::{self, Is};
use crate::key::{integer, number, positive, word};
use crate::keys::keys;

choice! { for Driver { HBridge = "h-bridge", SixStep = "six-step" } }

choice! {
    /// What a fault switches off.
    pub enum OnFault {
        /// The motor of its whisker.
        StopWhisker = "stop-whisker",
        /// Every motor, until no whisker has a fault.
        StopAll = "stop-all",
    }
}

choice! {
    /// When motors are armed.
    pub enum Arm {
        /// When the program starts as the supply has come, once for each deployment.
        AtStart = "at-start",
        /// By command only.
        OnCommand = "on-command",
    }
}

choice! {
    /// How it is known where a whisker is.
    pub enum Rest {
        /// It is at rest when it is first armed.
        AtStart = "at-start",
        /// Its retracted stop is found.
        Find = "find",
    }
}

const FIND: &[Condition] = &[Is("rest", Rest::Find.name())];

keys! {
    /// Motor, gear, encoder and the proportional-derivative position control.
    pub struct MotorSection {
        /// Power stage: one H-bridge (brushed motor) or six-step commutation (brushless motor).
        driver: Driver = word().default("\"h-bridge\""),

        /// Proportional gain of the position control. A board refuses gains under which the motor
        /// would not settle.
        kp: f64 = number(0.0..=10.0).unit("duty per degree").default("0.05"),

        /// Derivative gain of the position control.
        kd: f64 = number(0.0..=1.0).unit("duty per degree/s").default("0.0004"),

        /// Largest magnitude of the duty.
        duty_limit: f64 = number(ranges::pd::LIMIT).default("1.0"),

        /// Fastest change of the duty. A board may refuse it as it does `kp`.
        slew_per_s: f64 = positive(1e5).unit("duty per second").default("400.0"),

        /// Lower limit of the setpoint; below `max_deg`. On a board at least -90.
        min_deg: f64 = number(-360.0..=360.0).unit("degrees").default("30.0"),

        /// Upper limit of the setpoint; above `min_deg`. On a board at most 270.
        max_deg: f64 = number(-360.0..=360.0).unit("degrees").default("160.0"),

        /// Gear ratio.
        gear: f64 = number(1.0..=1000.0)
            .unit("motor revolutions per whisker revolution")
            .default("11.0"),

        /// Encoder counts per motor revolution.
        counts_per_rev: u32 = integer(4..=65_536).unit("counts").default("512"),

        /// Largest following error (setpoint against measured) that lasts for 40 ms without a fault.
        /// On a board at most 90.
        following_limit_deg: f64 = number(1.0..=720.0).unit("degrees").default("40.0"),

        /// How far beyond `min_deg`, or rest where that is lower, and `max_deg` the whisker may be
        /// turned without a fault. On a board at most 45.
        travel_margin_deg: f64 = number(0.0..=720.0).unit("degrees").default("20.0"),

        /// Faster than the motor can turn the whisker: a fault. A quarter more than its speed
        /// without load at full duty, which follows from it. On a board 2,500 to 60,000.
        top_speed_deg_s: f64 = positive(1e6).unit("degrees/s").default("15000.0"),

        /// Duty that friction of motor and gear takes, both ways together. Where a duty beyond half
        /// of it does not move the whisker as the motor should, a short stroke tests it, and is a
        /// fault if it fails; friction up to four times as large is none. From 1.6 on nothing is
        /// expected of the motor, but that it moves by more than half of `duty_limit`. On a board at
        /// most 0.5, if `duty_limit` is above 0.25.
        unmoved_duty: f64 = number(0.0..=2.0).default("0.12"),

        /// Time in which the motor comes to 63 % of its speed, with gear and whisker (`whisker
        /// calibrate` measures it). On a board at most `top_speed_deg_s`/50,000.
        time_constant_s: f64 = number(1e-3..=10.0).unit("s").default("0.048"),

        /// Duty that the winding tolerates for ever; above it, a fault by I²t over some 8 s. On a board
        /// at most 0.7.
        continuous_duty: f64 = number(ranges::pd::LIMIT).default("0.4"),

        /// What a fault of a sensor or a motor switches off: the motor of its whisker, or every
        /// motor until no whisker has a fault.
        on_fault: OnFault = word().default("\"stop-whisker\""),

        /// When the motors are armed: as the supply first comes after the scene was deployed, or by
        /// a command or the user button ([arming](build.md#arming)).
        arm: Option<Arm> = word()
            .optional("`\"at-start\"` in a simulated world (`[plant]`, `--world`), else `\"on-command\"`"),

        /// Where a whisker is: at rest, 50 degrees, when its motor is first armed; or found by
        /// driving it gently against its retracted stop, before it whisks and after every fault of
        /// the motor. The first time it then goes through its whole range, with nothing in reach.
        /// Plant `ideal` has no stop to find.
        rest: Rest = word().default("\"at-start\""),

        /// Duty with which the stop is looked for, more than friction takes, at most half of
        /// `duty_limit`.
        homing_duty: f64 = number(ranges::pd::LIMIT).default("0.1"),

        /// Angle of the retracted stop.
        stop_deg: Option<f64> = number(-360.0..=whisking::REST_DEG).unit("degrees")
            .optional("`min_deg`, at most 50")
            .used_if(FIND),

        /// Angle of the other stop. Home is right if that stop is found within 3 degrees of it;
        /// where it is not known, if the whisker reaches `max_deg` and meets nothing.
        far_stop_deg: Option<f64> = number(whisking::REST_DEG..=360.0).unit("degrees")
            .optional("not known")
            .used_if(FIND),

        /// How often the stop is looked for again, while the whisker touches nothing: elsewhere by
        /// more than a degree is a fault.
        home_every_s: f64 = number(1.0..=86_400.0).unit("s").default("20.0").used_if(FIND),

        /// Soft start: how fast the setpoint comes from where the whisker is to where it should be,
        /// whenever the motor has been off.
        approach_deg_s: f64 = positive(1e5).unit("degrees/s").default("400.0"),
    }
}

impl MotorSection {
    /// Whether motors are armed when the program starts.
    pub fn arms_at_start(&self) -> bool {
        self.arm == Some(Arm::AtStart)
    }

    /// Angle of the retracted stop, degrees: `stop_deg`, or as far as the whisker retracts.
    pub fn retracted_deg(&self) -> f64 {
        let lowest = self.min_deg.min(whisking::REST_DEG);
        self.stop_deg.unwrap_or(lowest)
    }
}
