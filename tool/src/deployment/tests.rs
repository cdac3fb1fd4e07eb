use std::path::Path;

use firmware::boards::{ALL, NUCLEO_F103RB, NUCLEO_F446RE, NUCLEO_G071RB};
use firmware::{ConfigError, Part, refusal_code};
use tactile::train::{Options, Trainer};
use wire::{Command, CommandStatus};

use super::{BoardFacts, Deployment, Loaded, ModelBuf, Program, files};
use crate::conversation::Conversation;
use crate::source::{Scripted, scene_file};

pub(crate) fn model(name: &str) -> ModelBuf {
    let path = scene_file(&format!("models/{name}.model"));
    files::load_model(&path).unwrap().1
}

fn textures() -> ModelBuf {
    model("textures")
}

pub(crate) fn loaded(name: &str, keys: &[&str]) -> Loaded {
    let text = std::fs::read_to_string(scene_file(name)).unwrap();
    let keys: Vec<_> = keys.iter().map(|key| key.parse().unwrap()).collect();
    let model = |path: &Path| Ok(std::fs::read(scene_file("").join(path)).unwrap());
    Loaded::from_text(name, &text, &keys, model).unwrap()
}

pub(crate) fn on(
    board: &BoardFacts,
    loaded: Loaded,
    model: Option<ModelBuf>,
) -> Result<Deployment, host_sim::Error> {
    let program = Program::for_scene(board.code, &loaded.scene)?;
    Deployment::of(Path::new("s.toml"), loaded, model, program)
}

fn refused(board: &BoardFacts, loaded: Loaded, model: Option<ModelBuf>) -> String {
    on(board, loaded, model).unwrap_err().to_string()
}

fn of_classes(classes: u32) -> ModelBuf {
    let mut trainer = Trainer::new(2, Options::default()).unwrap();
    for class in 0..classes {
        for sample in 0..100 {
            let x = f64::from(8000 + 20 * class + sample % 10);
            trainer.add(&format!("c{class}"), &[x, 8192.0]).unwrap();
        }
    }
    trainer.train().unwrap()
}

#[test]
fn a_model_alone_comes_to_the_same_as_with_its_scene() {
    for board in &ALL {
        let of = |model| on(board, loaded("bench.toml", &[]), model).unwrap();
        let with = of(Some(textures()));
        let again = Deployment::again(&of(None).config, textures()).unwrap();
        assert_eq!(again.config, with.config);
        let [config, model] = again.words();
        assert!(config.len() % 2 == 0 && model.len() % 2 == 0);
        let bytes = textures().as_bytes().len();
        assert_eq!(4 * model.len(), bytes.next_multiple_of(8));
    }
}

#[test]
fn a_model_that_the_module_cannot_use_is_refused() {
    let refused = |name: &str, keys: &[&str]| {
        let config = on(&NUCLEO_F446RE, loaded(name, keys), None).unwrap().config;
        let fault = Deployment::again(&config, textures()).unwrap_err();
        fault.to_string()
    };
    assert!(refused("passive.toml", &[]).contains("it has no [classifier]"));
    let least = refused("bench.toml", &["classifier.contact_min=0.2"]);
    assert!(least.contains("contact_min is not the contact"), "{least}");
}

#[test]
fn what_a_board_has_not_is_refused_by_name() {
    let is_refused = |board: &BoardFacts, name, keys: &[&str], found| {
        let fault = format!("{found}; allowed on the {}: ", board.name);
        let found = refused(board, loaded(name, keys), None);
        assert!(found.contains(&fault), "{fault}: {found}");
    };
    // Two brushless motors `whisker deploy` refuses from outside.
    let sides = "head.sides: found \"both\"";
    is_refused(&NUCLEO_G071RB, "both.toml", &[], sides);
    let two = &["head.whiskers_per_side=2"];
    let whiskers = "head.whiskers_per_side: found 2";
    is_refused(&NUCLEO_F446RE, "rcp.toml", two, whiskers);
    let fast = &["tick_hz=10000"];
    let ticks = "tick_hz: found 10000";
    is_refused(&NUCLEO_F103RB, "passive.toml", fast, ticks);
    let bauds = &["telemetry.serial_baud=2000000", "tick_hz=200"];
    let baud = "telemetry.serial_baud: found 2000000";
    is_refused(&NUCLEO_F446RE, "bench.toml", bauds, baud);
    let floats = &["whisking.numbers=f32"];
    let numbers = "whisking.numbers: found \"f32\"";
    is_refused(&NUCLEO_F103RB, "bench.toml", floats, numbers);
}

