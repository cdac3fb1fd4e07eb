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
use crate::values::{Read, Values};

const DIVIDES: &str = "allowed: a number that divides that of the whiskers, or no such key";

pub(crate) fn apply(values: &Values, text: &mut Text<'_>) {
    let mut rules = Rules { values, text };
    rules.at_least_one_tick("", "duration_s");
    rules.at_least_one_tick("plant", "present_s");
    rules.limits_in_order();
    rules.homing_is_gentle();
    rules.textured_is_active();
    rules.shaft_is_slender();
    rules.texture_suits_the_plant();
    rules.tilts_stay_in_range();
    rules.poses_change_in_the_air();
    rules.plate_begins_before_it_ends();
    rules.several_can_decide();
    rules.costs_or_thresholds();
    rules.priors_are_shares();
    rules.mode_is_the_mlx90333s();
    rules.serial_has_its_parts();
    rules.silence_can_be_counted();
    rules.self_motion_has_its_parts();
    rules.boards_share_alike();
    rules.rows_are_alike();
}

struct Rules<'r, 't> {
    values: &'r Values,
    text: &'r mut Text<'t>,
}

impl Rules<'_, '_> {
    fn get<T: Read>(&self, section: &'static str, key: &'static str) -> Option<T> {
        self.values.get(section, key)
    }

    fn has(&self, section: &str) -> bool {
        self.values.section(section).is_some()
    }

    fn is_given(&self, section: &'static str, key: &'static str) -> bool {
        self.values.offset(section, key).is_some()
    }

    /// Reports a key where it stands in the file; one that does not, at its beginning.
    fn refuse(
        &mut self,
        section: &'static str,
        key: &'static str,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) {
        let offset = self.values.offset(section, key).unwrap_or(0);
        let path = path(section, key);
        self.text.report(offset, path, found.into(), allowed.into());
    }

    /// Each row of a side has as many whiskers as any other.
    fn rows_are_alike(&mut self) {
        let [rows, each] = ["rows", "whiskers_per_side"].map(|key| self.get::<usize>("head", key));
        if let (Some(rows), Some(each)) = (rows, each)
            && !each.is_multiple_of(rows)
        {
            let found = format!("found {rows} rows for {each} whiskers a side");
            self.refuse("head", "rows", found, DIVIDES);
        }
    }

    /// Each board of a head carries as many whiskers as any other.
    fn boards_share_alike(&mut self) {
        let (Some(nodes), Some(each), Some(sides)) = (
            self.get::<u8>("head", "nodes"),
            self.get::<usize>("head", "whiskers_per_side"),
            self.get::<Sides>("head", "sides"),
        ) else {
            return;
        };
        let whiskers = each * sides.count();
        if !whiskers.is_multiple_of(nodes.into()) {
            let found = format!("found {nodes} boards for {whiskers} whiskers");
            self.refuse("head", "nodes", found, DIVIDES);
        }
    }

    fn self_motion_has_its_parts(&mut self) {
        if !self.is_given("sensor", "self_motion_s") {
            return;
        }
        for part in ["whisking", "classifier"] {
            if !self.has(part) {
                let found = format!("found without [{part}]");
                let allowed = format!("allowed: only with [{part}]");
                self.refuse("sensor", "self_motion_s", found, allowed);
            }
        }
    }

    fn silence_can_be_counted(&mut self) {
        let after_s = self.get::<f64>("sensor", "zero_after_s");
        let (Some(after_s), Some(tick_hz)) = (after_s, self.get::<u32>("", "tick_hz")) else {
            return;
        };
        let ticks = u16::MAX - 1;
        let most = f64::from(ticks) / f64::from(tick_hz);
        if after_s > most {
            let found = format!("found {after_s} s at {tick_hz} Hz");
            let allowed = format!("allowed: at most {most:.3} s, that is {ticks} ticks");
            self.refuse("sensor", "zero_after_s", found, allowed);
        }
    }

    fn mode_is_the_mlx90333s(&mut self) {
        if self.get::<SensorModel>("sensor", "model") != Some(SensorModel::Tmag5170) {
            return;
        }
        if self.get::<SensorMode>("sensor", "mode") == Some(SensorMode::Slow) {
            let found = "found \"slow\" with model \"tmag5170\"";
            let allowed = "allowed: \"fast\", as only the MLX90333 has a slow mode";
            self.refuse("sensor", "mode", found, allowed);
        }
        for key in ["words", "sum_rule", "byte_order", "rest_us"] {
            if self.is_given("sensor", key) {
                let found = "found with model \"tmag5170\"";
                let allowed = "allowed: no such key, as it is the MLX90333's";
                self.refuse("sensor", key, found, allowed);
            }
        }
    }

