//! Constants that are changed in a module: as if its scene had had them.

use host_sim::bench::{ConstantWords, RunsOn, TunableConstants, tunable_constants};
use host_sim::classifier::Classifier;
use host_sim::run::Run;
use plan::NumberFormat;
use scene::{Override, Scene};
use tactile::ModelBuf;
use wire::{Answer, Command, CommandStatus, Packet, SECOND_WORD, TaggedCommand, word_sum};

use crate::common::{SEQUENTIAL, TEXTURED, model};

/// Every part that can be tuned, in a number format.
fn scene(numbers: &str, set: &[&str]) -> Scene {
    let text =
        format!("{TEXTURED}{SEQUENTIAL}contact_min = 0.05\n[cia]\ngain = 0.5\ntau_s = 0.2\n");
    let numbers = format!("whisking.numbers={numbers}");
    let own = [numbers.as_str(), "motor.rest=find", "motor.stop_deg=30"];
    let all = own.iter().chain(set);
    let set: Vec<Override> = all.map(|one| one.parse().unwrap()).collect();
    Scene::from_str_with("s.toml", &text, &set).unwrap().0
}

fn run(scene: &Scene) -> Run {
    let rule = scene.classifier.as_ref().map(|classifier| classifier.rule);
    let model = ModelBuf::from_bytes(&model(2, 20, true)).unwrap();
    Run::new(
        scene,
        rule.map(|rule| Classifier::new(model, rule).unwrap()),
    )
    .unwrap()
}

fn constants(scene: &Scene, format: NumberFormat) -> TunableConstants {
    let runs_on = RunsOn::Simulation { records: false };
    tunable_constants(scene, None, format, runs_on, &ConstantWords::new()).unwrap()
}

/// All that a run shows in two seconds, to the last bit.
fn seen(run: &mut Run) -> (Vec<u64>, Vec<String>) {
    let (mut rows, mut events) = (Vec::new(), Vec::new());
    for _ in 0..4_000 {
        let row = run.tick();
        rows.extend(
            row.pairs()
                .as_flattened()
                .iter()
                .map(|value| value.to_bits()),
        );
        events.extend(run.events().iter().map(|event| format!("{event:?}")));
    }
    (rows, events)
}

/// What a module answers, after a tick.
fn answers(run: &mut Run, commands: &[Command]) -> Vec<Answer> {
    let mut answers = Vec::new();
    for (tag, command) in (1..).zip(commands) {
        let command = *command;
        run.module_mut().request(TaggedCommand { tag, command });
        run.tick();
        let packets = run.module_mut().take_packets();
        answers.extend(packets.iter().filter_map(|packet| match packet {
            Packet::Answer(answer) => Some(*answer),
            Packet::Record(_) => None,
        }));
    }
    answers
}

/// The requests that take a module from one scene's constants to another's.
fn requests(from: &TunableConstants, to: &TunableConstants) -> Vec<Command> {
    let mut words = Vec::new();
    for (number, constant) in to {
        let has = from[number].words;
        for (half, number) in [*number, number | SECOND_WORD].into_iter().enumerate() {
            if has[half] != constant.words[half] {
                words.push((number, constant.words[half]));
            }
        }
    }
    assert!(!words.is_empty(), "nothing differs");
    let stages = words
        .iter()
        .map(|(number, word)| Command::Stage(*number, *word));
    let apply = Command::Apply(word_sum(words.iter().copied()));
    [Command::Forget]
        .into_iter()
        .chain(stages)
        .chain([apply])
        .collect()
}

const FORMATS: [(&str, NumberFormat); 3] = [
    ("f32", NumberFormat::Single),
    ("f64", NumberFormat::Double),
    ("fixed", NumberFormat::Fixed),
];

/// A change before the first tick is as good as a scene that had it; but for what the scene's
/// start is computed from, of which there is a test of its own, and of the stop, which the world
/// has too.
#[test]
fn a_module_that_is_set_is_one_of_that_scene() {
    let mut without_effect = Vec::new();
    for set in [
        &["motor.kp=0.08"][..],
        &["motor.kd=0.0009"],
        &["motor.duty_limit=0.3", "motor.homing_duty=0.12"],
        &["motor.slew_per_s=55"],
        &["motor.min_deg=44", "motor.max_deg=91"],
        &["motor.approach_deg_s=222"],
        &["motor.following_limit_deg=1"],
        &["motor.top_speed_deg_s=50"],
        &["motor.continuous_duty=0.01"],
        &["rcp.gain=2.5", "rcp.tau_s=0.4"],
        &["cia.gain=1.9", "cia.tau_s=0.03"],
        &["whisking.noise=0.2"],
        &["sensor.jump_per_s=20"],
        &["classifier.contact_min=0.2"],
        &["classifier.threshold=0.9999999"],
    ] {
        for (numbers, format) in FORMATS {
            let (old, new) = (scene(numbers, &[]), scene(numbers, set));
            let (from, to) = (constants(&old, format), constants(&new, format));
            let mut tuned = run(&old);
            for command in requests(&from, &to) {
                let request = TaggedCommand { tag: 1, command };
                tuned.module_mut().request(request);
            }
            let (found, expected) = (seen(&mut tuned), seen(&mut run(&new)));
            assert!(found == expected, "{set:?}, {numbers}");
            let untouched = seen(&mut run(&old));
            if found == untouched {
                without_effect.push(set);
            }
        }
    }
    assert!(without_effect.is_empty(), "{without_effect:?}");
}

