//! Scenes that are in order, and what they come out as.

use crate::common::{FULL, left, with};
use mlx90333::{ByteOrder, Mode, SumRule};
use scene::{
    Arm, ClassifierSection, Deciding, Driver, Exchanged, GateSettings, HeadSection, Integrator,
    MotorSection, Numbers, Obstacles, OnFault, PlantKind, PlantSection, PoseSpread, Rest, Rule,
    Scene, SensorMode, SensorModel, SensorSection, ShaftChoice, ShaftName, ShaftNumbers, Sides,
    TelemetrySection, Texture, WhiskingSection,
};

fn read(text: &str) -> Scene {
    Scene::from_str("s.toml", text).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Of [`FULL`] with these keys in the place of its kind.
fn plant(keys: &str) -> PlantSection {
    read(&with(FULL, "kind      = \"ideal\"", keys)).plant
}

const CARPET: &str = "kind = 'whisker'\ntextures = ['carpet']\npresent_s = 1";

const fn gate(gain: f64) -> GateSettings {
    GateSettings { gain, tau_s: 0.125 }
}

const MOTOR: &str = "[motor]
driver = 'six-step'
kp = 1
kd = 0.5
duty_limit = 0.25
slew_per_s = 10
min_deg = -20
max_deg = 200.5
gear = 4.4
counts_per_rev = 1024
following_limit_deg = 12.5
travel_margin_deg = 3
top_speed_deg_s = 900
unmoved_duty = 0.4
continuous_duty = 0.3
on_fault = 'stop-all'
arm = 'on-command'
rest = 'find'
homing_duty = 0.125
stop_deg = -30
far_stop_deg = 210
home_every_s = 45
approach_deg_s = 90
";

#[test]
fn every_key_reaches_its_field() {
    let text = with(FULL, "[plant]\n", &format!("{MOTOR}\n[plant]\n"));
    let text = with(&text, "name        = \"rcp7\"", "name = 'A-z_0.9'");
    let text = with(&text, "duration_s  = 6.0", "duration_s = 6");
    let text = with(&text, "seed        = 1 ", "seed = 0x7fff_ffff_ffff_ffff");
    let text = with(&text, "gain         = 1.0", "gain = [0.5, 2]");
    let text = with(
        &text,
        "[[1.0, 0.0], [1.0, 0.0]]",
        "[[1, -1.5], [0.25, 0.5]]",
    );
    let text = with(&text, "[classifier]\n", "[classifier]\npose = true\n");
    let expected = Scene {
        name: "A-z_0.9".to_owned(),
        tick_hz: 2000,
        duration_s: 6.0,
        seed: i64::MAX as u64,
        head: HeadSection {
            whiskers_per_side: 1,
            rows: 1,
            sides: Sides::Both,
            nodes: None,
            bus_kbit_s: None,
        },
        sensor: SensorSection {
            mode: SensorMode::Fast,
            words: Mode::AlphaBeta,
            sum_rule: SumRule::SumB1B6,
            byte_order: ByteOrder::Little,
            rest_us: 50,
            frozen_s: 0.25,
            jump_per_s: 1500.0,
            model: SensorModel::Mlx90333,
            zero_after_s: None,
            self_motion_s: None,
            zero_calm: 0.05,
            zero_most: 160,
            swing_codes: None,
        },
        telemetry: TelemetrySection {
            rtt: true,
            serial_baud: None,
            pins: false,
        },
        whisking: Some(WhiskingSection {
            frequency_hz: 2.0,
            integrator: Integrator::Exact,
            coupling: true,
            noise: 0.0,
            gain: vec![0.5, 2.0],
            start: vec![[1.0, -1.5], [0.25, 0.5]],
            numbers: Numbers::Auto,
        }),
        rcp: Some(gate(0.7)),
        cia: Some(gate(0.5)),
        motor: Some(MotorSection {
            driver: Driver::SixStep,
            kp: 1.0,
            kd: 0.5,
            duty_limit: 0.25,
            slew_per_s: 10.0,
            min_deg: -20.0,
            max_deg: 200.5,
            gear: 4.4,
            counts_per_rev: 1024,
            following_limit_deg: 12.5,
            travel_margin_deg: 3.0,
            top_speed_deg_s: 900.0,
            unmoved_duty: 0.4,
            time_constant_s: 0.048,
            continuous_duty: 0.3,
            on_fault: OnFault::StopAll,
            arm: Some(Arm::OnCommand),
            rest: Rest::Find,
            homing_duty: 0.125,
            stop_deg: Some(-30.0),
            far_stop_deg: Some(210.0),
            home_every_s: 45.0,
            approach_deg_s: 90.0,
        }),
        plant: PlantSection {
            kind: PlantKind::Ideal,
            obstacle: Some(Obstacles {
                obstacle_deg: vec![100.0, 125.0],
                stiffness: 0.1,
            }),
            ..PlantSection::default()
        },
        classifier: Some(ClassifierSection {
            rule: Rule::Sequential { threshold: 0.99 },
            model: Some("models/example.model".to_owned()),
            thresholds: None,
            prior: None,
            contact_min: None,
            pose: true,
            whiskers: Deciding::First,
        }),
    };
    assert_eq!(read(&text), expected);
    assert_eq!((expected.ticks(), expected.whiskers()), (12_000, 2));
}

#[test]
fn without_its_table_a_motor_is_as_with_an_empty_one() {
    let empty = with(FULL, "[plant]\n", "[motor]\n[plant]\n");
    assert_eq!(read(FULL).motor, read(&empty).motor);
}

#[test]
fn the_least_scene_is_passive_and_free() {
    let text = "name='a'\ntick_hz=200\nduration_s=0.005\nseed=0\n\
                head.whiskers_per_side=12\nplant={kind='ideal'}\n";
    let scene = read(text);
    assert_eq!(scene.ticks(), 1);
    assert_eq!(scene.whiskers(), 24);
    assert_eq!((scene.whisking, scene.rcp, scene.cia), (None, None, None));
    assert_eq!((scene.motor, scene.classifier), (None, None));
    assert_eq!(scene.plant.obstacle, None);
}

#[test]
fn one_gain_stands_for_every_whisker_and_negative_zero_is_zero() {
    let text = with(FULL, "whiskers_per_side = 1 ", "whiskers_per_side = 3 ");
    let text = with(&text, "gain         = 1.0", "gain = 1.25");
    let text = with(&text, "noise        = 0.0", "noise = -0.0");
    // Stiffness without an obstacle is idle.
    let text = with(&text, "obstacle_deg = [100.0, 125.0]", "");
    let scene = read(&text);
    let whisking = scene.whisking.expect("whisking is in the text");
    assert_eq!(whisking.gain, [1.25; 6]);
    assert!(whisking.noise.is_sign_positive());
    assert_eq!(scene.plant.obstacle, None);
}

#[test]
fn a_left_half_has_one_entry_a_side() {
    let scene = read(&left());
    assert_eq!(scene.head.sides, Sides::Left);
    assert_eq!(scene.whiskers(), 1);
    let whisking = scene.whisking.expect("whisking is in the text");
    assert_eq!(whisking.gain, [1.0]);
    assert_eq!(whisking.start, [[1.0, 0.0]]);
}

#[test]
fn textured_surfaces_keep_their_order() {
    let keys = "kind = 'textured'\ntextures = ['carpet', 'smooth', 'p600']\npresent_s = 1";
    let plant = plant(keys);
    assert_eq!(plant.kind, PlantKind::Textured);
    let textured = plant.textured.expect("surfaces");
    let [carpet, smooth, p600] = [Texture::Carpet, Texture::Smooth, Texture::P600];
    assert_eq!(textured.textures, [carpet, smooth, p600]);
    assert_eq!(
        (textured.present_s, textured.exchange),
        (1.0, Exchanged::Air)
    );
    assert_eq!(textured.friction, None);
    assert_eq!(plant.shaft, None, "its default is the elastic whisker's");
}

#[test]
fn own_surfaces_have_properties_in_the_order_of_the_textures() {
    let keys = "kind = 'whisker'\ntextures = ['own-2', 'tarmac', 'own-1']\npresent_s = 1\n\
                own_grain_m = [1e-3, 2e-3]\nown_friction = [0.3, 0.6]";
    let textured = plant(keys).textured.unwrap();
    let numbers: Vec<_> = textured.textures.iter().map(|of| of.own()).collect();
    assert_eq!(numbers, [Some(1), None, Some(0)]);
    let own = textured.own.unwrap();
    assert_eq!(own.own_grain_m, Some(vec![1e-3, 2e-3]));
    assert_eq!(own.own_friction, Some(vec![0.3, 0.6]));
    assert_eq!(own.own_damping, None);
}

#[test]
fn poses_are_alike_unless_a_spread_is_given() {
    let spread = |keys: &str| {
        let spread = plant(&format!("{CARPET}\n{keys}")).spread;
        spread.expect("an elastic whisker has one")
    };
    assert!(!spread("").is_there());
    let expected = PoseSpread {
        tilt_spread_deg: 60.0,
        obstacle_spread_deg: 0.0,
        gain_spread: 0.0,
    };
    assert_eq!(spread("tilt_spread_deg = 60"), expected);
    // The plate may be tilted by up to 80° in either direction.
    assert!(spread("tilt_deg = -79\ntilt_spread_deg = 1").is_there());
    assert!(spread("obstacle_spread_deg = 45").is_there());
    assert!(spread("gain_spread = 0.9").is_there());
    assert!(!spread("exchange = 'timed'\ngain_spread = 0").is_there());
    assert_eq!(read(FULL).plant.spread, None);
}

#[test]
fn an_elastic_whisker_is_a_paper_s_or_has_its_own_numbers() {
    let a_papers = plant(CARPET);
    assert!(a_papers.textured.is_some() && a_papers.kind == PlantKind::Whisker);
    let middle = ShaftChoice {
        shaft: ShaftName::BiotactMiddle,
        own: None,
    };
    assert_eq!(a_papers.shaft, Some(middle));
    let numbers = "shaft = 'own'\nlength_m = 0.1\nhub_diameter_m = 0.02\ntip_diameter_m = 2e-4\n\
                   youngs_pa = 1e9\ndensity_kg_m3 = 1000\ndamping_ratio = 0.1\nfollicle_n_m_rad = 0.3";
    let shaft = plant(&format!("{CARPET}\n{numbers}")).shaft;
    let own = ShaftNumbers {
        length_m: 0.1,
        hub_diameter_m: 0.02,
        tip_diameter_m: 2e-4,
        youngs_pa: 1e9,
        density_kg_m3: 1000.0,
        damping_ratio: 0.1,
        follicle_n_m_rad: 0.3,
    };
    assert_eq!(shaft.and_then(|shaft| shaft.own), Some(own));
}

#[test]
fn the_rule_chooses_between_threshold_and_window() {
    let text = with(FULL, "\"sequential\" ", "\"window\" ");
    let text = with(&text, "window    = 400", "window = 400\ncontact_min = 0.5");
    let classifier = read(&text).classifier.expect("it is in the text");
    assert_eq!(classifier.rule, Rule::Window { samples: 400 });
    assert_eq!(classifier.contact_min, Some(0.5));
    // The other rule's key may be left out.
    let text = with(FULL, "window    = 400\n", "");
    let classifier = read(&text).classifier.expect("it is in the text");
    assert_eq!(classifier.rule, Rule::Sequential { threshold: 0.99 });
}

#[test]
fn ticks_are_rounded_to_the_nearest() {
    // 0.0029 s at 1 kHz is 2.9 ticks.
    let text = with(FULL, "tick_hz     = 2000 ", "tick_hz = 1000 ");
    let text = with(&text, "duration_s  = 6.0", "duration_s = 0.0029");
    assert_eq!(read(&text).ticks(), 3);
    let longest = with(FULL, "tick_hz     = 2000 ", "tick_hz = 20000 ");
    let longest = with(&longest, "duration_s  = 6.0", "duration_s = 1e5");
    assert_eq!(read(&longest).ticks(), 2_000_000_000);
}

#[test]
fn a_scene_is_loaded_and_its_model_found_beside_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("s.toml");
    std::fs::write(&file, FULL).expect("the scene is written");
    let scene = Scene::load(&file).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(scene, read(FULL));

    let model = std::path::Path::new("models/example.model");
    assert_eq!(scene.model_path(folder.path()).as_deref(), Some(model));
    let beside = folder.path().join(model);
    std::fs::create_dir(folder.path().join("models")).expect("a folder");
    std::fs::write(&beside, "").expect("the model is written");
    assert_eq!(scene.model_path(folder.path()), Some(beside));

    let (before, _) = FULL.split_once("[classifier]").expect("it is there");
    assert_eq!(read(before).model_path(folder.path()), None);
}

