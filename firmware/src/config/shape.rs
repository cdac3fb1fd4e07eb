//! What may change while a module runs.

use tactile::RuleSettings;
use whisking::motor::Driver;
use whisking::{Real, muscle, oscillator};

use super::{Config, ConfigError, Field, MotionConfig, Part};
use crate::perception::ClassifierConfig;
use crate::sensing::SensorLimits;

type Checked = Result<(), ConfigError>;

#[inline]
fn same(field: Field, is_same: bool) -> Checked {
    if is_same {
        Ok(())
    } else {
        Err(ConfigError::Shape(field))
    }
}

impl<R: Real> Config<R> {
    /// Whether a module that runs by this one can go on by `new`, which is checked; a motor of
    /// it is armed or not.
    ///
    /// # Errors
    /// [`ConfigError::Shape`] names what only a start changes, [`ConfigError::Armed`] a limit
    /// that protects.
    pub fn may_become(&self, new: &Self, is_armed: bool) -> Result<(), ConfigError> {
        let (old, head) = (&self.head, &new.head);
        same(Field::Name, old.name == head.name)?;
        same(Field::TickHz, old.tick_hz == head.tick_hz)?;
        same(Field::Sides, old.sides == head.sides)?;
        same(
            Field::Whiskers,
            old.whiskers_per_side == head.whiskers_per_side,
        )?;
        same(Field::Bus, !Part::Bus.is_built() || old.bus == head.bus)?;
        same(Field::SensorMode, self.sensor.kind == new.sensor.kind)?;
        same(Field::SensorMode, self.sensor.rest_us == new.sensor.rest_us)?;
        let zeros = [&self.sensor, &new.sensor].map(|sensor| sensor.limits.zero.is_some());
        same(Field::Zero, zeros[0] == zeros[1])?;
        let own = [&self.sensor, &new.sensor].map(|sensor| sensor.self_motion.is_some());
        same(Field::SelfMotion, own[0] == own[1])?;
        same(Field::Links, self.links == new.links)?;
        same(Field::Contact, self.contact == new.contact)?;
        match (&self.motion, &new.motion) {
            (Some(old), Some(new)) if Part::Motion.is_built() => moves_on(old, new)?,
            (None, None) => {}
            _ => return Err(ConfigError::Shape(Field::Motion)),
        }
        match (&self.classifier, &new.classifier) {
            (Some(old), Some(new)) if Part::Classifier.is_built() => decides_on(old, new)?,
            (None, None) => {}
            _ => return Err(ConfigError::Shape(Field::Classifier)),
        }
        if is_armed && Part::Motion.is_built() {
            self.protects_as(new)?;
        }
        Ok(())
    }

    fn protects_as(&self, new: &Self) -> Checked {
        let kept = |field, is_same: bool| {
            if is_same {
                Ok(())
            } else {
                Err(ConfigError::Armed(field))
            }
        };
        let new_sensor = new.sensor.limits;
        // What whisking must do to a reading follows from how fast it is.
        let old_sensor = SensorLimits {
            swing: new_sensor.swing,
            ..self.sensor.limits
        };
        kept(Field::SensorLimits, old_sensor == new_sensor)?;
        let (Some(old), Some(new)) = (&self.motion, &new.motion) else {
            return Ok(());
        };
        let (old, new) = (&old.servo, &new.servo);
        let mut guards = old.guards;
        // A test is as long as the duty takes to rise.
        if let (Some(old), Some(new)) = (&mut guards.model, &new.guards.model) {
            old.stroke = new.stroke;
        }
        kept(Field::Guards, guards == new.guards)?;
        kept(Field::DutyLimit, old.pd.limit == new.pd.limit)?;
        kept(
            Field::Angles,
            [old.pd.min, old.pd.max] == [new.pd.min, new.pd.max],
        )?;
        kept(Field::Homing, old.homing == new.homing)
    }
}

fn moves_on<R: Real>(old: &MotionConfig<R>, new: &MotionConfig<R>) -> Checked {
    let (before, after) = (&old.whisking, &new.whisking);
    let is_euler = |whisking: &whisking::Config<R>| {
        let is_euler = matches!(whisking.oscillators, oscillator::Config::Euler(_));
        is_euler && matches!(whisking.muscle, muscle::Config::Euler(_))
    };
    same(Field::Integrator, is_euler(before) == is_euler(after))?;
    same(Field::Rcp, before.rcp.is_some() == after.rcp.is_some())?;
    same(Field::Cia, before.cia.is_some() == after.cia.is_some())?;
    same(
        Field::Noise,
        before.noise.is_some() == after.noise.is_some(),
    )?;
    same(Field::Seed, old.seed == new.seed)?;
    same(Field::Driver, old.driver == new.driver)?;
    // The power stage of a brushless motor has its stall limit from the start.
    let is_brushed = old.driver == Driver::HBridge;
    let stalls = [old, new].map(|motion| motion.servo.guards.stall);
    same(Field::Guards, is_brushed || stalls[0] == stalls[1])?;
    same(Field::OnFault, old.stops_all == new.stops_all)?;
    same(Field::Arm, old.arms_at_start == new.arms_at_start)?;
    let homes = [old, new].map(|motion| motion.servo.homing.is_some());
    same(Field::Homing, homes[0] == homes[1])?;
    let counts = [old, new].map(|motion| motion.servo.pd.theta_per_count);
    same(Field::Encoder, counts[0] == counts[1])
}

fn decides_on<R: Real>(old: &ClassifierConfig<R>, new: &ClassifierConfig<R>) -> Checked {
    let is_same_rule = match (old.rule, new.rule) {
        (Some(RuleSettings::Sequential(_)), Some(RuleSettings::Sequential(_))) => true,
        // Sums of a window are under way.
        (old, new) => old == new,
    };
    same(Field::Rule, is_same_rule)?;
    same(Field::Deciding, old.deciding == new.deciding)?;
    let gates = [old, new].map(|classifier| classifier.contact_min.is_some());
    same(Field::ContactMin, gates[0] == gates[1])
}
