//! What must hold in every tick of every run.

use firmware::design_parameters::{HOLD_S, RETRY_S};
use scene::Scene;
use wire::Command;

use super::injection::Injection;
use super::subject::Seen;
use crate::notice::Notice;

/// Within how many ticks of a fault's report its motor is off.
const OFF_TICKS: u32 = 2;
/// For how long a whisker may be further from its setpoint than the scene allows, and be driven, s.
const AWAY_S: f64 = 0.05;
/// For how long it may be driven into an end stop, s.
const AT_STOP_S: f64 = 0.1;
/// Within how many ticks of a stop its motors are off. A line takes some to arrive, behind others;
/// how late the tick is after its last byte is measured by `emulate --stopping`.
const STOP_TICKS: u32 = 8;
/// For how long the core may come to the end of no tick, s.
const HUNG_S: f64 = 0.75;
/// Steps of a PWM by which a duty may be rounded.
const ROUNDING: f64 = 1e-3;

#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(super) enum Harm {
    #[error("driven with more than the duty limit")]
    Effort,
    #[error("driven after a fault was reported")]
    Driven,
    #[error("driven far from its setpoint")]
    Away,
    #[error("decided by what is known to be bad")]
    Decided,
    #[error("driven into its end stop")]
    AtStop,
    #[error("driven after a stop")]
    Stopped,
    #[error("driven after a reset that must not arm it")]
    Armed,
    #[error("did not recover")]
    Unrecovered,
    #[error("panicked")]
    Panicked,
    #[error("locked up")]
    LockedUp,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Motor {
    #[default]
    Runs,
    Rests,
    GivenUp,
}

#[derive(Debug, Clone, Copy, Default)]
struct Whisker {
    sensor_is_lost: bool,
    motor: Motor,
    /// Ticks since a fault was reported.
    off_for: u32,
    /// Ticks for which it has been driven too far from its setpoint.
    away_for: u32,
    at_stop_for: u32,
    was_homing: bool,
    /// By how much it is displaced from what its encoder has counted since the cable came
    /// loose last, degrees: nothing but an index could tell.
    displaced_deg: f64,
    last_displaced_deg: f64,
    /// The same when it was homed last, which knows it.
    homed_deg: f64,
    /// Ticks left in which the setpoint that is followed approaches that of the pattern generator.
    approaches: u32,
}

impl Whisker {
    /// By how much it is displaced from where the module can know it to be, degrees.
    const fn displaced(&self) -> f64 {
        self.displaced_deg - self.homed_deg
    }

    fn must_rest(&self) -> bool {
        self.sensor_is_lost || self.motor != Motor::Runs
    }
}

const fn count(ticks: &mut u32, is_so: bool) {
    *ticks = if is_so { *ticks + 1 } else { 0 };
}

#[derive(Debug)]
pub(super) struct Judge {
    whiskers: Vec<Whisker>,
    has_motors: bool,
    per_side: usize,
    tick_hz: f64,
    limit: f64,
    following_deg: f64,
    /// Ticks in which a setpoint approaches through the whole travel.
    approach: u32,
    reset: bool,
    /// Ticks since a stop that no arming has followed.
    stopped_for: Option<u32>,
    /// Ticks for which the core has not come to the end of one.
    late_for: u32,
}

impl Judge {
    /// Of a scene; `moves` says whether its motors can be seen to move.
    pub(super) fn new(scene: &Scene, moves: bool) -> Self {
        let motor = scene.motor.as_ref();
        Self {
            whiskers: vec![Whisker::default(); scene.whiskers()],
            has_motors: moves,
            per_side: scene.head.whiskers_per_side,
            tick_hz: f64::from(scene.tick_hz),
            limit: motor.map_or(0.0, |motor| motor.duty_limit) + ROUNDING,
            following_deg: motor.map_or(f64::MAX, |motor| motor.following_limit_deg),
            approach: motor.map_or(0, |motor| {
                let travel_deg = motor.max_deg - motor.min_deg + 2.0 * motor.travel_margin_deg;
                (travel_deg / motor.approach_deg_s * f64::from(scene.tick_hz)).ceil() as u32
            }),
            reset: false,
            stopped_for: None,
            late_for: 0,
        }
    }

    /// One tick; what must not be, if it is. `is_noticed`: a fault was.
    pub(super) fn look(
        &mut self,
        tick: u64,
        seen: &Seen,
        is_noticed: bool,
        injections: &[Injection],
    ) -> Option<Harm> {
        if seen.reset.is_some() {
            self.reset = true;
            self.whiskers.fill(Whisker::default());
        }
        // A core that has noticed a fault, and is reset again and again or waits for a probe
        // with its motors off, is not hung.
        let waits = is_noticed && seen.motors.iter().all(|motor| motor.effort == 0.0);
        let is_late = seen.is_late && seen.reset.is_none() && !waits;
        count(&mut self.late_for, is_late);
        if f64::from(self.late_for) > HUNG_S * self.tick_hz {
            return Some(Harm::LockedUp);
        }
        self.obey(&seen.commands);
        let mut stuck = injections.iter().filter(|one| one.cuts_encoder());
        let cut = stuck.any(|injection| injection.lasts(tick));
        for (whisker, motor) in self.whiskers.iter_mut().zip(&seen.motors) {
            let displaced = motor.displaced_deg;
            // While the count stands still, the whisker is away from where it was lost.
            if displaced == whisker.last_displaced_deg && !cut {
                whisker.displaced_deg = displaced;
            }
            whisker.last_displaced_deg = displaced;
        }
        // What decides with the first good frame decides by what is good.
        for &(n, notice) in &seen.notices {
            if notice == Notice::SensorBack {
                self.note(n, notice);
            }
        }
        // A frame is used a tick after it was sent, and the last good one is held.
        let held = (HOLD_S * self.tick_hz).ceil() as u64 + 1;
        let decided = seen.decisions.iter().any(|(n, _)| {
            let known = self.whiskers.get(*n).is_some_and(Whisker::must_rest);
            let spoilt = |injection: &Injection| {
                injection.kind.spoils_every_frame()
                    && injection.whisker == *n
                    && injection.lasts(tick)
                    && tick > injection.start + held
            };
            known || injections.iter().any(spoilt)
        });
        if decided {
            return Some(Harm::Decided);
        }
        // A decision that falls in the tick of a motor's fault came of what was sound.
        for &(n, notice) in &seen.notices {
            self.note(n, notice);
        }
        for n in 0..self.whiskers.len() {
            if let Some(harm) = self.look_at(n, seen) {
                return Some(harm);
            }
        }
        None
    }

