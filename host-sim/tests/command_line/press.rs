//! What `press` writes, and what it refuses.

use crate::common::{Place, cells};

fn numbers(text: &str) -> Vec<Vec<f64>> {
    let rows = cells(text).into_iter().skip(1);
    let row = |row: Vec<&str>| row.iter().map(|cell| cell.parse().unwrap()).collect();
    rows.map(row).collect()
}

const MIDDLE: &str = "press --shaft biotact-middle";
const LEAST_FOLLICLE: &str = "0.000000001 to 1000000";

#[test]
fn a_row_a_push_in_their_order() {
    let place = Place::new();
    let ran = place.done(&format!("{MIDDLE} --push-deg 20,0,5,20"));
    let header = "push_deg,moment_x_nm,moment_y_nm,normal_n,friction_n,contact_m,place_m\n";
    assert!(ran.stdout.starts_with(header), "{}", ran.stdout);
    let rows = numbers(&ran.stdout);
    let pushes: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(pushes, [20.0, 0.0, 5.0, 20.0]);
    assert_eq!(rows[0], rows[3]);
    assert_eq!(rows[1], [0.0, 0.0, 0.0, 0.0, 0.0, 0.112, 0.0]);
    assert_eq!((rows[0][2], rows[0][4]), (0.0, 0.0));
    // The tip, and then the contact, slide back towards the base.
    assert!(rows[0][5] < 0.112 && rows[0][6] < rows[2][6] && rows[2][6] < 0.0);
    assert!(place.content().is_empty());
}

#[test]
fn a_file_has_the_same_table_and_another_the_shapes() {
    let place = Place::new();
    let line = format!("{MIDDLE} --slant-deg 40 --tilt-deg 20 --friction 0.2 --push-deg 3,30");
    let piped = place.done(&line).stdout;
    let ran = place.done(&format!("{line} --out deep/p.csv --shape s.csv"));
    assert_eq!(ran.stdout, "deep/p.csv: 2 pushes; columns: docs/files.md\n");
    assert_eq!(place.text("deep/p.csv"), piped);
    let rows = numbers(&piped);
    let is_rubbed = |row: &Vec<f64>| row[2] > 0.0 && (row[4] / row[3] / 0.2 - 1.0).abs() < 1e-8;
    assert!(rows.iter().all(is_rubbed));
    let text = place.text("s.csv");
    assert!(text.starts_with("push_deg,s_m,x_m,y_m,z_m\n"), "{text}");
    let points = numbers(&text);
    for push in [3.0, 30.0] {
        let of_push: Vec<_> = points.iter().filter(|row| row[0] == push).collect();
        assert!(of_push.len() > 50);
        assert_eq!(of_push[0][1..], [0.0; 4]);
        assert_eq!(of_push[of_push.len() - 1][1], 0.112);
    }
}

#[test]
fn what_is_wrong_is_refused_with_its_range() {
    let place = Place::new();
    let numbers_of = "--length-m 0.1 --hub-m 2e-3 --taper 8 --youngs-pa 1e9 --follicle-nm-rad 0.1";
    let instead = |option: &str, value: &str| {
        let mut words: Vec<&str> = numbers_of.split(' ').collect();
        let at = words.iter().position(|word| *word == option).unwrap();
        words[at + 1] = value;
        format!("press {} --push-deg 5", words.join(" "))
    };
    for (option, values, range) in [
        ("--length-m", "-1 0 1.1 nan inf", "0.001 to 1"),
        ("--hub-m", "-1 0 0.03", "0.00001 to 0.02"),
        ("--taper", "0.9 101 nan", "1 to 100"),
        ("--youngs-pa", "1 -1 1e13", "100000 to 1000000000000"),
        ("--follicle-nm-rad", "0 -1 1e7 nan", LEAST_FOLLICLE),
    ] {
        for value in values.split(' ') {
            place.refuses(&instead(option, value), &[option, "allowed: ", range]);
        }
    }
    let table = "MIDDLE --slant-deg -10 --push-deg 5 | --slant-deg: found -10 | 0 to 80
        MIDDLE --slant-deg 95 --push-deg 5 | --slant-deg | 0 to 80
        MIDDLE --tilt-deg 90 --push-deg 5 | --tilt-deg | -80 to 80
        MIDDLE --friction -0.1 --push-deg 5 | --friction | 0 to 8
        MIDDLE --push-deg -5 | --push-deg | 0 to 90
        MIDDLE --push-deg 5,nan | --push-deg | 0 to 90
        MIDDLE --push-deg 5,,6 | --push-deg
        MIDDLE | --push-deg
        MIDDLE --slant-deg 60 --push-deg 5,60 | --push-deg: found 60 | 0 to 50.31
        MIDDLE --slant-deg 0 --push-deg 5 | --push-deg: found 5 | 0 to 0;
        MIDDLE --taper 3 --push-deg 5 | --taper | not both
        MIDDLE --push-deg 5 --out s.csv --shape s.csv | --shape | another
        MIDDLE --push-deg 5 --shape - | --shape | another
        press --shaft own --push-deg 5 | --shaft | biotact-rear
        press --push-deg 5 | --shaft: found none
        press --length-m 0.1 --push-deg 5 | --hub-m: found none";
    place.refuses_each(&table.replace("MIDDLE", MIDDLE));
    place.refuses_to_write(&format!("{MIDDLE} --push-deg 99"), &["--push-deg"]);
}
