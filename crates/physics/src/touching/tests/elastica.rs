//! Slowly pushed whiskers against exact elasticas.

use super::{QUIET, flat};
use crate::{Biotact, Facing, Plate, Pose, Shaft, TouchingWhisker};

/// Base moment and normal force (N m, N), and place of the contact over the length, at each
/// push, degrees.
fn pushed(shaft: &Shaft, slant_deg: f64, pushes: &[f64], dt_s: f64) -> Vec<[f64; 3]> {
    let facing = Facing {
        slant_deg,
        tilt_deg: 0.0,
        elevation_deg: 0.0,
    };
    let plate = Plate::in_the_way(1.0, shaft.length_m, &facing, flat(1e7, 1.0, 0.0, 0.0));
    let mut whisker = TouchingWhisker::new(shaft, &QUIET, 1).unwrap();
    let mut push: f64 = -0.5;
    let mut found = Vec::new();
    for &to in pushes {
        let steps = ((to - push) / (20.0 * dt_s)).ceil();
        let step = (to - push) / steps;
        for _ in 0..steps as usize {
            push += step;
            whisker.step(&Pose::swung(1.0 + push.to_radians()), Some(&plate), dt_s);
        }
        push = to;
        for _ in 0..(0.5 / dt_s) as usize {
            whisker.step(&Pose::swung(1.0 + push.to_radians()), Some(&plate), dt_s);
        }
        for _ in 0..6 {
            whisker.step(&Pose::swung(1.0 + push.to_radians()), Some(&plate), dt_s);
            println!("   {:?} {:?} {:?} {:e} {:?}", whisker.rotation_rad(), whisker.force_n(), whisker.contact_at(), whisker.energy_j(), whisker.lowered_m());
        }
        let moment = shaft.follicle.rotation_n_m_rad * whisker.rotation_rad()[0];
        let place = whisker.contact_at().map_or(0.0, |at| at.arc_m) / shaft.length_m;
        found.push([moment, whisker.force_n()[0], place]);
    }
    found
}

#[test]
fn study() {
    let shaft = Shaft::biotact(Biotact::Middle);
    let pushes = [2.0, 5.0, 8.0, 10.0, 15.0, 20.0, 30.0, 45.0];
    let truth = [
        [2.015674e-04, 2.080657e-03, 1.0],
        [4.777587e-04, 4.962795e-03, 1.0],
        [7.389826e-04, 7.778683e-03, 9.982613e-01],
        [9.864319e-04, 1.070415e-02, 9.787129e-01],
        [1.730742e-03, 2.024261e-02, 9.341377e-01],
        [2.628457e-03, 3.309949e-02, 8.948929e-01],
        [4.754295e-03, 6.936061e-02, 8.292792e-01],
        [8.270649e-03, 1.518335e-01, 7.551050e-01],
    ];
    for (push, (found, truth)) in pushes.iter().zip(pushed(&shaft, 30.0, &pushes, 5e-4).iter().zip(truth)) {
        let err = [0, 1].map(|i| 100.0 * (found[i] / truth[i] - 1.0));
        println!("{push} {err:.4?} place {:.4} {:.4}", found[2], truth[2]);
    }
    panic!();
}
