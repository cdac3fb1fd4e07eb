//! Keeping to the middle of a corridor by the vibrissae alone (PSIK section
//! 3.3.1): distance from the arcs' deflections, steering from the distances.

/// Vibrissae of a pad (PSIK Table 1).
pub const VIBRISSAE: usize = 33;

/// Vibrissae of each arc, from the rearmost and longest (PSIK Table 1).
pub const ARC_SIZES: [usize; 8] = [5, 5, 5, 5, 5, 3, 3, 2];

/// Length of each arc's vibrissae, mm (PSIK Table 1, robot).
pub const ARC_LENGTHS_MM: [f32; 8] = [250.0, 200.0, 150.0, 120.0, 100.0, 90.0, 70.0, 55.0];

/// G of PSIK eq. 2.
pub const STEERING_GAIN: f32 = 0.01;

/// V_i: the mean of each arc over the values of a pad, which stand arc by arc.
#[inline]
pub fn arc_means(pad: &[f32; VIBRISSAE]) -> [f32; 8] {
    let mut rest = pad.as_slice();
    ARC_SIZES.map(|size| {
        // The sizes add up to the vibrissae.
        let (arc, after) = rest.split_at_checked(size).unwrap_or((rest, &[]));
        rest = after;
        arc.iter().sum::<f32>() / size as f32
    })
}

/// The distance of what a pad touches, D = (1/N) Σ_i (1 − V_i) L_i (PSIK eq. 1).
///
/// `deflections` V_i: mean deflection of each arc as part of the largest, 0 to
/// 1; values outside are limited to that, and NaN counts as 0. `lengths` L_i in
/// any unit, which is that of D. Falls as vibrissae bend: from the mean length,
/// where none does, to nought. Of no arcs it is nought.
#[inline]
pub fn distance<const N: usize>(deflections: &[f32; N], lengths: &[f32; N]) -> f32 {
    if N == 0 {
        return 0.0;
    }
    let arcs = deflections.iter().zip(lengths);
    #[allow(clippy::manual_clamp, reason = "these two turn NaN into a number")]
    let sum: f32 = arcs.map(|(&v, l)| (1.0 - v.max(0.0).min(1.0)) * l).sum();
    sum / N as f32
}

/// The robot's turning, V_y = (D_left − D_right) · G (PSIK eq. 2), with the
/// distances in mm and [`STEERING_GAIN`]: positive turns to the left, where
/// there is more room.
#[inline]
pub fn steering(left: f32, right: f32, gain: f32) -> f32 {
    (left - right) * gain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_take_their_vibrissae_and_no_others() {
        assert_eq!(ARC_SIZES.iter().sum::<usize>(), VIBRISSAE);
        let mut pad = [0.0; VIBRISSAE];
        // Arc 6 is vibrissae 25 to 27, arc 8 the last two.
        pad[24] = 100.0;
        pad[25] = 3.0;
        pad[27] = 6.0;
        pad[32] = 1.0;
        let means = arc_means(&pad);
        assert_eq!(means, [0.0, 0.0, 0.0, 0.0, 20.0, 3.0, 0.0, 0.5]);
    }

    #[test]
    fn distance_is_the_paper_s() {
        assert_eq!(distance(&[0.0; 8], &ARC_LENGTHS_MM), 1035.0 / 8.0);
        assert_eq!(distance(&[1.0; 8], &ARC_LENGTHS_MM), 0.0);
        // (0.75 · 250 + 0.5 · 200) / 2.
        assert_eq!(distance(&[0.25, 0.5], &[250.0, 200.0]), 143.75);
        assert_eq!(distance(&[], &[]), 0.0);
        let odd = [f32::NAN, 7.0, -7.0, f32::NEG_INFINITY];
        assert_eq!(distance(&odd, &[8.0, 4.0, 2.0, 6.0]), 4.0);
    }

    #[test]
    fn it_turns_to_where_there_is_room() {
        assert!((steering(120.0, 100.0, STEERING_GAIN) - 0.2).abs() < 1e-7);
        assert!(steering(90.0, 100.0, STEERING_GAIN) < 0.0);
    }
}
