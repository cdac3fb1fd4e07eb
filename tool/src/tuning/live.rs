//! The keys of a scene that can be set while a module runs.

use std::fmt;

use scene::{Driver, MotorSection, Rest, Rule, Scene};

pub(crate) struct LiveKey {
    pub(crate) key: &'static str,
    /// Its value in a scene; none where the scene leaves its part out.
    pub(crate) value: fn(&Scene) -> Option<Value>,
    /// What to look at when it is changed.
    pub(crate) watch: &'static str,
}

/// The value of a key. Written without spaces, as a configuration keeps it; by `{:#}` as in a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    /// Of classes by name; of none where the scene says nothing.
    PerClass(Vec<(String, f64)>),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) if f.alternate() => write!(f, "{number:?}"),
            Self::Number(number) => write!(f, "{number}"),
            Self::PerClass(classes) if classes.is_empty() => f.write_str("-"),
            Self::PerClass(classes) => {
                let space = if f.alternate() { " " } else { "" };
                let entry = |(class, number): &(String, f64)| {
                    format!("{}{space}={space}{number}", toml_key(class))
                };
                let entries: Vec<_> = classes.iter().map(entry).collect();
                let entries = entries.join(&format!(",{space}"));
                write!(f, "{{{space}{entries}{space}}}")
            }
        }
    }
}

/// A name as a key of TOML, without spaces.
fn toml_key(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if !name.is_empty() && name.chars().all(is_bare) {
        return name.to_owned();
    }
    let letters = name.chars().map(|c| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_whitespace() || c.is_control() => format!("\\U{:08X}", u32::from(c)),
        c => c.to_string(),
    });
    format!("\"{}\"", letters.collect::<String>())
}

