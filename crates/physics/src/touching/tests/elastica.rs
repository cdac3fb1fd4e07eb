//! Slowly pushed whiskers against exact elasticas, which another program solved
//! (`tests/truth/elastica.py`).

use super::{QUIET, flat, slanted};
use crate::elastica::Press;
use crate::vector::{add, dot, scale, sub};
use crate::{Biotact, Facing, Follicle, Plate, Pose, Shaft, TOUCHING_TAPER, TouchingWhisker};

/// One line of a table, its numbers by the names of their columns.
pub(super) struct Row(pub(super) Vec<(&'static str, f64)>);

impl Row {
    pub(super) fn get(&self, name: &str) -> f64 {
        let found = self.0.iter().find(|(column, _)| *column == name);
        found.unwrap_or_else(|| panic!("{name}")).1
    }

    /// Sees that a base moment, a normal force and a place are as they should be, but for shares of
    /// the moment, of the force and of the length that are allowed.
    pub(super) fn check(&self, moment: &str, found: [f64; 3], allowed: [f64; 3]) {
        let [of_moment, normal, place] = found;
        let errors = [
            of_moment / self.get(moment) - 1.0,
            normal / self.get("normal_n") - 1.0,
            (place - self.get("contact_m")) / self.get("length_m"),
        ];
        for (error, allowed) in errors.into_iter().zip(allowed) {
            assert!(error.abs() < allowed, "{errors:?} {:?}", self.0);
        }
    }

    pub(super) fn shaft(&self) -> Shaft {
        let hub_diameter_m = self.get("hub_m");
        Shaft {
            length_m: self.get("length_m"),
            hub_diameter_m,
            tip_diameter_m: hub_diameter_m / self.get("taper"),
            youngs_pa: self.get("youngs_pa"),
            density_kg_m3: 1200.0,
            damping: 0.1,
            follicle: Follicle {
                rotation_n_m_rad: self.get("follicle_nm_rad"),
                axial_n_m: 1e9,
            },
        }
    }
}

pub(super) fn table(text: &'static str) -> Vec<Row> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &'static str| {
        let numbers = line.split(',').map(|cell| cell.parse().unwrap());
        Row(names.iter().copied().zip(numbers).collect())
    };
    lines.map(row).collect()
}

/// What is pushed: the columns before the push.
pub(super) fn same(a: &Row, b: &Row) -> bool {
    let given = |row: &Row| -> Vec<f64> { row.0.iter().take(8).map(|cell| cell.1).collect() };
    given(a) == given(b)
}

/// A whisker that is pushed by 5° a second, from 1° before it touches on.
pub(super) struct Pushed {
    pub(super) whisker: TouchingWhisker,
    plate: Plate,
    tick: u32,
}

impl Pushed {
    pub(super) fn new(shaft: &Shaft, plate: Plate) -> Self {
        Self {
            whisker: TouchingWhisker::new(shaft, &QUIET, 1).unwrap(),
            plate,
            tick: 0,
        }
    }

    pub(super) fn to(&mut self, push_deg: f64) {
        while f64::from(self.tick) * 0.0025 < 1.0 + push_deg {
            let push = (f64::from(self.tick) * 0.0025 - 1.0).to_radians();
            self.whisker
                .step(&Pose::swung(1.0 + push), Some(&self.plate), 5e-4);
            self.tick += 1;
        }
    }
}

/// Base moments in and across the plane of whisking (N m), normal force (N) and place of
/// the contact (m) at each push of a case.
fn pushed(case: &[Row]) -> Vec<[f64; 4]> {
    let first = &case[0];
    let shaft = first.shaft();
    let length_m = shaft.length_m;
    let facing = Facing {
        tilt_deg: first.get("tilt_deg"),
        ..slanted(first.get("slant_deg"))
    };
    let friction = first.get("friction");
    let ground = flat(1e6, 1.0, friction, friction);
    let plate = Plate::in_the_way(1.0, length_m, &facing, ground);
    let mut pushed = Pushed::new(&shaft, plate);
    let mut until = |push_deg: f64| {
        pushed.to(push_deg);
        let whisker = &pushed.whisker;
        let pose = Pose::swung(1.0 + push_deg.to_radians());
        for [x, y, z] in whisker.bent().points_m {
            let along = add(add(scale(x, pose.x), y, pose.y), z, pose.z());
            let at = sub(add(pose.base_m, 1.0, along), plate.point_m);
            let above = dot(at, plate.normal);
            let is_before = above > -0.005 * length_m;
            assert!(is_before, "{push_deg} {above} {:?}", first.0);
        }
        let [x, y] = whisker
            .rotation_rad()
            .map(|turned| turned * shaft.follicle.rotation_n_m_rad);
        let at_m = whisker.contact_at().map_or(0.0, |at| at.arc_m);
        [x, y, whisker.force_n()[0], at_m]
    };
    case.iter().map(|row| until(row.get("push_deg"))).collect()
}

#[test]
fn pushed_whiskers_have_the_moments_forces_and_places_of_elasticas() {
    let rows = table(include_str!("../../../../../tests/truth/press.csv"));
    for case in rows.chunk_by(same) {
        for (row, [moment, _, normal, place]) in case.iter().zip(pushed(case)) {
            // A shape that gives way sideways has another solution.
            if row.get("sideways") != 0.0 {
                let found = [moment.abs(), normal, place];
                row.check("moment_nm", found, [0.015, 0.015, 0.005]);
            }
        }
    }
}

/// By how much the base moment of a whisker that tapers so, pushed on a slippery plate, lies off that
/// of [`Press`], whose right values are another solver's.
fn moment_off(taper: f64, slant_deg: f64, push_deg: f64) -> f64 {
    let middle = Shaft::biotact(Biotact::Middle);
    let shaft = Shaft {
        tip_diameter_m: middle.hub_diameter_m / taper,
        ..middle
    };
    let press = Press {
        shaft,
        slant_deg,
        tilt_deg: 0.0,
        friction: 0.0,
    };
    let truth = press.at(&[push_deg]).unwrap()[0].moment_n_m[0];
    let slippery = flat(1e6, 1.0, 0.0, 0.0);
    let plate = Plate::in_the_way(1.0, shaft.length_m, &slanted(slant_deg), slippery);
    let mut pushed = Pushed::new(&shaft, plate);
    pushed.to(push_deg);
    let [turned, _] = pushed.whisker.rotation_rad();
    (turned * shaft.follicle.rotation_n_m_rad / truth).abs() - 1.0
}

/// What scenes warn of, and what they do not.
#[test]
fn up_to_its_bound_a_tapered_tip_bends_as_it_should() {
    for slant_deg in [20.0, 45.0] {
        for push_deg in [5.0, 10.0, 19.0] {
            let off = moment_off(TOUCHING_TAPER, slant_deg, push_deg);
            assert!(off.abs() < 0.02, "{slant_deg} {push_deg}: {off}");
        }
    }
    let off = moment_off(45.0, 30.0, 10.0);
    assert!((-1.0..-0.5).contains(&off), "a reason to warn: {off}");
}

#[test]
fn on_a_tilted_plate_both_moments_are_those_of_an_elastica() {
    let rows = table(include_str!("../../../../../tests/truth/tilt.csv"));
    let smooth = |case: &&[Row]| case[0].get("friction") == 0.0;
    for case in rows.chunk_by(same).filter(smooth) {
        for (row, [x, y, normal, place]) in case.iter().zip(pushed(case)) {
            for (name, moment) in [("moment_x_nm", x), ("moment_y_nm", y)] {
                row.check(name, [moment.abs(), normal, place], [0.005; 3]);
            }
        }
    }
}
