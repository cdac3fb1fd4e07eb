//! The first part of a long run, and the last: what is held against each other.

use host_sim::decisions::{Decided, Verdict};
use host_sim::trace::Row;

/// By how much the range of an angle may differ, degrees: a tenth of what whiskers range
/// over, noise among it.
const RANGE_DEG: f64 = 5.0;
/// By how much rates may differ, standard deviations of counts, and beside that as a share.
const DEVIATIONS: f64 = 5.0;
const SHARE: f64 = 0.01;

#[derive(Debug, Clone, Default)]
pub(super) struct Span {
    ticks: u64,
    pub(super) decisions: u64,
    right: u64,
    /// Least and largest of setpoint and angle of each side, degrees.
    ranges: [[[f64; 2]; 2]; 2],
}

impl Span {
    pub(super) fn tick(&mut self, row: &Row, decided: &[Decided], classes: &[String]) {
        let now = [row.theta_deg, row.angle_deg];
        for (ranges, values) in self.ranges.iter_mut().zip(now) {
            for ([least, most], value) in ranges.iter_mut().zip(values) {
                if self.ticks == 0 {
                    (*least, *most) = (value, value);
                }
                *least = least.min(value);
                *most = most.max(value);
            }
        }
        self.ticks += 1;
        self.decisions += decided.len() as u64;
        let verdicts = decided.iter().map(|decided| decided.verdict(classes));
        let right = verdicts.filter(|verdict| *verdict == Verdict::Right);
        self.right += right.count() as u64;
    }

    pub(super) fn rate(&self, tick_hz: f64) -> f64 {
        self.decisions as f64 * 3600.0 * tick_hz / self.ticks.max(1) as f64
    }

    pub(super) fn right(&self) -> Option<f64> {
        (self.decisions > 0).then(|| self.right as f64 / self.decisions as f64)
    }

    pub(super) fn difference(&self, later: &Self) -> Option<String> {
        let pairs = self.ranges.as_flattened().iter();
        for (before, after) in pairs.zip(later.ranges.as_flattened()) {
            let moved = before.iter().zip(after).map(|(a, b)| (a - b).abs());
            // A side that is not there is no number on either.
            if moved.fold(0.0, f64::max) > RANGE_DEG {
                return Some(format!("a whisker ranged over {before:?}, then {after:?}"));
            }
        }
        let [a, b] = [self.decisions, later.decisions].map(|count| count as f64);
        if (a - b).abs() > DEVIATIONS * (a + b).sqrt() + SHARE * a {
            return Some(format!("{a} decisions, then {b}"));
        }
        if let (Some(p), Some(q)) = (self.right(), later.right()) {
            let mean = (p * a + q * b) / (a + b);
            let deviation = (mean * (1.0 - mean) * (1.0 / a + 1.0 / b)).sqrt();
            if (p - q).abs() > DEVIATIONS * deviation + SHARE {
                return Some(format!("{p} of the decisions right, then {q}"));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::Span;
    use host_sim::trace::Row;

    fn span(decisions: u64, right: u64, most: f64) -> Span {
        let mut span = Span::default();
        for angle in [50.0, most] {
            let row = Row {
                theta_deg: [angle, f64::NAN],
                angle_deg: [angle, f64::NAN],
                ..Row::default()
            };
            span.tick(&row, &[], &[]);
        }
        (span.decisions, span.right) = (decisions, right);
        span
    }

    #[test]
    fn what_ends_otherwise_is_found_and_chance_is_not() {
        let first = span(10_000, 9_900, 110.0);
        assert_eq!(first.difference(&span(10_100, 9_990, 112.0)), None);
        for (later, said) in [
            (span(8_000, 7_920, 110.0), "decisions"),
            (span(0, 0, 110.0), "decisions"),
            (span(10_000, 9_500, 110.0), "right"),
            (span(10_000, 9_900, 120.0), "ranged"),
        ] {
            let found = first.difference(&later).expect(said);
            assert!(found.contains(said), "{found}");
        }
    }
}
