//! Counting the peaks of a whisk.

/// A rise and fall of θ' that makes a maximum a peak, degrees: θ' is smooth, and
/// an unmodulated whisk has no dip at all.
const PROMINENCE_DEG: f64 = 0.5;

/// Maxima of angles that are parted by dips of half a degree or more. What comes
/// before the first rise does not count: a recording may begin on the way down
/// from a peak that is not its own.
pub(crate) fn peaks(angles: impl Iterator<Item = f64>) -> usize {
    let (mut count, mut rising, mut extreme) = (0, false, f64::INFINITY);
    for angle in angles {
        extreme = if rising {
            extreme.max(angle)
        } else {
            extreme.min(angle)
        };
        if rising && angle <= extreme - PROMINENCE_DEG {
            (count, rising, extreme) = (count + 1, false, angle);
        } else if !rising && angle >= extreme + PROMINENCE_DEG {
            (rising, extreme) = (true, angle);
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::peaks;

    #[test]
    fn peaks_are_counted_by_the_dips_between_them() {
        let wave = |depth: f64| {
            (0..1000).map(move |n| {
                let t = f64::from(n) / 1000.0 * core::f64::consts::TAU;
                100.0 - 30.0 * t.cos() - depth * (2.0 * t).cos()
            })
        };
        assert_eq!(peaks(wave(0.0)), 1);
        // Maxima at cos t = −30/(4 depth), the dip at t = π between them is
        // (4 depth − 30)²/(8 depth): 0.24 degrees for 8.5, 3.4 for 12.
        assert_eq!(peaks(wave(8.5)), 1);
        assert_eq!(peaks(wave(12.0)), 2);
    }
}
