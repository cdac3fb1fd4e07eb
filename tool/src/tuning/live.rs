//! The keys of a scene that can be set while a module runs.

use scene::{Driver, MotorSection, Rest, Rule, Scene, WhiskingSection};
use whisking::GateSettings;

/// A key that can be set.
pub(crate) struct LiveKey {
    /// With its section.
    pub(crate) key: &'static str,
    /// Its value in a scene; none where the scene leaves its part out.
    pub(crate) place: fn(&mut Scene) -> Option<&mut f64>,
    /// What to look at when it is changed.
    pub(crate) watch: &'static str,
}

/// A key of a section, which `$part` finds in a scene, where it has one.
macro_rules! live {
    ($part:ident: $section:ident.$key:ident, $watch:literal) => {
        live!(
            concat!(stringify!($section), ".", stringify!($key)),
            |scene| $part(scene).map(|part| &mut part.$key),
            $watch
        )
    };
    ($key:expr, $place:expr, $watch:literal) => {
        LiveKey {
            key: $key,
            place: $place,
            watch: $watch,
        }
    };
}

fn motor(scene: &mut Scene) -> Option<&mut MotorSection> {
    scene.motor.as_mut()
}

/// Of a motor whose rest is found.
fn homed(scene: &mut Scene) -> Option<&mut MotorSection> {
    motor(scene).filter(|motor| motor.rest == Rest::Find)
}

fn rcp(scene: &mut Scene) -> Option<&mut GateSettings> {
    scene.rcp.as_mut()
}

fn cia(scene: &mut Scene) -> Option<&mut GateSettings> {
    scene.cia.as_mut()
}

fn whisking(scene: &mut Scene) -> Option<&mut WhiskingSection> {
    scene.whisking.as_mut()
}

/// All of them.
pub(crate) const LIVE: &[LiveKey] = &[
    live!(motor: motor.kp, "setpoint against measured angle; humming or ringing: too much"),
    live!(motor: motor.kd, "overshoot, and noise of the duty"),
    live!(motor: motor.duty_limit, "largest duty; stalls count from half of it"),
    live!(motor: motor.slew_per_s, "how the duty rises; lag"),
    live!(motor: motor.min_deg, "lowest angle; the travel guard moves with it"),
    live!(motor: motor.max_deg, "highest angle; the travel guard moves with it"),
    live!(motor: motor.travel_margin_deg, "travel faults"),
    live!(motor: motor.following_limit_deg, "following faults"),
    live!(motor: motor.top_speed_deg_s, "runaway faults"),
    live!(motor: motor.unmoved_duty, "encoder faults"),
    live!(motor: motor.continuous_duty, "heat faults; how warm the motor gets"),
    live!(motor: motor.approach_deg_s, "the first move after the motor was off"),
    live!(homed: motor.homing_duty, "the next homing; used by `home`"),
    live!(
        "motor.stop_deg",
        |scene| {
            let motor = homed(scene)?;
            let stop_deg = motor.retracted_deg();
            Some(motor.stop_deg.get_or_insert(stop_deg))
        },
        "the angle at rest after the next homing"
    ),
    live!(rcp: rcp.gain, "z, and how far the whisker goes on after contact"),
    live!(rcp: rcp.tau_s, "how z falls after contact"),
    live!(cia: cia.gain, "amplitude of the array after contact"),
    live!(cia: cia.tau_s, "for how long it stays larger"),
    live!(whisking: whisking.frequency_hz, "whisks a second; the following error grows with it"),
    live!(
        "whisking.noise",
        |scene| {
            let noise = &mut whisking(scene)?.noise;
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
///
/// # Errors
/// Why not.
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
