//! What is measured of each run of a sweep, and its table.

use firmware::Event;
use scene::Scene;

use crate::bench::HostModule;
use crate::columns::{self, Column, columns};
use crate::decisions::{Decided, Score, Verdict};
use crate::output::Output;
use crate::run::Run;
use crate::{Error, files};

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measured {
    /// Decisions that are right, wrong and refused.
    verdicts: [u64; 3],
    /// Mean time of contact of a decision that was not refused, s; none without one.
    decision_s: Option<f64>,
    touches: u64,
    faults: u64,
    /// Root mean square of measured angle less setpoint, first whisker of each side, degrees;
    /// none where nothing whisks.
    tracking_deg: Option<f64>,
}

impl Measured {
    pub(super) fn of(mut run: Run<dyn HostModule>, scene: &Scene, mut tick: impl FnMut()) -> Self {
        let mut decided: Vec<Decided> = Vec::new();
        let (mut touches, mut faults) = (0, 0);
        let (mut squares, mut count) = (0.0, 0_u64);
        let motor = scene.motor.as_ref();
        let limited =
            |theta: f64| motor.map_or(theta, |motor| theta.max(motor.min_deg).min(motor.max_deg));
        for _ in 0..run.ticks() {
            let row = run.tick();
            decided.extend(run.decisions());
            for event in run.events() {
                match event {
                    Event::Touch { .. } => touches += 1,
                    Event::SensorLost(..) | Event::MotorFault(..) => faults += 1,
                    _ => {}
                }
            }
            let errors = row.theta_deg.into_iter().zip(row.angle_deg);
            for (theta, angle) in errors.filter(|(theta, _)| !theta.is_nan()) {
                squares += (angle - limited(theta)).powi(2);
                count += 1;
            }
            tick();
        }
        let classes = run.classes();
        let counted = |verdict| {
            let is_it = |decided: &&Decided| decided.verdict(classes) == verdict;
            decided.iter().filter(is_it).count() as u64
        };
        let samples = Score::new(classes, &decided).mean_samples();
        let whisks = scene.whisking.is_some();
        Self {
            verdicts: [Verdict::Right, Verdict::Wrong, Verdict::Refused].map(counted),
            decision_s: samples.map(|samples| samples / f64::from(scene.tick_hz)),
            touches,
            faults,
            tracking_deg: whisks.then(|| (squares / count.max(1) as f64).sqrt()),
        }
    }

    fn error_rate(&self) -> Option<f64> {
        let [right, wrong, _] = self.verdicts;
        let all = right + wrong;
        (all > 0).then(|| wrong as f64 / all as f64)
    }

    /// In the order of [`COLUMNS`].
    fn cells(&self) -> [String; 8] {
        let [right, wrong, refused] = self.verdicts.map(|count| count.to_string());
        let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.6}"));
        [
            right,
            wrong,
            refused,
            number(self.error_rate()),
            number(self.decision_s),
            self.touches.to_string(),
            self.faults.to_string(),
            number(self.tracking_deg),
        ]
    }
}

/// The columns after those of the keys and the seed.
pub(crate) const COLUMNS: [Column; 8] = columns! {
    "right", "",
        "decisions that name what was touched, or say `unknown` of what the model does not know";
    "wrong", "", "decisions that name something else";
    "refused", "", "decisions that say `unknown` of what the model knows";
    "error_rate", "", "share of `wrong` in `right` and `wrong`; empty without either";
    "decision_time_s", "s", "mean time of contact of a right or wrong decision; empty without one";
    "touches", "", "touches that began, of all whiskers that decide";
    "faults", "", "faults of sensors and motors that began";
    "tracking_rms_deg", "degrees",
        "root mean square of angle less setpoint, first whisker of each side; empty without \
        `[whisking]`";
};

pub(super) fn write<'r>(
    output: Output,
    keys: impl Iterator<Item = &'r str>,
    rows: impl Iterator<Item = (&'r [String], u64, &'r Measured)>,
) -> Result<(), Error> {
    files::write(output, |output| {
        let mut table = csv::Writer::from_writer(output);
        table.write_record(keys.chain(["seed"]).chain(columns::names(&COLUMNS)))?;
        for (values, seed, measured) in rows {
            let values = values.iter().cloned();
            table.write_record(values.chain([seed.to_string()]).chain(measured.cells()))?;
        }
        table.flush()
    })
}
