//! Whether the touches of a label are alike: a sample that slips, or a magnet that comes loose,
//! makes classes that hold in one hour and not in the next.

/// What is compared of a touch.
const SIGNS: [&str; 3] = ["deflection", "sideways deflection", "roughness"];

/// What was felt in one touch: sums over its samples of contact.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Felt {
    samples: u32,
    sum: [f64; 2],
    /// Of the steps of x from sample to sample.
    steps: f64,
    last: Option<f64>,
}

impl Felt {
    pub(crate) fn take(&mut self, codes: [u16; 2]) {
        let codes = codes.map(f64::from);
        self.samples += 1;
        for (sum, code) in self.sum.iter_mut().zip(codes) {
            *sum += code;
        }
        let last = self.last.replace(codes[0]);
        self.steps += last.map_or(0.0, |last| (codes[0] - last).abs());
    }

    pub(crate) const fn samples(&self) -> u32 {
        self.samples
    }

    /// Mean deflection along and across the whisking, codes, and the logarithm of the mean
    /// step of the first from sample to sample.
    fn signs(&self) -> [f64; SIGNS.len()] {
        let samples = f64::from(self.samples.max(1));
        let [x, y] = self.sum.map(|sum| sum / samples);
        // A step of less than a code is the sensor's own.
        [x, y, (self.steps / samples).max(1.0).ln()]
    }
}

const LEAST: usize = 4;

/// By how many standard errors the means of two halves may differ: with 20 touches that
/// happens by chance once in a few thousand labels.
const ERRORS: f64 = 5.0;

/// Differences that are none, whatever their error: codes, codes, share.
const SMALL: [f64; SIGNS.len()] = [32.0, 32.0, 0.1];

/// By what the later half of some touches differs from the earlier: the sign's name, and its
/// means in both halves; nothing if the difference is one of chance.
pub(crate) fn drift(touches: &[Felt]) -> Option<(&'static str, [f64; 2])> {
    let (early, late) = touches.split_at(touches.len() / 2);
    if early.len() < LEAST {
        return None;
    }
    let halves = [early, late].map(|half| half.iter().map(Felt::signs).collect::<Vec<_>>());
    (0..SIGNS.len()).find_map(|sign| {
        let [(early, early_of), (late, late_of)] =
            halves.each_ref().map(|half| moments(half, sign));
        let (apart, error) = ((late - early).abs(), (early_of + late_of).sqrt());
        let differs = apart > SMALL[sign] && apart > ERRORS * error;
        differs.then_some((SIGNS[sign], [early, late]))
    })
}

/// The mean of a sign, and the variance of that mean.
fn moments(half: &[[f64; SIGNS.len()]], sign: usize) -> (f64, f64) {
    let n = half.len() as f64;
    let mean = half.iter().map(|signs| signs[sign]).sum::<f64>() / n;
    let square = |signs: &[f64; SIGNS.len()]| (signs[sign] - mean) * (signs[sign] - mean);
    let variance = half.iter().map(square).sum::<f64>() / (n - 1.0);
    (mean, variance / n)
}

#[cfg(test)]
mod tests {
    use super::{Felt, drift};

    fn touch(n: u32, mean: u16, step: u16) -> Felt {
        let mut felt = Felt::default();
        let scatter = (n * 37 % 11 * 5) as u16;
        for sample in 0..100 {
            let x = mean + scatter + if sample % 2 == 0 { step } else { 0 };
            felt.take([x, 8192]);
        }
        felt
    }

    /// Touches that scatter, of which the later half differs from the first by so much or not.
    #[test]
    fn a_later_half_that_bends_more_or_is_rougher_is_reported() {
        let drifts = |count: u32, bend: u16, roughness: u16| {
            let half = |n| u16::from(n >= count / 2);
            let of = |n| {
                let step = 40 + roughness * half(n);
                touch(n, 9000 + bend * half(n) - step / 2, step)
            };
            drift(&(0..count).map(of).collect::<Vec<_>>())
        };
        assert_eq!(drifts(20, 0, 1), None);
        for (bend, roughness, sign, expected) in [
            (200, 0, "deflection", 200.0),
            (0, 20, "roughness", 1.5_f64.ln()),
        ] {
            let (found, [early, late]) = drifts(20, bend, roughness).unwrap();
            assert_eq!(found, sign);
            let off = (late - early) / expected - 1.0;
            assert!(off.abs() < 0.08, "{sign}: {early} {late}");
        }
        assert_eq!(drifts(7, 900, 0), None, "they are few");
    }
}
