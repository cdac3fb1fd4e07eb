//! How plates stand to elastic whiskers, by a scene's keys.

use crate::played::{Played, scene, textured, undisturbed};

/// Four whisks against a smooth plate, with more keys of `[plant]`.
fn against(keys: &str) -> Played {
    let plant = textured(100.0).replace("\"textured\"", "\"whisker\"") + keys;
    undisturbed(&scene(1, &plant, ""), 2000)
}

/// Sums of |x| and of y over the left first whisker's rows, codes from mid-scale.
fn pushed(played: &Played) -> [f64; 2] {
    let rows = played.rows.iter();
    rows.fold([0.0; 2], |[x, y], row| {
        [x + (row.x[0] - 8192.0).abs(), y + (row.y[0] - 8192.0)]
    })
}

/// Without keys it stands as usual, at 20 degrees.
#[test]
fn a_plate_pushes_y_the_way_it_is_tilted() {
    let of = |tilt_deg: i32| pushed(&against(&format!("tilt_deg = {tilt_deg}\n")));
    assert_eq!(pushed(&against("")), of(20));
    let ([x, up], [_, level], [_, down]) = (of(20), of(0), of(-20));
    assert!(up.abs() > 0.05 * x, "{up} of {x}");
    assert!(level.abs() < 0.1 * up.abs(), "{level} of {up}");
    assert!((up + down).abs() < 0.2 * up.abs(), "{up}, {down}");
}
