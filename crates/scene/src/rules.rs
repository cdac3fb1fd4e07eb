//! What keys ask of each other beyond their declarations.
//!
//! A rule that turns on a value that was itself refused is left alone: that
//! value's own message comes first.

use tactile::Deciding;

use crate::section::path;
use crate::sections::{
    Exchanged, PlantKind, Rest, RuleName, SensorMode, SensorModel, Sides, TILT_LIMIT_DEG, Texture,
};
use crate::text::Text;
use crate::values::Values;

pub(crate) fn apply(values: &Values, text: &mut Text<'_>) {
    at_least_one_tick("", "duration_s", values, text);
    at_least_one_tick("plant", "present_s", values, text);
    limits_in_order(values, text);
    homing_is_gentle(values, text);
    textured_is_active(values, text);
    shaft_is_slender(values, text);
    texture_suits_the_plant(values, text);
    tilts_stay_in_range(values, text);
    poses_change_in_the_air(values, text);
    plate_begins_before_it_ends(values, text);
    several_can_decide(values, text);
    costs_or_thresholds(values, text);
    mode_is_the_mlx90333s(values, text);
    serial_has_its_parts(values, text);
    silence_can_be_counted(values, text);
    self_motion_has_its_parts(values, text);
    boards_share_alike(values, text);
    rows_are_alike(values, text);
}

/// Each row of a side has as many whiskers as any other.
fn rows_are_alike(values: &Values, text: &mut Text<'_>) {
    let (Some(rows), Some(each)) = (
        values.get::<usize>("head", "rows"),
        values.get::<usize>("head", "whiskers_per_side"),
    ) else {
        return;
    };
    if !each.is_multiple_of(rows) {
        let offset = values.offset("head", "rows").unwrap_or(0);
        let found = format!("found {rows} rows for {each} whiskers a side");
        let allowed = "allowed: a number that divides that of the whiskers".to_owned();
        text.report(offset, path("head", "rows"), found, allowed);
    }
}

/// Each board of a head carries as many whiskers as any other.
fn boards_share_alike(values: &Values, text: &mut Text<'_>) {
    let (Some(nodes), Some(each), Some(sides)) = (
        values.get::<u8>("head", "nodes"),
        values.get::<usize>("head", "whiskers_per_side"),
        values.get::<Sides>("head", "sides"),
    ) else {
        return;
    };
    let whiskers = each * sides.count();
    if !whiskers.is_multiple_of(nodes.into()) {
        let offset = values.offset("head", "nodes").unwrap_or(0);
        let found = format!("found {nodes} boards for {whiskers} whiskers");
        let allowed = "allowed: a number that divides that of the whiskers".to_owned();
        text.report(offset, path("head", "nodes"), found, allowed);
    }
}

fn self_motion_has_its_parts(values: &Values, text: &mut Text<'_>) {
    let Some(offset) = values.offset("sensor", "self_motion_s") else {
        return;
    };
    for part in ["whisking", "classifier"] {
        if values.section(part).is_none() {
            let found = format!("found without [{part}]");
            let allowed = format!("allowed: only with [{part}]");
            text.report(offset, "sensor.self_motion_s".to_owned(), found, allowed);
        }
    }
}

fn silence_can_be_counted(values: &Values, text: &mut Text<'_>) {
    let (Some(after_s), Some(tick_hz), Some(offset)) = (
        values.get::<f64>("sensor", "zero_after_s"),
        values.get::<u32>("", "tick_hz"),
        values.offset("sensor", "zero_after_s"),
    ) else {
        return;
    };
    let most = f64::from(u16::MAX - 1) / f64::from(tick_hz);
    if after_s > most {
        let found = format!("found {after_s} s at {tick_hz} Hz");
        let allowed = format!(
            "allowed: at most {most:.3} s, that is {} ticks",
            u16::MAX - 1
        );
        text.report(offset, "sensor.zero_after_s".to_owned(), found, allowed);
    }
}

fn mode_is_the_mlx90333s(values: &Values, text: &mut Text<'_>) {
    if values.get::<SensorModel>("sensor", "model") != Some(SensorModel::Tmag5170) {
        return;
    }
    let is_slow = values.get::<SensorMode>("sensor", "mode") == Some(SensorMode::Slow);
    if is_slow {
        let offset = values.offset("sensor", "mode").unwrap_or(0);
        let found = "found \"slow\" with model \"tmag5170\"".to_owned();
        let allowed = "allowed: \"fast\", as only the MLX90333 has a slow mode".to_owned();
        text.report(offset, "sensor.mode".to_owned(), found, allowed);
    }
    for key in ["words", "sum_rule", "byte_order", "rest_us"] {
        if let Some(offset) = values.offset("sensor", key) {
            let found = "found with model \"tmag5170\"".to_owned();
            let allowed = "allowed: no such key, as it is the MLX90333's".to_owned();
            text.report(offset, path("sensor", key), found, allowed);
        }
    }
}