#[test]
fn more_classes_than_a_board_has_are_refused() {
    for (board, most) in [(&NUCLEO_F446RE, 16), (&NUCLEO_G071RB, 6)] {
        let bench = || loaded("bench.toml", &[]);
        let fault = format!("found {} classes; allowed on the", most + 1);
        let found = refused(board, bench(), Some(of_classes(most + 1)));
        assert!(found.contains(&fault), "{found}");
        let running = on(board, bench(), None).unwrap().config;
        let found = Deployment::again(&running, of_classes(most + 1)).unwrap_err();
        let fault = format!("found {} classes, allowed on the", most + 1);
        assert!(found.to_string().contains(&fault), "{found}");
        Deployment::again(&running, of_classes(most)).unwrap();
    }
}

#[test]
fn a_model_with_a_second_opinion_is_refused_by_an_image_without() {
    let scene = loaded("bench-textures.toml", &[]);
    let what = on(&NUCLEO_G071RB, scene, Some(model("bench-textures"))).unwrap();
    let tried = |flags: i32| {
        let mut module = Conversation::new(Box::new(Scripted::new(move |_| {
            let values = [3 + 768, i32::from(firmware::VERSION) | flags];
            Some((CommandStatus::Done, values))
        })));
        what.try_out(&mut module).map_err(|error| error.to_string())
    };
    let fault = tried(0).unwrap_err();
    let without = "the module's image was built without";
    assert!(fault.contains(without), "{fault}");
    assert_eq!(tried(wire::HAS_OPINIONS), Ok(()));
}

#[test]
fn another_number_format_than_the_programs_is_refused() {
    let bench = loaded("bench.toml", &[]);
    let fixed = Program::for_scene(NUCLEO_F103RB.code, &bench.scene).unwrap();
    let board = NUCLEO_F446RE.code;
    let program = Program { board, ..fixed };
    let found = Deployment::of(&scene_file("bench.toml"), bench, None, program);
    let fault = found.unwrap_err().to_string();
    let says = "whisking.numbers: it comes to f32; the board's program computes in fixed";
    assert!(fault.contains(says), "{fault}");
}

#[test]
fn a_part_that_the_image_has_not_is_refused_before_anything_is_written() {
    let what = on(&NUCLEO_F446RE, loaded("bench.toml", &[]), None).unwrap();
    let tried = |answer: (CommandStatus, [i32; 2])| {
        let mut module = Conversation::new(Box::new(Scripted::new(move |command| {
            Some(match command {
                Command::Apply(_) => answer,
                Command::Forget | Command::Stage(..) => (CommandStatus::Done, [0; 2]),
                command => panic!("{command:?}"),
            })
        })));
        what.try_out(&mut module).map_err(|error| error.to_string())
    };
    let refuses = |why| (CommandStatus::OutOfRange, refusal_code(why));
    let without = ConfigError::NotBuilt(Part::Sequential);
    let fault = "the module refuses the scene: rule sequential: this image was built without it; \
                 cargo xtask firmware --any-scene builds one that has it; nothing was written";
    assert_eq!(tried(refuses(without)), Err(fault.to_owned()));
    let fault = tried(refuses(ConfigError::NotBuilt(Part::Tmag5170))).unwrap_err();
    let says = "sensor tmag5170: this image was built without it; cargo xtask firmware --scene";
    assert!(fault.contains(says), "{fault}");
    // Another scene than the one that runs, which can be read.
    let shape = ConfigError::Shape(firmware::Field::Name);
    assert_eq!(tried(refuses(shape)), Ok(()));
    assert_eq!(tried((CommandStatus::Done, [0; 2])), Ok(()));
}
