//! Whiskers pushed around a round bar, against exact elasticas, which another program solved
//! (`tests/truth/bar.py`), and swept past the end of a plate.

use super::elastica::{Pushed, same, table};
use super::{flat, slanted};
use crate::{Biotact, Facing, Outline, Plate, Shaft};

#[test]
fn around_a_bar_moments_forces_and_places_are_those_of_elasticas_until_it_lets_go() {
    let rows = table(include_str!("../../../../../tests/truth/bar.csv"));
    let mut let_go = 0;
    for case in rows.chunk_by(same) {
        let first = &case[0];
        let shaft = first.shaft();
        let friction = first.get("friction");
        let ground = flat(1e6, 1.0, friction, friction);
        let plate = Plate {
            outline: Outline::bar(first.get("radius_m")),
            ..Plate::in_the_way(1.0, first.get("reach_m"), &slanted(0.0), ground)
        };
        let mut pushed = Pushed::new(&shaft, plate);
        for row in case {
            let push_deg = row.get("push_deg");
            if row.get("moment_nm") == 0.0 {
                // There is no such shape any more.
                pushed.to(push_deg - 0.5);
                assert!(pushed.whisker.contact(), "{:?}", row.0);
                pushed.to(push_deg + 1.0);
                assert!(!pushed.whisker.contact(), "{:?}", row.0);
                let_go += 1;
                continue;
            }
            pushed.to(push_deg);
            let whisker = &pushed.whisker;
            let moment = whisker.rotation_rad()[0] * shaft.follicle.rotation_n_m_rad;
            let place = whisker.contact_at().map_or(0.0, |at| at.arc_m);
            let found = [moment, whisker.force_n()[0], place];
            row.check("moment_nm", found, [0.01, 0.01, 0.002]);
        }
    }
    assert_eq!(let_go, 8);
}

#[test]
fn a_thick_enough_plate_is_felt_as_an_endless_one_up_to_its_end() {
    let shaft = Shaft::biotact(Biotact::Middle);
    let plate = Plate::in_the_way(
        1.0,
        shaft.length_m,
        &Facing::USUAL,
        flat(1e5, 0.3, 0.4, 0.4),
    );
    let ends = Plate {
        outline: Outline::edge(0.02, 0.005),
        ..plate
    };
    let [mut endless, mut ending] = [plate, ends].map(|plate| Pushed::new(&shaft, plate));
    for push_deg in 1..=20 {
        endless.to(f64::from(push_deg));
        ending.to(f64::from(push_deg));
        let [a, b] = [&endless, &ending].map(|pushed| pushed.whisker.force_n()[0]);
        // Steps are cut otherwise before a round end.
        assert!((a / b - 1.0).abs() < 1e-2, "{push_deg}: {a} {b}");
    }
}

#[test]
fn a_shaft_that_is_drawn_over_the_end_of_a_plate_flicks_off_as_from_a_bar_and_rings() {
    let shaft = Shaft::biotact(Biotact::Middle);
    let ground = flat(1e5, 0.3, 0.2, 0.2);
    let (reach_m, radius_m) = (0.9 * shaft.length_m, 1e-3);
    let bar = Plate {
        outline: Outline::bar(radius_m),
        ..Plate::in_the_way(1.0, reach_m, &slanted(0.0), ground)
    };
    // Its flat part begins there and goes on beyond the tip.
    let begins = Plate {
        outline: Outline {
            flat_m: [reach_m - shaft.length_m, f64::INFINITY],
            radius_m,
        },
        ..Plate::in_the_way(1.0, shaft.length_m, &slanted(0.0), ground)
    };
    let [mut round, mut ending] = [bar, begins].map(|plate| Pushed::new(&shaft, plate));
    let turned = |pushed: &Pushed| pushed.whisker.rotation_rad()[0];
    let mut push_deg = 2.0;
    loop {
        round.to(push_deg);
        ending.to(push_deg);
        let [a, b] = [&round, &ending].map(|pushed| pushed.whisker.contact());
        assert_eq!(a, b, "{push_deg}");
        if !a {
            break;
        }
        let (a, b) = (turned(&round), turned(&ending));
        assert!(a > 0.0 && (b / a - 1.0).abs() < 1e-3, "{push_deg} {a} {b}");
        push_deg += 0.1;
    }
    // Once free it swings through to the other side, and does not touch from below.
    let mut least = f64::INFINITY;
    for tick in 1..=40 {
        ending.to(push_deg + 0.0025 * f64::from(tick));
        assert!(!ending.whisker.contact(), "{tick}");
        least = least.min(turned(&ending));
    }
    assert!(least < -1e-4, "{least}");
}
