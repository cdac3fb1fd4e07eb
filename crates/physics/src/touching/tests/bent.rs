//! The points of a bent shaft, and that of its contact.

use super::{QUIET, flat, robot};
use crate::pose::PlateFrame;
use crate::vector::{length, sub};
use crate::{Bent, Biotact, Facing, Plate, Shaft, TouchingWhisker};

#[test]
fn a_whisker_in_the_air_is_straight_and_touches_nothing() {
    let length_m = Shaft::floor_robot().length_m;
    let points = robot().bent().points_m;
    let straight = Bent::straight(length_m).points_m;
    for (found, expected) in points.iter().zip(straight) {
        assert!(length(sub(*found, expected)) < 1e-15, "{found:?}");
    }
    assert_eq!(robot().bent().contacts, [None; 2]);
}

#[test]
fn points_are_as_far_apart_as_on_the_straight_shaft_and_contact_is_between_them_on_the_plate() {
    let shaft = Shaft::biotact(Biotact::Middle);
    let facing = Facing::USUAL;
    let plate = Plate::in_the_way(1.0, shaft.length_m, &facing, flat(1e6, 1.0, 0.3, 0.3));
    let mut whisker = TouchingWhisker::new(&shaft, &QUIET, 1).unwrap();
    let mut pose = facing.pose(1.0);
    for tick in 0..=4000 {
        pose = facing.pose(1.0 + 15.0_f64.to_radians() * f64::from(tick) / 4000.0);
        whisker.step(&pose, Some(&plate), 5e-4);
    }
    let bent = whisker.bent();
    let at = bent.contacts[0].unwrap();
    assert!(at.arc_m < 0.97 * shaft.length_m, "{at:?}");

    // Up to a place between nodes the tangent is integrated as a parabola.
    let inexact_m = 1e-6;
    let step_m = shaft.length_m / 12.0;
    for pair in bent.points_m.windows(2) {
        let chord_m = length(sub(pair[1], pair[0]));
        assert!(
            chord_m < step_m + inexact_m && chord_m > 0.99 * step_m,
            "{chord_m}"
        );
    }
    for (n, point) in bent.points_m.iter().enumerate() {
        let arc_m = (at.arc_m - step_m * n as f64).abs();
        let chord_m = length(sub(*point, at.point_m));
        assert!(chord_m < arc_m + inexact_m, "{n}: {chord_m} {arc_m}");
        assert!(arc_m > step_m || chord_m > 0.99 * arc_m, "{n}: {chord_m}");
    }

    // The springs of follicle and ground are stretched by micrometres.
    let [along, across, above] = PlateFrame::new(&plate).see(&pose).place(at.point_m);
    let off = [along - at.plate_m[0], across - at.plate_m[1], above];
    assert!(length(off) < 5e-6, "{off:?}");
}