/// A frequency is of the start too: its constants are the scene's, and the whisks come at its
/// pace.
#[test]
fn a_frequency_takes_effect_at_once() {
    for (numbers, format) in FORMATS {
        let free = "plant.obstacle_deg=[170]";
        let old = scene(numbers, &[free]);
        let new = scene(numbers, &[free, "whisking.frequency_hz=5"]);
        let (from, to) = (constants(&old, format), constants(&new, format));
        let mut tuned = run(&old);
        let answered = answers(&mut tuned, &requests(&from, &to));
        assert!(
            answered
                .iter()
                .all(|answer| answer.status == CommandStatus::Done)
        );
        let reads: Vec<_> = to.keys().map(|number| Command::Constant(*number)).collect();
        for (answer, constant) in answers(&mut tuned, &reads).iter().zip(to.values()) {
            assert_eq!(answer.values.map(i32::cast_unsigned), constant.words);
        }
        // From two seconds on: homed, and on its circle.
        let theta: Vec<f64> = (0..14_000).map(|_| tuned.tick().theta_deg[0]).collect();
        let theta = &theta[4_000..];
        let [low, high] =
            [f64::min, f64::max].map(|end| theta.iter().copied().reduce(end).unwrap());
        assert!(high - low > 20.0, "{numbers}: {low} to {high}");
        let middle = low + (high - low) / 2.0;
        let rises = theta
            .windows(2)
            .filter(|two| two[0] < middle && two[1] >= middle);
        let rises = rises.count();
        assert!(
            (24..=26).contains(&rises),
            "{numbers}: {rises} whisks in 5 s"
        );
    }
}

#[test]
fn what_is_incomplete_or_out_of_bounds_changes_nothing() {
    let scene = scene("f32", &[]);
    let from = constants(&scene, NumberFormat::Single);
    let kp = firmware::tunable_number::KP;
    let one = |word: u32| word_sum([(kp, word)].into_iter());
    let apply = |word: f32| {
        let word = word.to_bits();
        [
            Command::Forget,
            Command::Stage(kp, word),
            Command::Apply(one(word)),
        ]
    };
    let mut module = run(&scene);
    let mut refused = |commands: &[Command]| {
        let all = answers(&mut module, commands);
        let last = *all.last().unwrap();
        let mut read = |number| answers(&mut module, &[Command::Constant(number)])[0].values;
        assert_eq!(read(kp).map(i32::cast_unsigned), from[&kp].words);
        assert_eq!(read(0)[0], 1, "f32, and as the scene has it");
        (last.status, last.values[0])
    };
    for bad in [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        -0.1,
        2e3,
        f32::MAX,
    ] {
        let found = refused(&apply(bad));
        assert_eq!(found, (CommandStatus::OutOfRange, kp.into()), "{bad}");
    }
    // One of two is lost on its way, or another word came.
    let [forget, stage, _] = apply(7.0);
    let lost = [forget, Command::Apply(one(7.0_f32.to_bits()))];
    assert_eq!(refused(&lost), (CommandStatus::OutOfRange, 0));
    let another = [forget, stage, Command::Apply(one(7.5_f32.to_bits()))];
    assert_eq!(refused(&another), (CommandStatus::OutOfRange, 0));
    for absent in [0, 31, 70, 127] {
        let found = refused(&[Command::Stage(absent, 0)]);
        assert_eq!(found, (CommandStatus::NotHere, absent.into()), "{absent}");
    }
}

/// An answer may be lost: asking again changes nothing. A module says that it differs, until
/// it has the scene's constants again.
#[test]
fn a_request_may_be_repeated_and_the_difference_is_told() {
    let (old, new) = (scene("fixed", &[]), scene("fixed", &["motor.kp=0.08"]));
    let format = NumberFormat::Fixed;
    let (from, to) = (constants(&old, format), constants(&new, format));
    let mut module = run(&old);
    let mut differs = |commands: Vec<Command>| {
        let twice: Vec<_> = commands.iter().flat_map(|one| [*one; 2]).collect();
        let answered = answers(&mut module, &twice);
        assert!(
            answered
                .iter()
                .all(|answer| answer.status == CommandStatus::Done)
        );
        let [format, sum] = answers(&mut module, &[Command::Constant(0)])[0].values;
        assert_eq!(format & 0xFF, 3);
        (format & wire::SETTINGS_DIFFER.cast_signed() != 0, sum)
    };
    let (before, first) = differs(vec![Command::Forget]);
    let (changed, other) = differs(requests(&from, &to));
    let (back, again) = differs(requests(&to, &from));
    assert_eq!((before, changed, back), (false, true, false));
    assert!(first != other && first == again);
    // A start makes all as the scene has it.
    differs(requests(&from, &to));
    module.reset(old.seed).unwrap();
    let mut fresh = run(&old);
    assert!(seen(&mut module) == seen(&mut fresh));
}
