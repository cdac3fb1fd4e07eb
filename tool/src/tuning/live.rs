//! The keys of a scene that can be set while a module runs.

use scene::{Driver, MotorSection, Rest, Rule, Scene};

pub(crate) struct LiveKey {
    pub(crate) key: &'static str,
    /// Its value in a scene; none where the scene leaves its part out.
    pub(crate) place: fn(&mut Scene) -> Option<&mut f64>,
    /// What to look at when it is changed.
    pub(crate) watch: &'static str,
}

/// A key of a section that a scene may leave out, or has only if something is so.
macro_rules! live {
    ($section:ident.$key:ident $(if $condition:expr)?, $watch:literal) => {
        LiveKey {
            key: concat!(stringify!($section), ".", stringify!($key)),
            place: |scene| {
                let section = scene.$section.as_mut()?;
                $(if !$condition(section) {
                    return None;
                })?
                Some(&mut section.$key)
            },
            watch: $watch,
        }
    };
    ($key:literal, $place:expr, $watch:literal) => {
        LiveKey {
            key: $key,
            place: $place,
            watch: $watch,
        }
    };
}

fn is_homed(motor: &MotorSection) -> bool {
    motor.rest == Rest::Find
}

pub(crate) const LIVE: &[LiveKey] = &[
    live!(
        motor.kp,
        "setpoint against measured angle; humming or ringing: too much"
    ),
    live!(motor.kd, "overshoot, and noise of the duty"),
    live!(
        motor.duty_limit,
        "largest duty; stalls count from half of it"
    ),
    live!(motor.slew_per_s, "how the duty rises; lag"),
    live!(
        motor.min_deg,
        "lowest angle; the travel guard moves with it"
    ),
    live!(
        motor.max_deg,
        "highest angle; the travel guard moves with it"
    ),
    live!(motor.travel_margin_deg, "travel faults"),
    live!(motor.following_limit_deg, "following faults"),
    live!(motor.top_speed_deg_s, "runaway faults"),
    live!(motor.unmoved_duty, "encoder faults"),
    live!(
        motor.continuous_duty,
        "heat faults; how warm the motor gets"
    ),
    live!(
        motor.approach_deg_s,
        "the first move after the motor was off"
    ),
    live!(motor.homing_duty if is_homed, "the next homing; used by `home`"),
    live!(
        "motor.stop_deg",
        |scene| {
            let motor = scene.motor.as_mut().filter(|motor| is_homed(motor))?;
            let stop_deg = motor.retracted_deg();
            Some(motor.stop_deg.get_or_insert(stop_deg))
        },
        "the angle at rest after the next homing"
    ),
    live!(rcp.gain, "z, and how far the whisker goes on after contact"),
    live!(rcp.tau_s, "how z falls after contact"),
    live!(cia.gain, "amplitude of the array after contact"),
    live!(cia.tau_s, "for how long it stays larger"),
    live!(
        whisking.frequency_hz,
        "whisks a second; the following error grows with it"
    ),
    live!(
        "whisking.noise",
        |scene| {
            let noise = &mut scene.whisking.as_mut()?.noise;
            (*noise > 0.0).then_some(noise)
        },
        "how much one whisk differs from another"
    ),
    live!(
        "classifier.threshold",
        |scene| match &mut scene.classifier.as_mut()?.rule {
            Rule::Sequential { threshold } => Some(threshold),
            Rule::Window { .. } => None,
        },
        "errors against decision time"
    ),
    live!(
        "classifier.contact_min",
        |scene| scene.classifier.as_mut()?.contact_min.as_mut(),
        "how much of a touch counts"
    ),
    live!(
        "sensor.frozen_s",
        |scene| Some(&mut scene.sensor.frozen_s),
        "frozen-sensor faults"
    ),
    live!(
        "sensor.jump_per_s",
        |scene| Some(&mut scene.sensor.jump_per_s),
        "jump faults"
    ),
];

/// The key that can be set.
pub(crate) fn live_key(key: &str, scene: &Scene) -> Result<&'static LiveKey, String> {
    let needs = "it needs a restart: whisker deploy --scene FILE";
    let Some(live) = LIVE.iter().find(|live| live.key == key) else {
        let section = key.split_once('.').map_or("", |(section, _)| section);
        let why = match (section, key) {
            _ if scene::key_facts(key).is_none() => {
                return Err(format!(
                    "{key}: no key of a scene that can be set; whisker get --list has all"
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
            _ => "the module is built from it at its start",
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
