//! The keys of a scene that can be set while a module runs.

use scene::{Driver, MotorSection, Rest, Rule, Scene};

pub(crate) struct LiveKey {
    pub(crate) key: &'static str,
    /// Its value in a scene; none where the scene leaves its part out.
    pub(crate) place: fn(&mut Scene) -> Option<&mut f64>,
    /// What to look at when it is changed.
    pub(crate) watch: &'static str,
}

/// A table of keys: of sections that a scene may leave out, of one that it has `always`, and
/// those that a function finds.
macro_rules! live {
    ($($section:ident.$key:ident $($how:ident)*: $watch:literal;)*) => {
        &[$(LiveKey {
            key: concat!(stringify!($section), ".", stringify!($key)),
            place: live!(@ $section $key $($how)*),
            watch: $watch,
        }),*]
    };
    (@ $section:ident $key:ident) => {
        |scene| Some(&mut scene.$section.as_mut()?.$key)
    };
    (@ $section:ident $key:ident always) => {
        |scene| Some(&mut scene.$section.$key)
    };
    (@ $section:ident $key:ident by $place:ident) => {
        $place
    };
}

pub(crate) const LIVE: &[LiveKey] = live! {
    motor.kp: "setpoint against measured angle; humming or ringing: too much";
    motor.kd: "overshoot, and noise of the duty";
    motor.duty_limit: "largest duty; stalls count from half of it";
    motor.slew_per_s: "how the duty rises; lag";
    motor.min_deg: "lowest angle; the travel guard moves with it";
    motor.max_deg: "highest angle; the travel guard moves with it";
    motor.travel_margin_deg: "travel faults";
    motor.following_limit_deg: "following faults";
    motor.top_speed_deg_s: "runaway faults";
    motor.unmoved_duty: "friction that is expected, both ways together";
    motor.time_constant_s: "motion that is expected of a duty";
    motor.continuous_duty: "heat faults; how warm the motor gets";
    motor.approach_deg_s: "the first move after the motor was off";
    motor.homing_duty by homing_duty: "the next homing; used by `home`";
    motor.stop_deg by stop_deg: "the angle at rest after the next homing";
    rcp.gain: "z, and how far the whisker goes on after contact";
    rcp.tau_s: "how z falls after contact";
    cia.gain: "amplitude of the array after contact";
    cia.tau_s: "for how long it stays larger";
    whisking.frequency_hz: "whisks a second; the following error grows with it";
    whisking.noise by noise: "how much one whisk differs from another";
    classifier.threshold by threshold: "errors against decision time";
    classifier.contact_min by contact_min: "how much of a touch counts";
    sensor.frozen_s always: "frozen-sensor faults";
    sensor.jump_per_s always: "jump faults";
};

fn homed(scene: &mut Scene) -> Option<&mut MotorSection> {
    scene
        .motor
        .as_mut()
        .filter(|motor| motor.rest == Rest::Find)
}

fn homing_duty(scene: &mut Scene) -> Option<&mut f64> {
    homed(scene).map(|motor| &mut motor.homing_duty)
}

fn stop_deg(scene: &mut Scene) -> Option<&mut f64> {
    let motor = homed(scene)?;
    let stop_deg = motor.retracted_deg();
    Some(motor.stop_deg.get_or_insert(stop_deg))
}

fn noise(scene: &mut Scene) -> Option<&mut f64> {
    let whisking = scene.whisking.as_mut();
    let noise = whisking.map(|whisking| &mut whisking.noise);
    noise.filter(|noise| **noise > 0.0)
}

fn threshold(scene: &mut Scene) -> Option<&mut f64> {
    match &mut scene.classifier.as_mut()?.rule {
        Rule::Sequential { threshold } => Some(threshold),
        Rule::Costs { .. } | Rule::Window { .. } => None,
    }
}

fn contact_min(scene: &mut Scene) -> Option<&mut f64> {
    scene.classifier.as_mut()?.contact_min.as_mut()
}

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
