//! A pressed whisker against an independent elastica: `tests/truth/elastica.py` says how it was
//! solved.

use std::collections::BTreeMap;

use crate::common::project;
use host_sim::pressing::Pressing;

/// A row by the names of its columns.
type Row = BTreeMap<String, f64>;

fn rows(file: &str) -> Vec<Row> {
    let path = project(&format!("tests/truth/{file}"));
    let mut table = csv::Reader::from_path(path).unwrap();
    table.deserialize().map(|row| row.unwrap()).collect()
}

/// Whether a row's friction has the direction in which `press` has it. Some are also solved with
/// friction against the slide that there would be without any, which differs where friction can
/// hold a tip on its tilted plate: its part across the plane of whisking then is −tan tilt.
fn is_as_in_press(row: &Row) -> bool {
    let [slant, tilt] = ["slant_deg", "tilt_deg"].map(|name| row[name].to_radians());
    let across = (tilt.cos() * slant.cos()).hypot(tilt.sin());
    let holds = tilt.tan() * across <= row["friction"] * slant.cos();
    let Some(found) = row.get("friction_across") else {
        return true;
    };
    !holds || (found + tilt.tan()).abs() < 1e-6
}

fn check(row: &Row) {
    let pressing = Pressing {
        shaft: None,
        length_m: Some(row["length_m"]),
        hub_m: Some(row["hub_m"]),
        taper: Some(row["taper"]),
        youngs_pa: Some(row["youngs_pa"]),
        follicle_nm_rad: Some(row["follicle_nm_rad"]),
        slant_deg: row["slant_deg"],
        tilt_deg: row["tilt_deg"],
        friction: row["friction"],
        push_deg: vec![row["push_deg"]],
    };
    let pressed = pressing.press();
    let found = &pressed.unwrap_or_else(|refused| panic!("{row:?}: {refused}"))[0];
    let near = |found: f64, expected: f64, bound: f64| {
        assert!((found - expected).abs() <= bound, "{row:?}: {found}");
    };
    let [x, y] = found.moment_n_m;
    let of = |name: &str, without: f64| row.get(name).copied().unwrap_or(without);
    // A table without tilt has the moment as a whole.
    let moments = [
        of("moment_x_nm", of("moment_nm", 0.0)),
        of("moment_y_nm", 0.0),
    ];
    let scale = moments[0].hypot(moments[1]);
    near(x, moments[0], 1e-6 * scale);
    near(y, moments[1], 1e-6 * scale);
    near(found.normal_n, row["normal_n"], 1e-6 * row["normal_n"]);
    near(found.friction_n, row["friction_n"], 1e-6 * row["normal_n"]);
    near(found.contact_m, row["contact_m"], 1e-6 * row["length_m"]);
    near(found.place_m, row["place_m"], 1e-6 * row["length_m"]);
}

#[test]
fn a_pressed_whisker_bends_as_another_solution_of_the_elastica_has_it() {
    let planar = rows("press.csv");
    assert_eq!(planar.len(), 244);
    planar.iter().for_each(check);
    let tilted = rows("tilt.csv");
    let same: Vec<&Row> = tilted.iter().filter(|row| is_as_in_press(row)).collect();
    assert_eq!((tilted.len(), same.len()), (45, 35));
    same.into_iter().for_each(check);
}
