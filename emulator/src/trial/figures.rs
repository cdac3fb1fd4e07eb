//! What a run is judged by.

mod stops;

use std::collections::BTreeMap;

use host_sim::Error;
use scene::Scene;
use serde::Serialize;

use super::links::Arrived;
use super::said::{Listed, Lister};
use crate::notice::Notice;
use crate::session::Session;
use crate::watch::Servos;
use stops::Stops;

/// So near to an end stop a whisker is at it, degrees.
const AT_STOP_DEG: f64 = 0.1;
/// So far from its setpoint it is in an excursion, degrees.
const EXCURSION_DEG: f64 = 5.0;
/// So many ticks after a fault was reported its motor is off.
const GRACE: u64 = 2;

/// What became of a run; docs/boards.md has each key.
#[derive(Debug, Serialize)]
pub(super) struct Outcome {
    first_fault: Option<String>,
    first_fault_s: Option<f64>,
    worst_outside_deg: f64,
    driven_after_stop_s: f64,
    driven_with_fault_s: f64,
    at_stop_s: f64,
    rms_duty: f64,
    resets: u64,
    max_following_deg: f64,
    off_after_5deg_s: f64,
    stops: u64,
    stops_late: u64,
    stop_to_off_ticks: u64,
    driven_s: f64,
    armed_at_end: Option<bool>,
    angle_at_end_deg: Vec<f64>,
    ran_s: f64,
    answers: BTreeMap<String, u64>,
    unlisted: u64,
    events: Vec<Listed>,
}

#[derive(Debug, Clone, Copy)]
struct Span {
    least: f64,
    most: f64,
}

impl Default for Span {
    fn default() -> Self {
        let (least, most) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { least, most }
    }
}

impl Span {
    fn take(&mut self, value: f64) {
        self.least = self.least.min(value);
        self.most = self.most.max(value);
    }

    /// By how much `other` reaches beyond it; 0 of what is empty.
    fn exceeded_by(self, other: Self) -> f64 {
        let beyond = (other.most - self.most).max(self.least - other.least);
        if beyond.is_finite() {
            beyond.max(0.0)
        } else {
            0.0
        }
    }
}

#[derive(Debug, Clone, Default)]
struct OfSide {
    /// Of its setpoints, and of its true angle.
    whisk: Span,
    reached: Span,
    /// Since when its sensor and its motor have a fault that was reported, in ticks.
    faults: [Option<u64>; 2],
    /// For how many ticks it has been driven in this excursion.
    excursion: u64,
    was_homing: bool,
}

#[derive(Default)]
pub(super) struct Figures {
    tick_hz: f64,
    /// Setpoints are within these, degrees.
    limits_deg: [f64; 2],
    ticks: u64,
    sides: Vec<OfSide>,
    stops: Stops,
    with_fault: u64,
    at_stop: u64,
    driven: u64,
    squares: f64,
    duties: u64,
    resets: u64,
    max_following_deg: f64,
    longest_excursion: u64,
    is_armed: Option<bool>,
    angles_deg: Vec<f64>,
}

impl Figures {
    pub(super) fn new(scene: &Scene) -> Self {
        let motor = scene.motor.as_ref();
        Self {
            tick_hz: f64::from(scene.tick_hz),
            limits_deg: motor.map_or([f64::NEG_INFINITY, f64::INFINITY], |motor| {
                [motor.min_deg, motor.max_deg]
            }),
            sides: vec![OfSide::default(); scene.head.sides.count()],
            ..Self::default()
        }
    }