/// A table of keys: of sections that a scene may leave out, of one that it has `always`, and
/// those that a function finds.
macro_rules! live {
    ($($section:ident.$key:ident $($how:ident)*: $watch:literal;)*) => {
        &[$(LiveKey {
            key: concat!(stringify!($section), ".", stringify!($key)),
            value: live!(@ $section $key $($how)*),
            watch: $watch,
        }),*]
    };
    (@ $section:ident $key:ident) => {
        |scene| Some(Value::Number(scene.$section.as_ref()?.$key))
    };
    (@ $section:ident $key:ident always) => {
        |scene| Some(Value::Number(scene.$section.$key))
    };
    (@ $section:ident $key:ident by $value:ident) => {
        |scene| $value(scene).map(Value::Number)
    };
    (@ $section:ident $key:ident classes $value:ident) => {
        |scene| $value(scene).map(Value::PerClass)
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
    classifier.thresholds classes thresholds: "the same of single classes";
    classifier.prior classes prior: "decision time, and errors, of what is frequent";
    classifier.cost_error by cost_error: "errors, and time to decide, of each class";
    classifier.cost_delay_per_s by cost_delay_per_s: "errors, and time to decide, of each class";
    classifier.contact_min by contact_min: "how much of a touch counts";
    sensor.frozen_s always: "frozen-sensor faults";
    sensor.jump_per_s always: "jump faults";
};

fn homed(scene: &Scene) -> Option<&MotorSection> {
    let motor = scene.motor.as_ref();
    motor.filter(|motor| motor.rest == Rest::Find)
}

fn homing_duty(scene: &Scene) -> Option<f64> {
    homed(scene).map(|motor| motor.homing_duty)
}

fn stop_deg(scene: &Scene) -> Option<f64> {
    let motor = homed(scene)?;
    Some(motor.stop_deg.unwrap_or_else(|| motor.retracted_deg()))
}

fn noise(scene: &Scene) -> Option<f64> {
    let noise = scene.whisking.as_ref()?.noise;
    (noise > 0.0).then_some(noise)
}

fn threshold(scene: &Scene) -> Option<f64> {
    match scene.classifier.as_ref()?.rule {
        Rule::Sequential { threshold } => Some(threshold),
        Rule::Costs { .. } | Rule::Window { .. } => None,
    }
}

fn costs(scene: &Scene) -> Option<[f64; 2]> {
    match scene.classifier.as_ref()?.rule {
        Rule::Costs { error, delay_per_s } => Some([error, delay_per_s]),
        Rule::Sequential { .. } | Rule::Window { .. } => None,
    }
}

fn cost_error(scene: &Scene) -> Option<f64> {
    costs(scene).map(|[error, _]| error)
}

fn cost_delay_per_s(scene: &Scene) -> Option<f64> {
    costs(scene).map(|[_, delay]| delay)
}

fn thresholds(scene: &Scene) -> Option<Vec<(String, f64)>> {
    let classifier = scene.classifier.as_ref()?;
    let has = matches!(classifier.rule, Rule::Sequential { .. });
    has.then(|| classifier.thresholds.clone().unwrap_or_default())
}

fn prior(scene: &Scene) -> Option<Vec<(String, f64)>> {
    let prior = &scene.classifier.as_ref()?.prior;
    Some(prior.clone().unwrap_or_default())
}

fn contact_min(scene: &Scene) -> Option<f64> {
    scene.classifier.as_ref()?.contact_min
}

/// Whether it comes to priors or thresholds of the classes of a model.
pub(crate) fn is_of_classes(key: &str) -> bool {
    [
        "classifier.prior",
        "classifier.thresholds",
        "classifier.cost_error",
        "classifier.cost_delay_per_s",
    ]
    .contains(&key)
}

pub(crate) fn live_key(key: &str, scene: &Scene) -> Result<&'static LiveKey, String> {
    let needs = "it needs a restart: whisker deploy --scene FILE";
    let Some(live) = LIVE.iter().find(|live| live.key == key) else {
        if scene::key_facts(key).is_none() {
            let why = "no key of a scene that can be set; whisker get --list has all";
            return Err(format!("{key}: {why}"));
        }
        if key.starts_with("plant.") {
            let why = "it is of the simulated world, of which no module knows";
            return Err(format!("{key}: {why}"));
        }
        let why = match key {
            "whisking.gain" => {
                "only the start uses it; the command gain SIDE VALUE of a script changes it"
            }
            "motor.gear" | "motor.counts_per_rev" => "angles are counted by it since the start",
            "classifier.window" => "a window of its length is under way",
            "duration_s" | "seed" | "whisking.start" | "motor.arm" | "name" => {
                "only the start uses it"
            }
            _ => "the module is built from it at its start",
        };
        return Err(format!("{key}: {why}; {needs}"));
    };
    let mut motor = scene.motor.iter();
    let is_six_step = motor.any(|motor| motor.driver == Driver::SixStep);
    if is_six_step && key == "motor.duty_limit" {
        let why = "the six-step driver has its stall limit from the start";
        return Err(format!("{key}: {why}; {needs}"));
    }
    Ok(live)
}

#[cfg(test)]
mod tests {
    use scene::Override;

    use super::Value;

    #[test]
    fn classes_of_any_name_are_read_as_they_are_written() {
        let classes = ["p600", "a \"b\" \\c", "Samt, grün", "\u{2003}"];
        let classes = classes.map(|name| (name.to_owned(), 0.125));
        let value = Value::PerClass(classes.to_vec());
        let text = value.to_string();
        assert!(!text.contains(char::is_whitespace), "{text}");
        for text in [text, format!("{value:#}")] {
            let table: toml_edit::DocumentMut = format!("prior = {text}").parse().unwrap();
            let table = table["prior"].as_inline_table().unwrap();
            let read = |(name, number): (&str, &toml_edit::Value)| {
                (name.to_owned(), number.as_float().unwrap())
            };
            let read: Vec<_> = table.iter().map(read).collect();
            assert_eq!(Value::PerClass(read), value);
            let given: Override = format!("classifier.prior={text}").parse().unwrap();
            assert_eq!(given.value(), text);
        }
        assert_eq!(format!("{:#}", Value::Number(2.0)), "2.0");
    }
}
