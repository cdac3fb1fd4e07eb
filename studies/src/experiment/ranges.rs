//! How far a rig's signals fill the range of their sensors.

use super::{Dataset, Recordings, Request, of_set};
use crate::page::{Page, figure};

/// Says of a data set whose first `channels` columns are x, y, x, y, … in codes up to `most`.
pub(super) fn say(
    page: &mut Page,
    (request, recordings): (&Request, &Recordings),
    (dataset, channels): (Dataset, usize),
    most: f32,
) {
    let all = of_set(recordings, dataset);
    if !request.is_whole || all.iter().all(|one| one.values.is_empty()) {
        return;
    }
    let of_axis = |axis: usize| {
        let mut codes = Vec::new();
        for recording in &all {
            for sample in recording.values.chunks_exact(recording.channels.max(1)) {
                let axis = sample.iter().take(channels).skip(axis).step_by(2);
                codes.extend(axis.map(|code| code.abs()));
            }
        }
        let clipped = codes.iter().filter(|code| **code >= most).count();
        let clipped = 100.0 * clipped as f64 / codes.len().max(1) as f64;
        let place = (0.999 * codes.len() as f64) as usize;
        let place = place.min(codes.len().saturating_sub(1));
        let nearly_all = codes.select_nth_unstable_by(place, f32::total_cmp).1;
        let reach = f64::from(100.0 * *nearly_all / most);
        (figure(clipped, 2), figure(reach, 0))
    };
    let [(clipped_x, reach_x), (clipped_y, reach_y)] = [0, 1].map(of_axis);
    page.is_alone = true;
    page.say(format_args!(
        "**Range**: {clipped_x} % of all readings of x and {clipped_y} % of y are clipped; 99.9 % \
         are within {reach_x} % of the range of x and {reach_y} % of that of y."
    ));
    page.is_alone = false;
}