    fn obey(&mut self, commands: &[Command]) {
        self.stopped_for = self.stopped_for.map(|ticks| ticks + 1);
        for command in commands {
            match command {
                Command::Stop => _ = self.stopped_for.get_or_insert(0),
                Command::Arm => {
                    self.stopped_for = None;
                    self.reset = false;
                    self.approach();
                }
                Command::Clear(_) => {
                    for whisker in &mut self.whiskers {
                        whisker.motor = Motor::Runs;
                    }
                    self.approach();
                }
                _ => {}
            }
        }
    }

    fn approach(&mut self) {
        for whisker in &mut self.whiskers {
            whisker.approaches = self.approach;
        }
    }

    fn note(&mut self, n: usize, notice: Notice) {
        let approach = self.approach;
        let Some(whisker) = self.whiskers.get_mut(n) else {
            return;
        };
        match notice {
            Notice::SensorLost => whisker.sensor_is_lost = true,
            Notice::SensorBack => {
                whisker.sensor_is_lost = false;
                whisker.approaches = approach;
            }
            Notice::MotorFault => whisker.motor = Motor::Rests,
            Notice::MotorRetry => {
                whisker.motor = Motor::Runs;
                whisker.approaches = approach;
            }
            Notice::MotorGivenUp => whisker.motor = Motor::GivenUp,
        }
    }

    fn look_at(&mut self, n: usize, seen: &Seen) -> Option<Harm> {
        let away_ticks = (AWAY_S * self.tick_hz) as u32;
        let motor = *seen.motors.get(n)?;
        let (effort, is_homing) = (motor.effort, motor.is_homing);
        let whisker = self.whiskers.get_mut(n)?;
        if effort > self.limit {
            return Some(Harm::Effort);
        }
        if self.reset && effort > 0.0 {
            return Some(Harm::Armed);
        }
        if self.stopped_for.is_some_and(|ticks| ticks > STOP_TICKS) && effort > 0.0 {
            return Some(Harm::Stopped);
        }
        let must_rest = whisker.must_rest();
        count(&mut whisker.off_for, must_rest);
        if whisker.off_for > OFF_TICKS && effort > 0.0 {
            return Some(Harm::Driven);
        }
        if is_homing {
            whisker.homed_deg = whisker.last_displaced_deg;
            whisker.displaced_deg = whisker.last_displaced_deg;
        }
        if is_homing || std::mem::replace(&mut whisker.was_homing, is_homing) {
            whisker.at_stop_for = 0;
            whisker.away_for = 0;
            whisker.approaches = self.approach;
            return None;
        }
        count(&mut whisker.at_stop_for, motor.is_into_stop);
        if f64::from(whisker.at_stop_for) > AT_STOP_S * self.tick_hz {
            return Some(Harm::AtStop);
        }
        // The trace shows the first whisker of each side.
        if !self.has_motors || !n.is_multiple_of(self.per_side) {
            return None;
        }
        let side = n / self.per_side;
        let (angle, setpoint) = (seen.row.angle_deg[side], seen.row.theta_deg[side]);
        whisker.approaches = whisker.approaches.saturating_sub(1);
        let angle = angle - whisker.displaced();
        let away = (angle - setpoint).abs() > self.following_deg && whisker.approaches == 0;
        count(&mut whisker.away_for, away && effort > 0.0);
        if whisker.away_for > away_ticks {
            return Some(Harm::Away);
        }
        None
    }

    /// At the end of a run whose fault was taken away long enough ago: every motor must
    /// follow its setpoint again, unless it was given up or the chip was reset.
    pub(super) fn end(&self, seen: &Seen) -> Option<Harm> {
        if self.reset || self.stopped_for.is_some() {
            return None;
        }
        // A motor that did not move in one test after another rests for up to twice as long.
        let rest_ticks = (2.0 * RETRY_S * self.tick_hz) as u32 + OFF_TICKS;
        for (n, whisker) in self.whiskers.iter().enumerate() {
            // A motor that has had another fault rests again, or is given up.
            let rests = match whisker.motor {
                Motor::Runs => false,
                Motor::Rests => whisker.off_for <= rest_ticks,
                Motor::GivenUp => true,
            };
            if whisker.sensor_is_lost || (whisker.motor == Motor::Rests && !rests) {
                return Some(Harm::Unrecovered);
            }
            let is_homing = seen.motors.get(n).is_some_and(|motor| motor.is_homing);
            let is_under_way = is_homing || whisker.approaches > 0;
            if !self.has_motors || rests || is_under_way || !n.is_multiple_of(self.per_side) {
                continue;
            }
            let side = n / self.per_side;
            let (angle, setpoint) = (seen.row.angle_deg[side], seen.row.theta_deg[side]);
            if (angle - whisker.displaced() - setpoint).abs() > self.following_deg {
                return Some(Harm::Unrecovered);
            }
        }
        None
    }
}
