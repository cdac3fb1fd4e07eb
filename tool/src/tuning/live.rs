//! The keys of a scene that can be set while a module runs.

use firmware::tunable_number as number;
use scene::{Driver, MotorSection, Rule, Scene};
use whisking::GateSettings;

/// A key that can be set.
pub(crate) struct LiveKey {
    /// With its section.
    pub(crate) key: &'static str,
    /// The constant by which its value is known again: it rises or falls with it.
    pub(crate) lead: u8,
    /// Its value in a scene; none where the scene leaves its part out.
    pub(crate) place: fn(&mut Scene) -> Option<&mut f64>,
    /// What to look at when it is changed.
    pub(crate) watch: &'static str,
}

const fn live(
    key: &'static str,
    lead: u8,
    place: fn(&mut Scene) -> Option<&mut f64>,
    watch: &'static str,
) -> LiveKey {
    LiveKey {
        key,
        lead,
        place,
        watch,
    }
}

/// One of the motor's.
macro_rules! motor {
    ($key:ident, $lead:ident, $watch:literal) => {
        live(
            concat!("motor.", stringify!($key)),
            number::$lead,
            |scene| motor(scene).map(|motor| &mut motor.$key),
            $watch,
        )
    };
}

fn motor(scene: &mut Scene) -> Option<&mut MotorSection> {
    scene.motor.as_mut()
}

fn rcp(scene: &mut Scene) -> Option<&mut GateSettings> {
    scene.rcp.as_mut()
}

fn cia(scene: &mut Scene) -> Option<&mut GateSettings> {
    scene.cia.as_mut()
}

/// All of them. What others are computed from comes before those: `unmoved_duty` has its
/// margin by `kp`, the travel begins at `min_deg`.
pub(crate) const LIVE: &[LiveKey] = &[
    motor!(
        kp,
        KP,
        "setpoint against measured angle; humming or ringing: too much"
    ),
    motor!(kd, KD, "overshoot, and noise of the duty"),
    motor!(
        duty_limit,
        DUTY_LIMIT,
        "largest duty; stalls count from half of it"
    ),
    motor!(slew_per_s, SLEW, "how the duty rises; lag"),
    motor!(min_deg, MIN, "lowest angle; the travel guard moves with it"),
    motor!(
        max_deg,
        MAX,
        "highest angle; the travel guard moves with it"
    ),
    motor!(travel_margin_deg, TRAVEL_LOW, "travel faults"),
    motor!(following_limit_deg, FOLLOWING, "following faults"),
    motor!(top_speed_deg_s, SPEED, "runaway faults"),
    motor!(unmoved_duty, UNMOVED, "encoder faults"),
    motor!(
        continuous_duty,
        HEAT,
        "heat faults; how warm the motor gets"
    ),
    motor!(
        approach_deg_s,
        APPROACH,
        "the first move after the motor was off"
    ),
    motor!(homing_duty, HOMING_DUTY, "the next homing; used by `home`"),
    live(
        "motor.stop_deg",
        number::HOMING_STOP,
        |scene| {
            let motor = scene.motor.as_mut()?;
            let stop_deg = motor.retracted_deg();
            Some(motor.stop_deg.get_or_insert(stop_deg))
        },
        "the angle at rest after the next homing",
    ),
    live(
        "rcp.gain",
        number::RCP_GAIN,
        |scene| rcp(scene).map(|gate| &mut gate.gain),
        "z, and how far the whisker goes on after contact",
    ),
    live(
        "rcp.tau_s",
        number::RCP_TICK,
        |scene| rcp(scene).map(|gate| &mut gate.tau_s),
        "how z falls after contact",
    ),
    live(
        "cia.gain",
        number::CIA_GAIN,
        |scene| cia(scene).map(|gate| &mut gate.gain),
        "amplitude of the array after contact",
    ),
    live(
        "cia.tau_s",
        number::CIA_TICK,
        |scene| cia(scene).map(|gate| &mut gate.tau_s),
        "for how long it stays larger",
    ),
    live(
        "whisking.frequency_hz",
        number::RELAX,
        |scene| Some(&mut scene.whisking.as_mut()?.frequency_hz),
        "whisks a second; the following error grows with it",
    ),
    live(
        "whisking.noise",
        number::NOISE,
        |scene| Some(&mut scene.whisking.as_mut()?.noise),
        "how much one whisk differs from another",
    ),
    live(
        "classifier.threshold",
        number::THRESHOLD,
        |scene| match &mut scene.classifier.as_mut()?.rule {
            Rule::Sequential { threshold } => Some(threshold),
            Rule::Window { .. } => None,
        },
        "errors against decision time",
    ),
    live(
        "classifier.contact_min",
        number::CONTACT_MIN,
        |scene| scene.classifier.as_mut()?.contact_min.as_mut(),
        "how much of a touch counts",
    ),
    live(
        "sensor.frozen_s",
        number::FROZEN,
        |scene| Some(&mut scene.sensor.frozen_s),
        "frozen-sensor faults",
    ),
    live(
        "sensor.jump_per_s",
        number::JUMP,
        |scene| Some(&mut scene.sensor.jump_per_s),
        "jump faults",
    ),
];

impl LiveKey {
    /// The constant by which it is known in a scene.
    pub(crate) fn lead_in(&self, scene: &Scene) -> u8 {
        let euler = scene::Integrator::Euler;
        let is_euler = scene
            .whisking
            .as_ref()
            .is_some_and(|w| w.integrator == euler);
        match self.lead {
            number::RELAX if is_euler => number::EULER_RELAX,
            lead => lead,
        }
    }
}

/// The key that can be set.
///
/// # Errors
/// Why not.
pub(crate) fn live_key(key: &str, scene: &Scene) -> Result<&'static LiveKey, String> {
    let needs = "it needs a rebuild: whisker flash";
    let Some(live) = LIVE.iter().find(|live| live.key == key) else {
        let section = key.split_once('.').map_or("", |(section, _)| section);
        let why = match (section, key) {
            _ if scene::key_facts(key).is_none() => {
                return Err(format!(
                    "{key}: no key of a scene that can be set; whisker get lists them"
                ));
            }
            ("plant", _) => "it is of the simulated world, of which no module knows",
            (_, "whisking.gain") => {
                "only the start uses it; the command gain SIDE VALUE of a script changes it"
            }
            (_, "motor.gear" | "motor.counts_per_rev") => {
                "angles are counted by it since the start"
            }
            (_, "classifier.window") => "a window of its length is under way",
            (_, "duration_s" | "seed" | "whisking.start" | "motor.arm" | "name") => {
                "only the start uses it"
            }
            _ => "it says what is in the program",
        };
        return Err(format!("{key}: {why}; {needs}"));
    };
    let six_step = scene
        .motor
        .as_ref()
        .is_some_and(|motor| motor.driver == Driver::SixStep);
    if six_step && key == "motor.duty_limit" {
        let why = "the six-step driver has its stall limit from the start";
        return Err(format!("{key}: {why}; {needs}"));
    }
    Ok(live)
}
