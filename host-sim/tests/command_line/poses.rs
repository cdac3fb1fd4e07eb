//! What `train` and `evaluate` say of poses.

use tactile::{ModelBuf, Whisked};

use crate::common::{Place, TEXTURED, line, says};

fn recorded(places_deg: &[u32]) -> Place {
    let place = Place::new();
    for deg in places_deg {
        let text = TEXTURED
            .replace("duration_s = 0.5", "duration_s = 2.0")
            .replace("[80.0]", &format!("[{deg}.0]"));
        place.write("s.toml", text);
        place.done(&format!("record s.toml --out at{deg}.csv"));
    }
    place
}

fn recorded_long(place: &Place) {
    let long = TEXTURED.replace("duration_s = 0.5", "duration_s = 6.0");
    place.write("long.toml", long);
    place.done("record long.toml --out long.csv");
}

fn trained(place: &Place, data: &[&str], options: &str) -> String {
    let data: Vec<_> = data.iter().map(|name| format!("--data {name}")).collect();
    let line = format!("train {} --out the.model {options}", data.join(" "));
    place.done(&line).stdout
}

fn evaluated(place: &Place, model: &str) -> String {
    let line = format!("evaluate --model {model} --data at80.csv");
    place.done(&line).stdout
}

/// Five files in one, in which trials of the same number follow each other.
#[test]
fn trials_of_two_poses_are_two() {
    let rows = |pose: u32| {
        let row = move |n: u32| format!("low,1,{},{},p{pose}\n", n % 7 + pose, n % 5);
        (0..50).map(row).collect::<String>()
    };
    let table = format!("label,trial,x,y,pose\n{}{}", rows(1), rows(2));
    let streams = host_sim::recording::read(table.as_bytes(), ["x", "y"]).unwrap();
    let poses = streams.iter().map(|stream| stream.pose.as_deref());
    assert!(poses.eq([Some("p1"), Some("p2")]));
    assert!(streams.iter().all(|stream| stream.samples.len() == 50));
    // A row that does not say its pose is of that of the row before.
    let silent = table.replace(",p1\nlow,1,6,2,p1", ",p1\nlow,1,6,2,");
    assert!(silent.len() < table.len());
    let again = host_sim::recording::read(silent.as_bytes(), ["x", "y"]).unwrap();
    assert_eq!(again, streams);
}

#[test]
fn several_poses_are_held_out_and_one_is_recommended() {
    let place = recorded(&[76, 78, 80, 82, 84]);
    let names = ["at76.csv", "at78.csv", "at80.csv", "at82.csv", "at84.csv"];
    let of_files = trained(&place, &names, "");
    let trained_in = "trained in 5 poses: names by itself between them";
    line(&of_files, trained_in);
    for name in names {
        line(&of_files, &format!("{name}: decided "));
    }
    line(&of_files, "least decided: at");
    assert!(of_files.contains("between it and its neighbours would help "));
    line(&evaluated(&place, "the.model"), trained_in);

    // The same as values of a column.
    let mut table = String::from("label,trial,x,y,contact,touch,pose\n");
    for name in names {
        for row in place.text(name).lines().skip(1) {
            table.extend([row, ",of ", name, "\n"]);
        }
    }
    place.write("all.csv", table);
    let of_column = trained(&place, &["all.csv"], "");
    line(&of_column, trained_in);
    line(&of_column, "pose of at76.csv: decided ");
    let one = "all is of one recording";
    assert!(!of_column.contains(one), "{of_column}");
    // Beside a file that is a pose itself.
    let both = trained(&place, &["all.csv", "at80.csv"], "");
    line(&both, "trained in 6 poses");
    line(&both, "all.csv, pose of at84.csv: decided ");

    // Three are too few to leave one out.
    let three = trained(&place, &names[..3], "");
    let few = "trained in 3 poses: names by itself between them; train with a fourth";
    line(&three, few);
}

#[test]
fn a_pose_without_a_class_is_none() {
    let place = recorded(&[76, 78, 80, 82]);
    let text = place.text("at82.csv");
    let rows = text.lines().filter(|row| !row.starts_with("carpet"));
    place.write("lacking.csv", rows.collect::<Vec<_>>().join("\n"));
    let names = ["at76.csv", "at78.csv", "at80.csv", "lacking.csv"];
    let said = trained(&place, &names, "");
    line(&said, "trained in 3 poses");
    let lacking =
        "warning: lacking.csv: not used as a pose of its own, 0 touches of carpet, and it needs 4";
    line(&said, lacking);
}

#[test]
fn one_pose_is_said_to_be_one() {
    let place = recorded(&[80]);
    let honest = "trained in one pose: honest there only";
    let too_few = "warning: no second opinion: too few touches of smooth: ";
    let said = trained(&place, &["at80.csv"], "");
    line(&said, honest);
    line(&said, too_few);
    let said = trained(&place, &["at80.csv"], "--expect same");
    line(&said, honest);
    assert!(!said.contains("no second opinion"), "{said}");

    recorded_long(&place);
    let said = trained(&place, &["long.csv"], "");
    line(&said, "trained in 1 pose: honest in it, silent elsewhere");
    let said = evaluated(&place, "the.model");
    let silent = "honest in the poses of its training, silent elsewhere";
    line(&said, silent);
    // What the second opinion costs: beside it stands what is without.
    trained(&place, &["long.csv"], "--expect same");
    let same = evaluated(&place, "the.model");
    let (_, found) = line(&same, "found").split_at(5);
    let without = format!("without: right {}, stated", found.trim());
    says(&said, &[&without]);
    assert!(!same.contains("second opinion"), "{same}");
}

#[test]
fn older_models_are_told_apart() {
    let place = recorded(&[80]);
    let models = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/older");
    let single = "train --data at80.csv --tables single --out single.model";
    place.done(single);
    for model in ["single.model", &format!("{models}/textures.model")] {
        let said = evaluated(&place, model);
        line(&said, "trained at one pose; honest there only");
    }
}

/// One training, written with weights of all stages of a touch, and of those that decide.
#[test]
fn weights_of_early_stages_change_no_decision() {
    let place = Place::new();
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
    let decided = |model: &str| {
        let set =
            format!("--set duration_s=10 --set classifier.model={root}/tests/data/older/{model}");
        place.done(&format!(
            "run {root}/scenes/bench-textures.toml --out {model}.out {set}"
        ));
        place.text(&format!("{model}.out/decisions.csv"))
    };
    let whole = decided("naming.model");
    let count = |of: &str| whole.lines().filter(|line| line.contains(of)).count();
    // Five touches of each of four textures, named but for some.
    let are_named = count("between") < 10 && count("smooth,0,smooth") > 2;
    assert!(are_named, "{whole}");
    assert_eq!(decided("naming-late.model"), whole);
}

#[test]
fn a_model_keeps_how_its_scene_whisks() {
    let place = recorded(&[80]);
    recorded_long(&place);
    let whisked = |options: &str| {
        trained(&place, &["long.csv"], options);
        let model = ModelBuf::from_bytes(&place.bytes("the.model")).unwrap();
        assert!(model.has_opinion());
        model.whisked()
    };
    assert_eq!(whisked(""), Whisked::default());
    let known = Whisked {
        frequency_mhz: Some(8000),
        has_rcp: Some(true),
    };
    assert_eq!(whisked("--scene long.toml"), known);
    let naming = ["--rate: found 1000, the scene has 2000"];
    let train = "train --data long.csv --scene long.toml --rate 1000";
    place.refuses_to_write(train, &naming);
    let train = "train --data long.csv --scene none.toml";
    place.refuses_to_write(train, &["none.toml"]);
}
