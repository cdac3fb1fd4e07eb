//! Faults of the records while a label is captured: reported at once, and counted.

use host_sim::recording::GATE;
use wire::{Flags, TickRecord};

use super::alike::drift;
use super::touches::{Sampled, Touches};
use crate::calibrate::is_at_end;
use crate::tally::Before;

/// Samples of contact at an end from which it is reported: 5 ms at 2 kHz.
const SATURATED: u64 = 10;

/// By what share the ticks may come too fast or too slow: a ceramic resonator's, and the PC's
/// clock, together.
const RATE: f64 = 0.01;
const RATE_S: f64 = 2.0;

/// What has been reported of a label, each kind once, and how often it happened.
#[derive(Debug, Default)]
pub(crate) struct Checks {
    label: String,
    tick_hz: f64,
    lost: u64,
    restarts: u64,
    faults: u64,
    in_fault: bool,
    saturated: [u64; 2],
    /// Sequence and time from which the rate is measured.
    since: Option<(u32, f64)>,
    is_rate_reported: bool,
}

impl Checks {
    pub(crate) fn new(label: &str, tick_hz: u32) -> Self {
        Self {
            label: label.to_owned(),
            tick_hz: f64::from(tick_hz),
            ..Self::default()
        }
    }

    /// A record with what is before it; says what is wrong for the first time.
    pub(crate) fn record(&mut self, record: &TickRecord, before: Before) -> Option<String> {
        let valid = record.flags.contains(Flags::VALID);
        let was_in_fault = std::mem::replace(&mut self.in_fault, !valid);
        match before {
            Before::Lost(lost) => {
                self.lost += u64::from(lost);
                self.since = None;
                (self.lost == u64::from(lost)).then(|| {
                    format!(
                        "records lost before tick {}: {lost}. The touch that they are of does not \
                         count; is this PC busy, or the cable long?",
                        record.sequence
                    )
                })
            }
            Before::Restart => {
                self.restarts += 1;
                self.since = None;
                Some("the module has started again: whisker log tells why".to_owned())
            }
            Before::Nothing if !valid && !was_in_fault => {
                self.faults += 1;
                (self.faults == 1).then(|| {
                    format!(
                        "no valid reading at tick {}: a fault of sensor or motor. Is the magnet \
                         too near, too far or off its axis? whisker log names the fault, \
                         docs/faults.md what to do",
                        record.sequence
                    )
                })
            }
            Before::Nothing => None,
        }
        .map(|what| format!("{}: {what}", self.label))
    }

    pub(crate) fn sample(&mut self, sample: &Sampled) -> Option<String> {
        if sample.contact < GATE {
            return None;
        }
        let axes = ["x", "y"].into_iter().zip(sample.codes);
        for (saturated, (axis, code)) in self.saturated.iter_mut().zip(axes) {
            if is_at_end(code) {
                *saturated += 1;
                if *saturated == SATURATED {
                    return Some(format!(
                        "{}: {axis} is at the end of its range: the whisker is bent further than \
                         its sensor tells. Lay the sample farther away, or the magnet farther \
                         from the sensor",
                        self.label
                    ));
                }
            }
        }
        None
    }

    /// The last record came at this time; says so if they come at another rate than the
    /// module's.
    pub(crate) fn time(&mut self, sequence: u32, now_s: f64) -> Option<String> {
        let (first, then_s) = *self.since.get_or_insert((sequence, now_s));
        let passed = now_s - then_s;
        if passed < RATE_S || self.is_rate_reported {
            return None;
        }
        let rate = f64::from(sequence.wrapping_sub(first)) / passed;
        self.since = Some((sequence, now_s));
        if (rate / self.tick_hz - 1.0).abs() <= RATE {
            return None;
        }
        self.is_rate_reported = true;
        Some(format!(
            "{}: {rate:.0} ticks a second, the module says {:.0}: is its program of another \
             scene, or its clock wrong? What is learnt from this holds at this rate only",
            self.label, self.tick_hz
        ))
    }

    /// What there is to say of the label as a whole: how often each report happened, and whether
    /// its touches are alike.
    pub(crate) fn end(&self, touches: &Touches) -> Vec<String> {
        let mut said = Vec::new();
        let [x, y] = self.saturated;
        for (count, what) in [
            (self.lost, "records lost"),
            (self.restarts, "starts of the module"),
            (self.faults, "spells without a valid reading"),
            (x, "samples of contact with x at the end of its range"),
            (y, "samples of contact with y at the end of its range"),
        ] {
            if count > 0 {
                said.push(format!("{}: {what}: {count}", self.label));
            }
        }
        if let Some((sign, [early, late])) = drift(&touches.felt) {
            said.push(format!(
                "{}: its touches differ: {sign} {early:.2} in the first half, {late:.2} in the \
                 second. Did the sample slip, or the magnet? Fasten it, and capture the label \
                 again",
                self.label
            ));
        }
        said
    }
}

#[cfg(test)]
mod tests {
    use super::{Checks, Sampled};

    #[test]
    fn codes_at_their_ends_are_reported_where_there_is_contact() {
        let mut checks = Checks::new("felt", 2000);
        let mut take = |contact, x| {
            checks.sample(&Sampled {
                codes: [x, 8192],
                contact,
                touch: 1,
            })
        };
        assert!((0..100).all(|_| take(0.0, 16383).is_none()));
        assert!((0..100).all(|_| take(1.0, 16000).is_none()));
        assert!((0..9).all(|_| take(1.0, 16383).is_none()));
        assert!(take(1.0, 0).unwrap().starts_with("felt: x is at the end"));
        assert_eq!(take(1.0, 0), None);
    }
}