    pub(super) fn look(
        &mut self,
        session: &mut Session,
        servos: &Servos,
        was_reset: bool,
        arrived: Arrived,
    ) -> Result<(), Error> {
        self.ticks += 1;
        self.resets += u64::from(was_reset);
        self.note_faults(session, was_reset, arrived);
        let efforts = session.efforts();
        let is_driven = efforts.iter().any(|effort| *effort > 0.0);
        self.driven += u64::from(is_driven);
        // While the chip starts its RAM says nothing of motors.
        let is_up = !session.board_mut().is_late;
        if is_up {
            self.is_armed = servos.are_armed(&session.machine().memories)?;
        }
        // A duty that passes zero is not off.
        let may_drive = is_driven || self.is_armed == Some(true);
        self.stops.look(is_driven, may_drive, arrived);
        let row = *session.run.row();
        self.angles_deg.clear();
        let mut is_at_stop = false;
        for (side, effort) in efforts.into_iter().enumerate() {
            let Some(motor) = session.run.motor_mut(side) else {
                continue;
            };
            let (angle, duty) = (motor.angle_deg(), motor.duty());
            let stops = motor.settings().stops_deg;
            is_at_stop |= stops.iter().any(|stop| (angle - stop).abs() <= AT_STOP_DEG);
            self.angles_deg.push(angle);
            self.squares += duty * duty;
            self.duties += 1;
            if is_up {
                let wants = servos.wants(side, &session.machine().memories)?;
                let whole = wants.commanded_deg.unwrap_or(row.theta_deg[side]);
                let [least, most] = self.limits_deg;
                let whole = whole.max(least).min(most);
                let following = angle - (whole - wants.behind_deg);
                let was_homing = &mut self.sides[side].was_homing;
                let was_homing = std::mem::replace(was_homing, wants.is_homing);
                // The tick that ends it was still driven by it.
                let homes = wants.is_homing || was_homing;
                self.follow(side, whole, effort > 0.0 && !homes, following);
                if homes {
                    continue;
                }
            }
            self.sides[side].reached.take(angle);
        }
        self.at_stop += u64::from(is_at_stop);
        self.count_with_fault(session);
        Ok(())
    }

    /// A side's setpoint, and by how much the whisker is off the one that it follows.
    fn follow(&mut self, side: usize, setpoint_deg: f64, is_driven: bool, off_deg: f64) {
        let side = &mut self.sides[side];
        side.whisk.take(setpoint_deg);
        if !is_driven {
            side.excursion = 0;
            return;
        }
        self.max_following_deg = self.max_following_deg.max(off_deg.abs());
        if off_deg.abs() > EXCURSION_DEG {
            side.excursion += 1;
            self.longest_excursion = self.longest_excursion.max(side.excursion);
        } else {
            side.excursion = 0;
        }
    }

    fn note_faults(&mut self, session: &mut Session, was_reset: bool, arrived: Arrived) {
        for side in &mut self.sides {
            if was_reset {
                side.faults = [None; 2];
            }
            if arrived.is_arm || arrived.is_clear {
                side.faults[1] = None;
            }
        }
        let now = self.ticks;
        for (place, notice) in std::mem::take(&mut session.board_mut().notices) {
            let Some(side) = self.sides.get_mut(usize::from(place.side)) else {
                continue;
            };
            let [sensor, motor] = &mut side.faults;
            match notice {
                Notice::SensorLost => *sensor = Some(now),
                Notice::SensorBack => *sensor = None,
                Notice::MotorFault => *motor = Some(now),
                Notice::MotorRetry => *motor = None,
                Notice::MotorGivenUp => _ = motor.get_or_insert(now),
            }
        }
    }

    fn count_with_fault(&mut self, session: &mut Session) {
        for (side, effort) in self.sides.iter().zip(session.efforts()) {
            let mut faults = side.faults.iter().flatten();
            let is_due = faults.any(|since| self.ticks >= since + GRACE);
            self.with_fault += u64::from(is_due && effort > 0.0);
        }
    }

    pub(super) fn outcome(mut self, lister: Lister) -> Outcome {
        let seconds = |ticks: u64| ticks as f64 / self.tick_hz;
        self.stops.end();
        let first = lister.listed.iter().find(|listed| listed.kind == "fault");
        let named = |listed: &Listed| {
            let number = listed.number.unwrap_or_default();
            format!("{number} {}", listed.name.as_deref().unwrap_or_default())
        };
        let outside = self.sides.iter();
        let outside = outside.map(|side| side.whisk.exceeded_by(side.reached));
        Outcome {
            first_fault: first.map(named),
            first_fault_s: first.map(|listed| listed.t_s),
            worst_outside_deg: outside.fold(0.0, f64::max),
            driven_after_stop_s: seconds(self.stops.driven),
            driven_with_fault_s: seconds(self.with_fault),
            at_stop_s: seconds(self.at_stop),
            rms_duty: (self.squares / self.duties.max(1) as f64).sqrt(),
            resets: self.resets,
            max_following_deg: self.max_following_deg,
            off_after_5deg_s: seconds(self.longest_excursion),
            stops: self.stops.arrived,
            stops_late: self.stops.late,
            stop_to_off_ticks: self.stops.longest,
            driven_s: seconds(self.driven),
            armed_at_end: self.is_armed,
            angle_at_end_deg: self.angles_deg,
            ran_s: seconds(self.ticks),
            answers: lister.answers,
            unlisted: lister.unlisted,
            events: lister.listed,
        }
    }
}