    fn at_least_one_tick(&mut self, section: &'static str, key: &'static str) {
        let seconds = self.get::<f64>(section, key);
        let (Some(seconds), Some(tick_hz)) = (seconds, self.get::<u32>("", "tick_hz")) else {
            return;
        };
        if seconds * f64::from(tick_hz) < 1.0 {
            let found = format!("found {seconds} s");
            let allowed = format!("allowed: at least one tick, that is 1/{tick_hz} s");
            self.refuse(section, key, found, allowed);
        }
    }

    fn limits_in_order(&mut self) {
        let limit = |key| self.get::<f64>("motor", key);
        let (Some(min), Some(max)) = (limit("min_deg"), limit("max_deg")) else {
            return;
        };
        if min < max {
            return;
        }
        // The message goes to the limit that is in the file; to the lower if both are.
        let (key, found, allowed) = if self.is_given("motor", "min_deg") {
            ("min_deg", min, format!("below max_deg, which is {max}"))
        } else {
            ("max_deg", max, format!("above min_deg, which is {min}"))
        };
        let (found, allowed) = (format!("found {found}"), format!("allowed: {allowed}"));
        self.refuse("motor", key, found, allowed);
    }

    /// Harder it would be a stall to stand against the stop.
    fn homing_is_gentle(&mut self) {
        let duty = |key| self.get::<f64>("motor", key);
        let (Some(homing), Some(limit)) = (duty("homing_duty"), duty("duty_limit")) else {
            return;
        };
        let finds = self.get::<Rest>("motor", "rest") == Some(Rest::Find);
        if !finds || homing > 0.0 && homing <= limit / 2.0 {
            return;
        }
        if limit <= 0.0 {
            let found = "found 0 with rest = \"find\"";
            let allowed = "allowed: above 0, as the stop is found by the motor";
            self.refuse("motor", "duty_limit", found, allowed);
            return;
        }
        let offset = |key| self.values.offset("motor", key);
        let offset = offset("homing_duty").or_else(|| offset("duty_limit"));
        let path = path("motor", "homing_duty");
        let found = format!("found {homing}");
        let allowed = format!("allowed: above 0, at most half of duty_limit, which is {limit}");
        self.text.report(offset.unwrap_or(0), path, found, allowed);
    }

    fn textured_is_active(&mut self) {
        let kind = self.get::<PlantKind>("plant", "kind");
        if let Some(kind) = kind.filter(|kind| kind.has_textures())
            && !self.has("whisking")
        {
            let found = format!("found \"{kind}\" without [whisking]");
            let allowed = format!(
                "the {kind} plant needs an active whisker: add [whisking], or choose \"ideal\""
            );
            self.refuse("plant", "kind", found, allowed);
        }
    }

    /// Without an elastic shaft, few surfaces are described.
    fn texture_suits_the_plant(&mut self) {
        let kind = self.get::<PlantKind>("plant", "kind");
        let textures = self.get::<Vec<Texture>>("plant", "textures");
        let (Some(PlantKind::Textured), Some(textures)) = (kind, textures) else {
            return;
        };
        if let Some(other) = textures.iter().find(|texture| !texture.is_simple()) {
            let found = format!("found \"{other}\" with kind = \"textured\"");
            let allowed =
                "allowed: \"smooth\", \"p600\", \"p240\" and \"carpet\", or kind = \"whisker\"";
            self.refuse("plant", "textures", found, allowed);
        }
    }

    /// Every tilt that may be drawn is one that `tilt_deg` may have.
    fn tilts_stay_in_range(&mut self) {
        let angle = |key| self.get::<f64>("plant", key);
        let (Some(spread), Some(tilt)) = (angle("tilt_spread_deg"), angle("tilt_deg")) else {
            return;
        };
        let most = TILT_LIMIT_DEG - tilt.abs();
        if spread > most {
            let found = format!("found {spread} with tilt_deg = {tilt}");
            let allowed = format!(
                "allowed: at most {most}, as tilts are from -{TILT_LIMIT_DEG} to {TILT_LIMIT_DEG}"
            );
            self.refuse("plant", "tilt_spread_deg", found, allowed);
        }
    }

