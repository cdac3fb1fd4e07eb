//! What a calibration found, as a file.

use host_sim::origin::Origin;
use toml_edit::{Array, DocumentMut, Item, value};

use crate::calibrate::{Gains, Motor, Zero};

/// What was found; none: a step did not come to it.
#[derive(Debug, Default)]
pub(super) struct Results {
    pub(super) zero: Option<Zero>,
    pub(super) range_deg: Option<[f64; 2]>,
    /// Codes of x and of y while it whisks in the air.
    pub(super) swing: Vec<[u16; 2]>,
    pub(super) motor: Option<Motor>,
    /// How far from its setpoint it came to rest at most, degrees.
    pub(super) left_deg: Option<f64>,
    pub(super) suggested: Option<Gains>,
}

impl Results {
    pub(super) fn toml(&self, origin: &Origin) -> String {
        let mut document = DocumentMut::new();
        let mut put = |key: &str, found: Item| document[key] = found;
        for (key, said) in origin.iter() {
            put(key, value(said));
        }
        if let Some(zero) = &self.zero {
            let [x, y] = &zero.channels;
            put("zero_codes", pair([x.mean, y.mean]));
            put("noise_codes", pair([x.sd, y.sd]));
            put("drift_codes", pair([x.drift, y.drift]));
        }
        for (key, [low, high]) in ["x_in_air_codes", "y_in_air_codes"].iter().zip(&self.swing) {
            put(key, pair([low, high].map(|code| f64::from(*code))));
        }
        if let Some(range) = self.range_deg {
            put("range_deg", pair(range));
        }
        if let Some(motor) = self.motor {
            put("speed_deg_s", value(rounded(motor.speed_deg_s)));
            put("time_constant_s", value(rounded(motor.tau_s)));
            put("friction_duty", value(rounded(motor.friction)));
        }
        if let Some(left) = self.left_deg {
            put("rest_error_deg", value(rounded(left)));
        }
        if let Some(gains) = self.suggested {
            put("suggested_kp", value(gains.kp));
            put("suggested_kd", value(gains.kd));
        }
        document.to_string()
    }
}

fn rounded(number: f64) -> f64 {
    format!("{number:.4e}").parse().unwrap_or(number)
}

fn pair(numbers: [f64; 2]) -> Item {
    value(numbers.into_iter().map(rounded).collect::<Array>())
}
