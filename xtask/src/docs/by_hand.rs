//! Tests of what is drawn and written by hand: the harness against the firmware's pins, the mount
//! against the field of its magnet.

use std::f64::consts::{PI, TAU};

use firmware::boards::REST_US;

use crate::firmware::Board;
use crate::mount::dimensions;
use crate::run::{read, top};

fn docs(name: &str) -> String {
    read(&top().join("docs").join(name)).unwrap()
}

/// The pins in a drawing, part by part, of each first those on the left.
fn drawn(name: &str) -> Vec<String> {
    let svg = docs(name);
    let labels = svg.split('>').filter_map(|tag| tag.strip_suffix("</text"));
    let is_pin =
        |label: &&str| label.starts_with('P') && label.ends_with(|c: char| c.is_ascii_digit());
    labels.filter(is_pin).map(str::to_owned).collect()
}

/// The pins that a file of the firmware names between two of its words.
fn wired(file: &str, [begin, end]: [&str; 2]) -> Vec<String> {
    let source = read(&top().join("firmware/src/board").join(file)).unwrap();
    let (_, table) = source.split_once(begin).unwrap();
    let (table, _) = table.split_once(end).unwrap();
    let pins = table.split("('").skip(1).map(|pin| {
        let (pin, _) = pin.split_once(')').unwrap();
        format!("P{}", pin.replace("', ", ""))
    });
    pins.collect()
}

#[test]
fn the_harness_has_the_pins_of_the_firmware() {
    let left = wired("wiring.rs", ["const LEFT_SENSOR", "const ENABLES"]);
    let right = wired("nucleo_f446re.rs", ["static RIGHT", "struct Counter"]);
    let bridge = |pwm: &String, direction: &String| [pwm.clone(), direction.clone()];
    // Sensor, encoder and bridge of each side; the right bridge stands before its encoder.
    let [sensor, encoder, bridge, right_bridge] = [
        &left[..4],
        &left[4..6],
        &bridge(&left[7], &left[6]),
        &bridge(&left[8], &right[4]),
    ];
    let one_side = [sensor, encoder, bridge].concat();
    assert_eq!(drawn("harness-f103rb.svg"), one_side);
    assert_eq!(drawn("harness-g071rb.svg"), one_side);
    let sensors = [sensor, &right[..4]].concat();
    let encoders = [encoder, &right[5..]].concat();
    let bridges = [bridge, right_bridge].concat();
    assert_eq!(drawn("harness.svg"), [sensors, encoders, bridges].concat());
}

fn rows_of_numbers(table: &str) -> Vec<Vec<u32>> {
    let rows = table.lines().map(|line| {
        let cells = line.split('|').filter_map(|cell| cell.trim().parse().ok());
        cells.collect::<Vec<u32>>()
    });
    rows.filter(|row| !row.is_empty()).collect()
}

#[test]
fn rests_are_those_of_the_boards() {
    let page = docs("boards.md");
    let (_, table) = page.split_once("### The rest of a sensor").unwrap();
    let (table, _) = table.split_once("\n## ").unwrap();
    let rests = [2_000, 1_000, 500].map(|tick_hz| {
        let boards = Board::ALL.map(|board| {
            let rest = board.facts.clocks.rest_ns(tick_hz, REST_US).unwrap();
            rest / 1_000
        });
        [&[tick_hz], &boards[..]].concat()
    });
    assert_eq!(rows_of_numbers(table), rests);
}

/// The magnet of the mount: radius and length, mm, and remanence, mT.
const RADIUS: f64 = 2.0;
const LENGTH: f64 = 3.0;
const REMANENCE: f64 = 1_200.0;
/// The sensor's whole range of tilt.
const TILT_RAD: f64 = 0.15;

/// What the sensor has along its axis, mT, z mm from the magnet's face, and k: across it has
/// k B φ where the magnet turns about its centre by a small φ.
///
/// By the currents of the magnet's surface: B = (B_r L/loops)/(4π) ∮ dl × r/r³.
fn field(z: f64) -> [f64; 2] {
    let (phi, loops, parts) = (0.02_f64, 100, 360);
    let strength = REMANENCE * LENGTH / f64::from(loops) / (4.0 * PI);
    let turn = |[x, y, z]: [f64; 3]| {
        let (sine, cosine) = phi.sin_cos();
        [x * cosine + z * sine, y, z * cosine - x * sine]
    };
    let [mut across, mut along] = [0.0; 2];
    for n in 0..loops {
        let place = LENGTH * ((f64::from(n) + 0.5) / f64::from(loops) - 0.5);
        for m in 0..parts {
            let step = TAU / f64::from(parts);
            let (sine, cosine) = (step * f64::from(m)).sin_cos();
            let at = turn([RADIUS * cosine, RADIUS * sine, place]);
            let dl = turn([-sine, cosine, 0.0]).map(|part| part * RADIUS * step);
            // The sensor lies below the centre, on the axis at rest.
            let r = [-at[0], -at[1], -(z + LENGTH / 2.0) - at[2]];
            let cubed = r.iter().map(|part| part * part).sum::<f64>().powf(1.5);
            across += strength * (dl[1] * r[2] - dl[2] * r[1]) / cubed;
            along += strength * (dl[0] * r[1] - dl[1] * r[0]) / cubed;
        }
    }
    [along, -across / (along * phi)]
}

#[test]
fn the_page_of_the_mount_has_the_field_of_its_magnet() {
    let page = docs("build.md");
    let (_, table) = page.split_once("k B · 0.15, mT |").unwrap();
    let rows = table.lines().skip(2).take_while(|line| !line.is_empty());
    let mut count = 0;
    for row in rows {
        let numbers = row.trim_matches(['|', ' ']).split(" | ");
        let numbers: Vec<f64> = numbers.map(|n| n.parse().unwrap()).collect();
        let [along, share] = field(numbers[0]);
        let across = share * along * TILT_RAD.sin();
        // Half of the last digit, and what the loops leave.
        let is = |written: f64, found: f64, digit: f64| (written - found).abs() < 0.6 * digit;
        assert!(is(numbers[1], along, 1.0), "{row} {along}");
        assert!(is(numbers[2], share, 0.01), "{row} {share}");
        assert!(is(numbers[3], across, 0.1), "{row} {across}");
        count += 1;
    }
    assert_eq!(count, 9);
}

#[test]
fn the_dimensions_of_the_mount_are_those_of_its_drawing() {
    let (page, drawing) = (docs("build.md"), docs("mount.svg"));
    let mm = dimensions(&page);
    for (letter, size) in &mm {
        let drawn = format!(">{letter} = {size:.2}<");
        assert!(drawing.contains(&drawn), "{drawn}");
    }
    let letters: Vec<&String> = mm.keys().collect();
    assert_eq!(letters, ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"]);
    assert_eq!([mm["d"], mm["e"]], [2.0 * RADIUS, LENGTH]);
    let [along, share] = field(mm["g"]);
    assert!((along - 60.0).abs() < 0.3, "{along}");
    let read = 100.0 * share / 0.5;
    assert!((read - 73.0).abs() < 0.6, "{read}");
    let (sine, cosine) = TILT_RAD.sin_cos();
    let moved = mm["e"] / 2.0 * sine + mm["d"] / 2.0 * (1.0 - cosine);
    assert!((moved - 0.25).abs() < 0.005, "{moved}");
}