    /// A plate that is turned under a bent whisker would throw it.
    fn poses_change_in_the_air(&mut self) {
        let is_timed = self.get::<Exchanged>("plant", "exchange") == Some(Exchanged::Timed);
        let spreads = ["tilt_spread_deg", "obstacle_spread_deg", "gain_spread"];
        let spread = spreads.into_iter().find(|key| {
            let spread = self.get::<f64>("plant", key);
            spread.is_some_and(|spread| spread > 0.0)
        });
        if let (true, Some(spread)) = (is_timed, spread) {
            let found = format!("found \"timed\" with {spread}");
            let allowed = "allowed: \"air\", as poses change where nothing is touched";
            self.refuse("plant", "exchange", found, allowed);
        }
    }

    fn plate_begins_before_it_ends(&mut self) {
        let end = |key| self.get::<f64>("plant", key);
        if let (Some(begins), Some(ends)) = (end("begins_m"), end("ends_m"))
            && ends < begins
        {
            let found = format!("found {ends} with begins_m = {begins}");
            let allowed = format!("allowed: at least {begins}, where it is a round bar");
            self.refuse("plant", "ends_m", found, allowed);
        }
    }

    /// Thicker shafts do not bend as Euler and Bernoulli have it.
    fn shaft_is_slender(&mut self) {
        let Some(length) = self.get::<f64>("plant", "length_m") else {
            return;
        };
        for key in ["hub_diameter_m", "tip_diameter_m"] {
            let diameter = self.get::<f64>("plant", key);
            if let Some(diameter) = diameter.filter(|diameter| *diameter > length / 5.0) {
                let found = format!("found {diameter}");
                let allowed = format!("allowed: at most a fifth of length_m, which is {length}");
                self.refuse("plant", key, found, allowed);
            }
        }
    }

    /// More than the first whisker decide only where there are more, and together only where
    /// evidence waits for others'.
    fn several_can_decide(&mut self) {
        let (deciding, name) = match self.get::<Deciding>("classifier", "whiskers") {
            Some(deciding @ Deciding::Each) => (deciding, "each"),
            Some(deciding @ Deciding::Together) => (deciding, "together"),
            _ => return,
        };
        let whiskers = self.get::<usize>("head", "whiskers_per_side");
        let sides = self.get::<Sides>("head", "sides");
        let is_alone = (whiskers, sides) == (Some(1), Some(Sides::Left));
        let by_window = self.get::<RuleName>("classifier", "rule") == Some(RuleName::Window);
        let allowed = if is_alone {
            "allowed: \"first\", as there is one whisker"
        } else if by_window && deciding == Deciding::Together {
            "allowed: \"first\" or \"each\", as a window counts the samples of one whisker"
        } else {
            return;
        };
        let found = format!("found \"{name}\"");
        self.refuse("classifier", "whiskers", found, allowed);
    }

    /// Priors leave something to other classes, or are 1 together: what of both holds a model says
    /// where there is one.
    fn priors_are_shares(&mut self) {
        if self.is_given("classifier", "model") {
            return;
        }
        let Some(prior) = self.get::<Vec<(String, f64)>>("classifier", "prior") else {
            return;
        };
        let sum: f64 = prior.iter().map(|(_, share)| share).sum();
        if sum > 1.0 + 1e-6 {
            let found = format!("found a sum of {sum}");
            self.refuse("classifier", "prior", found, "allowed: at most 1");
        }
    }

    /// What costs come to is not to be said beside them.
    fn costs_or_thresholds(&mut self) {
        if !self.is_given("classifier", "cost_error") {
            return;
        }
        for key in ["threshold", "thresholds"] {
            if self.is_given("classifier", key) {
                let allowed = "allowed: either thresholds, or costs, which come to thresholds";
                self.refuse("classifier", key, "found with cost_error", allowed);
            }
        }
    }

    /// The serial port shares the records and the requests of the link, and the pins show what a
    /// classifier tells.
    fn serial_has_its_parts(&mut self) {
        let has_link = self.get::<bool>("telemetry", "rtt") != Some(false);
        if !has_link && self.is_given("telemetry", "serial_baud") {
            let allowed = "allowed: rtt = true, whose records and commands it carries";
            self.refuse(
                "telemetry",
                "serial_baud",
                "found with rtt = false",
                allowed,
            );
        }
        let has_pins = self.get::<bool>("telemetry", "pins") == Some(true);
        if has_pins && !self.has("classifier") {
            let found = "found true without [classifier]";
            let allowed = "allowed: false, as nothing tells of touches and decisions";
            self.refuse("telemetry", "pins", found, allowed);
        }
    }
}
