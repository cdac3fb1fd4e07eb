//! The reference page says what the reader does.

use scene::{Scene, reference};

#[test]
fn the_example_on_the_page_is_a_scene() {
    let page = reference();
    let (_, rest) = page.split_once("```toml\n").expect("an example begins");
    let (example, _) = rest.split_once("```\n").expect("and ends");
    let scene = Scene::from_str("docs", example).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(scene.name, "example");
    assert_eq!(scene.motor.map(|motor| motor.kp), Some(0.04));
}

#[test]
fn rows_tell_type_range_unit_and_default() {
    let page = reference();
    for row in [
        "| `tick_hz` | a whole number from 200 to 20000 | Hz | an error | \
         Control and sampling rate. |",
        "| `sides` | \"both\" or \"left\" |  | `\"both\"` | ",
        "| `kd` | a number from 0 to 1 | duty per degree/s | `0.0004` | ",
        "| `threshold` | a number above 0 and below 1 |  | \
         an error if `rule = \"sequential\"` without `cost_error`; else not used | ",
        "| `contact_min` | a number from 0 to 1 |  | \
         the gate of the model; without one every sample is classified | ",
    ] {
        assert!(page.contains(row), "{row}");
    }
}

#[test]
fn every_allowed_key_has_a_row() {
    let page = reference();
    let sections: Vec<&str> = page.split("\n## `[").skip(1).collect();
    assert_eq!(sections.len(), 9);
    for section in sections {
        let (section, rows) = section.split_once("]`").expect("a heading");
        let text = format!("[{section}]\nqqq = 1\n");
        let problems = Scene::from_str("s.toml", &text).expect_err("no such key");
        let unknown = format!("{section}.qqq");
        let problem = problems.as_slice().iter().find(|p| p.key == unknown);
        let allowed = &problem.expect("it is reported").allowed;
        let keys = allowed.strip_prefix("allowed here: ");
        let rows = rows.lines();
        let row_keys: Vec<&str> = rows
            .filter_map(|line| line.strip_prefix("| `")?.split('`').next())
            .collect();
        assert_eq!(keys, Some(row_keys.join(", ").as_str()));
    }
}
