//! What a file may say.

use std::path::Path;

use scene::Scene;

use super::{Scenario, What};

const BENCH: &str = include_str!("../../../../scenes/bench.toml");
const CIA: &str = include_str!("../../../../scenes/cia.toml");

fn refused(text: &str) -> String {
    Scenario::parse(text).unwrap_err()
}

#[test]
fn an_event_is_read_with_its_times_side_and_value() {
    let text = "duration_s = 2.5
        [[event]]
        at_s = 1.0
        kind = 'hand'
        torque_nm = -0.002
        for_s = 0.5
        side = 'right'
        [[event]]
        at_s = 0.5
        kind = 'button'";
    let scenario = Scenario::parse(text).unwrap();
    assert_eq!(scenario.duration_s, Some(2.5));
    let [button, hand] = &scenario.events[..] else {
        panic!("two events");
    };
    assert_eq!((&button.what, button.until_s), (&What::Button, Some(0.6)));
    assert_eq!(hand.what, What::Hand { torque_nm: -0.002 });
    assert_eq!((hand.side, hand.until_s), (1, Some(1.5)));
    assert!(!hand.lasts(0.9995) && hand.lasts(1.0) && hand.lasts(1.4995) && !hand.lasts(1.5));
}

#[test]
fn what_befalls_what_a_scene_lacks_is_refused() {
    let with = |scene: &str, keys: &str| {
        let (table, _) = keys.split_once('\n').unwrap();
        Scene::from_str("s.toml", &scene.replace(table, keys)).unwrap()
    };
    let own = Scene::from_str("bench.toml", BENCH).unwrap();
    let other = with(BENCH, "[sensor]\nmodel = 'tmag5170'");
    let head = with(CIA, "[head]\nnodes = 2");
    let other_sensor = "an event of an MLX90333";
    for (kind, fits, lacks, why) in [
        ("sensor-part", &own, &other, other_sensor),
        ("sensor-unpowered", &own, &other, other_sensor),
        ("select-stuck", &own, &other, other_sensor),
        ("bus-cut", &head, &own, "head.nodes"),
        ("power-off'\nnode = 1\n#'", &head, &own, "node"),
        ("held", &own, &head, "no board of a head"),
        (
            "serial'\ntext = 'stop'\nrepeat_hz = 2.0\n#'",
            &own,
            &head,
            "repeat_hz",
        ),
    ] {
        let event = format!("[[event]]\nat_s = 0.0\nkind = '{kind}'");
        let event = Scenario::parse(&event).unwrap();
        let path = Path::new("befalls.toml");
        assert!(event.fits(path, fits).is_ok(), "{kind}");
        let refused = event.fits(path, lacks).unwrap_err().to_string();
        assert!(refused.contains(why), "{refused}");
    }
}

/// As one that ends while another of its kind lasts does not end that.
#[test]
fn what_befalls_a_board_of_a_head_goes_on_with_the_last() {
    let of = |kind: &str, node, at_s, for_s| {
        format!("[[event]]\nkind = '{kind}'\nnode = {node}\nat_s = {at_s:?}\nfor_s = {for_s:?}\n")
    };
    let text = [
        of("power-off", 1, 1.0, 0.5),
        of("power-off", 1, 1.2, 1.8),
        of("power-off", 0, 1.2, 1.8),
        of("bus-cut", 1, 1.2, 1.8),
    ];
    let events = Scenario::parse(&text.concat()).unwrap().events;
    let goes_on = |t_s| {
        let others = events.iter().map(|other| other.goes_on(&events[0], t_s));
        others.collect::<Vec<_>>()
    };
    assert_eq!(goes_on(1.5), [false, true, false, false]);
    assert_eq!(goes_on(1.0), [false; 4]);
    assert!(!events[0].goes_on(&events[1], 3.0));
}

/// Kind and keys of an event, and what is said of it.
const WRONG: &str = "
    encoder-stock  |                                | encoder-stock
    encoder-stuck  | count = 3                      | count
    encoder-stuck  | counts = 3                     | event 1 (encoder-stuck): counts:
    button         | repeat_hz = 3.0                | event 1 (button): repeat_hz:
    sensor-part    | reports = 3                    | event 1 (sensor-part): reports:
    encoder-jitter |                                | missing field `counts`
    encoder-slip   | share = 1.5                    | share: found 1.5, allowed: 0 to 1
    supply         | volts = nan                    | volts: found NaN
    probe          | request = 'jump'               | request: \"jump\": unknown command
    serial         | text = 'stop'; repeat_hz = 0.0 | repeat_hz: found 0
    configuration  |                                | missing field `change`
    configuration  | change = 'all'                 | unknown variant `all`
    button         | for_s = 0.0                    | for_s: found 0
    sensor-part    | update_hz = 0.5                | update_hz: found 0.5, allowed: 1 to 10000
    select-stuck   | report = 1                     | event 1 (select-stuck): report:
    button         | side = 'both'                  | both";

#[test]
fn what_is_wrong_is_named() {
    for line in WRONG.trim().lines() {
        let [kind, keys, named] = std::array::from_fn(|n| line.split('|').nth(n).unwrap().trim());
        let keys = keys.replace("; ", "\n");
        let said = refused(&format!("[[event]]\nat_s = 1.0\nkind = '{kind}'\n{keys}"));
        assert!(said.contains(named), "{line}: {said}");
    }
    assert!(refused("durations_s = 1.0").contains("durations_s"));
    assert!(refused("[[event]]\nkind = 'button'").contains("at_s"));
}
