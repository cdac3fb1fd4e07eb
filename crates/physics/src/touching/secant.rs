//! Slopes between two places of the ground.

/// Distances below this have no direction, m: heights are rounded.
const NO_WAY_M: f64 = 1e-12;

/// Slopes of a plane through the ground (height, slopes) at two places: the mean
/// of the slopes there, corrected along the line between them (the mean-value discrete gradient
/// of Gonzalez 1996), so that slopes · distance is the difference of the heights.
#[inline]
pub(super) fn secant(from: [f64; 2], start: [f64; 3], to: [f64; 2], end: [f64; 3]) -> [f64; 2] {
    let way = [to[0] - from[0], to[1] - from[1]];
    let mean = [0.5 * start[1] + 0.5 * end[1], 0.5 * start[2] + 0.5 * end[2]];
    let square = way[0] * way[0] + way[1] * way[1];
    if square < NO_WAY_M * NO_WAY_M {
        return mean;
    }
    let missed = (end[0] - start[0] - mean[0] * way[0] - mean[1] * way[1]) / square;
    [mean[0] + missed * way[0], mean[1] + missed * way[1]]
}
