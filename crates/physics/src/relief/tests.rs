//! Heights: spread, slopes, memory, and what a round tip leaves of them.

use super::Relief;
use crate::{Material, Surface};

const ROUGH: Surface = Surface {
    height_m: 1e-3,
    grain_m: 5e-3,
    stiffness_n_m: 1e5,
    damping: 0.3,
    hold: 0.5,
    friction: 0.4,
    seed: 3,
};

fn places() -> impl Iterator<Item = [f64; 2]> {
    (0..400).flat_map(|i| (0..400).map(move |j| [f64::from(i) * 2.3e-3, f64::from(j) * 1.7e-3]))
}

#[test]
fn spread_is_that_of_the_surface_and_top_is_never_passed() {
    let mut relief = Relief::new(&ROUGH, 1e-6);
    let (mut sum, mut square, mut top) = (0.0, 0.0, 0.0_f64);
    for place in places() {
        let height = relief.at(place)[0];
        sum += height / 160e3;
        square += height * height / 160e3;
        top = top.max(height.abs());
    }
    assert!((square.sqrt() / 1e-3 - 1.0).abs() < 0.02, "{square}");
    assert!(sum.abs() < 3e-5, "{sum}");
    let share = top / relief.top_m;
    assert!((0.7..1.0).contains(&share), "{share}");
}

#[test]
fn slopes_are_those_of_the_heights() {
    let mut relief = Relief::new(&ROUGH, 1e-6);
    let d = 1e-8;
    for place in places().step_by(997) {
        let [_, x, y] = relief.at([place[0] + 1e-4, place[1] - 3e-4]);
        let mut height =
            |dx: f64, dy: f64| relief.at([place[0] + 1e-4 + dx, place[1] - 3e-4 + dy])[0];
        assert!((x - (height(d, 0.0) - height(-d, 0.0)) / (2.0 * d)).abs() < 1e-4);
        assert!((y - (height(0.0, d) - height(0.0, -d)) / (2.0 * d)).abs() < 1e-4);
    }
}

#[test]
fn a_blunt_tip_does_not_feel_fine_grains() {
    // Tip 10 mm, h 1 mm: ℓ² = 80 mm², n = 3.2; the second octave's arcs are
    // 4.47 mm long.
    let mut blunt = Relief::new(&ROUGH, 1e-2);
    let square: f64 = places().map(|p| blunt.at(p)[0].powi(2) / 160e3).sum();
    let first = 1e-3 / (1.0 + 2.0 * 3.2_f64.ln()).sqrt() / 1.3125_f64.sqrt();
    let second: f64 = 0.3 * 20e-6 / 80e-3;
    assert!((square.sqrt() / first.hypot(second) - 1.0).abs() < 0.02);
    assert!((blunt.finest_m / 20e-6_f64.sqrt() - 1.0).abs() < 1e-9);
    let mut flat = Relief::new(&Surface::of(Material::Flat), 1e-3);
    assert_eq!(flat.at([0.1, 0.2]), [0.0; 3]);
    assert_eq!((flat.top_m, flat.finest_m), (0.0, f64::INFINITY));
}

#[test]
fn a_height_does_not_depend_on_where_the_last_place_was() {
    let mut travelled = Relief::new(&ROUGH, 1e-6);
    for n in 0..2000 {
        // Within a cell, into the next, far away, and onto lattice points.
        let step = [1e-6, 1e-3, 0.7, 5e-3][n % 4] * (n % 7) as f64;
        let place = [step - 0.01, 0.3 - 2.0 * step];
        assert_eq!(travelled.at(place), Relief::new(&ROUGH, 1e-6).at(place));
    }
}