fn at_least_one_tick(
    section: &'static str,
    key: &'static str,
    values: &Values,
    text: &mut Text<'_>,
) {
    let (Some(seconds), Some(tick_hz), Some(offset)) = (
        values.get::<f64>(section, key),
        values.get::<u32>("", "tick_hz"),
        values.offset(section, key),
    ) else {
        return;
    };
    if seconds * f64::from(tick_hz) < 1.0 {
        let allowed = format!("allowed: at least one tick, that is 1/{tick_hz} s");
        let found = format!("found {seconds} s");
        text.report(offset, path(section, key), found, allowed);
    }
}

fn limits_in_order(values: &Values, text: &mut Text<'_>) {
    let limit = |key| values.get::<f64>("motor", key);
    let (Some(min), Some(max)) = (limit("min_deg"), limit("max_deg")) else {
        return;
    };
    if min < max {
        return;
    }
    // The message goes to the limit that is in the file; to the lower if both are.
    let (key, found, allowed) = if values.offset("motor", "min_deg").is_some() {
        ("min_deg", min, format!("below max_deg, which is {max}"))
    } else {
        ("max_deg", max, format!("above min_deg, which is {min}"))
    };
    let offset = values.offset("motor", key).unwrap_or(0);
    let (found, allowed) = (format!("found {found}"), format!("allowed: {allowed}"));
    text.report(offset, format!("motor.{key}"), found, allowed);
}

/// Harder it would be a stall to stand against the stop.
fn homing_is_gentle(values: &Values, text: &mut Text<'_>) {
    let duty = |key| values.get::<f64>("motor", key);
    let (Some(homing), Some(limit)) = (duty("homing_duty"), duty("duty_limit")) else {
        return;
    };
    let finds = values.get::<Rest>("motor", "rest") == Some(Rest::Find);
    if !finds || homing > 0.0 && homing <= limit / 2.0 {
        return;
    }
    let offset = values.offset("motor", "homing_duty");
    let offset = offset.or_else(|| values.offset("motor", "duty_limit"));
    let allowed = format!("allowed: above 0, at most half of duty_limit, which is {limit}");
    let path = "motor.homing_duty".to_owned();
    text.report(
        offset.unwrap_or(0),
        path,
        format!("found {homing}"),
        allowed,
    );
}

fn textured_is_active(values: &Values, text: &mut Text<'_>) {
    let Some(kind) = values.get::<PlantKind>("plant", "kind") else {
        return;
    };
    if kind.has_textures() && values.section("whisking").is_none() {
        let offset = values.offset("plant", "kind").unwrap_or(0);
        let found = format!("found \"{kind}\" without [whisking]");
        let allowed = format!(
            "the {kind} plant needs an active whisker: add [whisking], or choose \"ideal\""
        );
        text.report(offset, "plant.kind".to_owned(), found, allowed);
    }
}

/// Without an elastic shaft, few surfaces are described.
fn texture_suits_the_plant(values: &Values, text: &mut Text<'_>) {
    let kind = values.get::<PlantKind>("plant", "kind");
    let textures = values.get::<Vec<Texture>>("plant", "textures");
    let (Some(PlantKind::Textured), Some(textures)) = (kind, textures) else {
        return;
    };
    if let Some(other) = textures.iter().find(|texture| !texture.is_simple()) {
        let offset = values.offset("plant", "textures").unwrap_or(0);
        let found = format!("found \"{other}\" with kind = \"textured\"");
        let allowed =
            "allowed: \"smooth\", \"p600\", \"p240\" and \"carpet\", or kind = \"whisker\"";
        let path = "plant.textures".to_owned();
        text.report(offset, path, found, allowed.to_owned());
    }
}

/// Every tilt that may be drawn is one that `tilt_deg` may have.
fn tilts_stay_in_range(values: &Values, text: &mut Text<'_>) {
    let (Some(spread), Some(tilt), Some(offset)) = (
        values.get::<f64>("plant", "tilt_spread_deg"),
        values.get::<f64>("plant", "tilt_deg"),
        values.offset("plant", "tilt_spread_deg"),
    ) else {
        return;
    };
    let most = TILT_LIMIT_DEG - tilt.abs();
    if spread > most {
        let path = "plant.tilt_spread_deg".to_owned();
        let found = format!("found {spread} with tilt_deg = {tilt}");
        let allowed = format!(
            "allowed: at most {most}, as tilts are from -{TILT_LIMIT_DEG} to {TILT_LIMIT_DEG}"
        );
        text.report(offset, path, found, allowed);
    }
}