#[test]
fn the_example_on_the_page_is_a_scene() {
    let page = scene::reference();
    let (_, rest) = page.split_once("```toml\n").expect("an example begins");
    let (example, _) = rest.split_once("```\n").expect("and ends");
    let scene = read(example);
    assert_eq!(scene.name, "example");
    assert_eq!(scene.motor.map(|motor| motor.kp), Some(0.04));
}

/// [`FULL`] as it stands on a bench: what it meets and its model are left out.
fn on_a_bench() -> Scene {
    let without_model = with(FULL, "model     = \"models/example.model\"", "");
    let (head, plant) = without_model.split_once("[plant]").expect("a plant");
    let (_, classifier) = plant.split_once("[classifier]").expect("a classifier");
    read(&format!("{head}[classifier]{classifier}"))
}

#[test]
fn a_bench_has_neither_surfaces_nor_a_model() {
    let bench = on_a_bench();
    assert!(bench.awaits_model() && !read(FULL).awaits_model());
    assert_eq!(bench.model_path(std::path::Path::new(".")), None);
    assert_eq!(bench.plant, PlantSection::default());
}

#[test]
fn a_module_has_the_world_of_another_scene() {
    let world = with(FULL, "duration_s  = 6.0", "duration_s = 9.0");
    let world = read(&with(&world, "seed        = 1  ", "seed = 77 "));
    let bench = on_a_bench();
    let placed = bench.clone().in_world(&world).expect("it fits");
    // Nobody stands at a module that is simulated; on a bench somebody does.
    let arm = |scene: &Scene| scene.motor.as_ref().expect("it whisks").arm;
    assert_eq!((arm(&bench), arm(&placed)), (None, Some(Arm::AtStart)));
    let mut waits = bench.clone();
    waits.motor.as_mut().expect("it whisks").arm = Some(Arm::OnCommand);
    let waits = waits.in_world(&world).expect("it fits");
    assert_eq!(arm(&waits), Some(Arm::OnCommand));
    // All else is the module's own.
    let expected = Scene {
        motor: placed.motor.clone(),
        plant: world.plant.clone(),
        duration_s: 9.0,
        seed: 77,
        ..bench.clone()
    };
    assert_eq!(placed, expected);

    let mut left = world.clone();
    left.head.sides = Sides::Left;
    let refused = bench.clone().in_world(&left).expect_err("another head");
    let one_side = "a world for one side of whiskers";
    assert!(refused.contains(one_side), "{refused}");
    let mut short = world.clone();
    short.duration_s = 1e-4;
    assert!(bench.clone().in_world(&short).is_err());
    let mut passive = bench;
    passive.whisking = None;
    let mut textured = world;
    textured.plant.kind = PlantKind::Textured;
    let refused = passive.in_world(&textured).expect_err("no motor");
    assert!(refused.contains("needs an active whisker"), "{refused}");
}