/// A plate that is turned under a bent whisker would throw it.
fn poses_change_in_the_air(values: &Values, text: &mut Text<'_>) {
    let is_timed = values.get::<Exchanged>("plant", "exchange") == Some(Exchanged::Timed);
    let spreads = ["tilt_spread_deg", "obstacle_spread_deg", "gain_spread"];
    let spread = spreads.into_iter().find(|key| {
        let spread = values.get::<f64>("plant", key);
        spread.is_some_and(|spread| spread > 0.0)
    });
    if let (true, Some(spread)) = (is_timed, spread) {
        let offset = values.offset("plant", "exchange").unwrap_or(0);
        let found = format!("found \"timed\" with {spread}");
        let allowed = "allowed: \"air\", as poses change where nothing is touched".to_owned();
        text.report(offset, "plant.exchange".to_owned(), found, allowed);
    }
}

fn plate_begins_before_it_ends(values: &Values, text: &mut Text<'_>) {
    let (Some(Some(begins)), Some(Some(ends)), Some(offset)) = (
        values.get::<Option<f64>>("plant", "begins_m"),
        values.get::<Option<f64>>("plant", "ends_m"),
        values.offset("plant", "ends_m"),
    ) else {
        return;
    };
    if ends < begins {
        let path = "plant.ends_m".to_owned();
        let found = format!("found {ends} with begins_m = {begins}");
        let allowed = format!("allowed: at least {begins}, where it is a round bar");
        text.report(offset, path, found, allowed);
    }
}

/// Thicker shafts do not bend as Euler and Bernoulli have it.
fn shaft_is_slender(values: &Values, text: &mut Text<'_>) {
    let Some(length) = values.get::<f64>("plant", "length_m") else {
        return;
    };
    for key in ["hub_diameter_m", "tip_diameter_m"] {
        let (Some(diameter), Some(offset)) =
            (values.get::<f64>("plant", key), values.offset("plant", key))
        else {
            continue;
        };
        if diameter > length / 5.0 {
            let found = format!("found {diameter}");
            let allowed = format!("allowed: at most a fifth of length_m, which is {length}");
            text.report(offset, format!("plant.{key}"), found, allowed);
        }
    }
}

/// More than the first whisker decide only where there are more, and together only where
/// evidence waits for others'.
fn several_can_decide(values: &Values, text: &mut Text<'_>) {
    let deciding = values.get::<Deciding>("classifier", "whiskers");
    let Some(deciding) = deciding.filter(|deciding| *deciding != Deciding::First) else {
        return;
    };
    let whiskers = values.get::<usize>("head", "whiskers_per_side");
    let sides = values.get::<Sides>("head", "sides");
    let is_alone = (whiskers, sides) == (Some(1), Some(Sides::Left));
    let by_window = values.get::<RuleName>("classifier", "rule") == Some(RuleName::Window);
    let allowed = if is_alone {
        "allowed: \"first\", as there is one whisker"
    } else if by_window && deciding == Deciding::Together {
        "allowed: \"first\" or \"each\", as a window counts the samples of one whisker"
    } else {
        return;
    };
    let offset = values.offset("classifier", "whiskers").unwrap_or(0);
    let deciding = if deciding == Deciding::Each {
        "each"
    } else {
        "together"
    };
    let found = format!("found \"{deciding}\"");
    let path = "classifier.whiskers".to_owned();
    text.report(offset, path, found, allowed.to_owned());
}

/// What costs come to is not to be said beside them.
fn costs_or_thresholds(values: &Values, text: &mut Text<'_>) {
    if values.offset("classifier", "cost_error").is_none() {
        return;
    }
    for key in ["threshold", "thresholds"] {
        if let Some(offset) = values.offset("classifier", key) {
            let found = "found with cost_error".to_owned();
            let allowed = "allowed: either thresholds, or costs, which come to thresholds";
            text.report(offset, path("classifier", key), found, allowed.to_owned());
        }
    }
}

/// The serial port shares the records and the requests of the link, and the pins show what a
/// classifier tells.
fn serial_has_its_parts(values: &Values, text: &mut Text<'_>) {
    let has_link = values.get::<bool>("telemetry", "rtt") != Some(false);
    if let (false, Some(offset)) = (has_link, values.offset("telemetry", "serial_baud")) {
        let path = "telemetry.serial_baud".to_owned();
        let allowed = "allowed: rtt = true, whose records and commands it carries".to_owned();
        text.report(offset, path, "found with rtt = false".to_owned(), allowed);
    }
    let has_pins = values.get::<bool>("telemetry", "pins") == Some(true);
    if let (true, Some(offset)) = (
        has_pins && values.section("classifier").is_none(),
        values.offset("telemetry", "pins"),
    ) {
        let found = "found true without [classifier]".to_owned();
        let allowed = "allowed: false, as nothing tells of touches and decisions".to_owned();
        text.report(offset, "telemetry.pins".to_owned(), found, allowed);
    }
}
