//! Another configuration for a module: as if its scene had been that one from the start.

use firmware::{
    BoardCode, ConfigBytes, ConfigError, Field, HEADER_BYTES, Header, Packet, encode, refusal_of,
};
use host_sim::bench::config_of;
use host_sim::bus::WireFault;
use host_sim::run::Run;
use scene::{Override, Scene};
use whisking::{Fix, Number};
use wire::{Answer, CONFIG_CHANGED, Command, CommandStatus, TaggedCommand};

use crate::common::{SEQUENTIAL, TEXTURED, its_model, run};

const CIA: &str = "[cia]\ngain = 0.5\ntau_s = 0.2\n";

/// Of a text, in a number format, with keys that blanks stand between.
fn scene_of(text: &str, numbers: &str, set: &str) -> Scene {
    let numbers = format!("whisking.numbers={numbers}");
    let own = [numbers.as_str(), "motor.rest=find", "motor.stop_deg=30"];
    let all = own.into_iter().chain(set.split_whitespace());
    let set: Vec<Override> = all.map(|one| one.parse().unwrap()).collect();
    Scene::from_str_with("s.toml", text, &set).unwrap().0
}

/// Every part that can be tuned, in a number format.
fn scene(numbers: &str, set: &str) -> Scene {
    let text = format!("{TEXTURED}{SEQUENTIAL}contact_min = 0.05\n{CIA}");
    scene_of(&text, numbers, set)
}

fn field(name: &str) -> Field {
    let mut all = Field::ALL.iter().copied();
    all.find(|field| format!("{field:?}") == name).unwrap()
}

fn bytes_for<R: Number>(scene: &Scene, board: BoardCode) -> ConfigBytes {
    let classes = config::classes(scene, &its_model()).unwrap();
    let config = config_of::<R>(scene, (None, Some(&classes)), false, "").unwrap();
    encode(&config, board).unwrap()
}

fn bytes_of<R: Number>(scene: &Scene) -> ConfigBytes {
    bytes_for::<R>(scene, BoardCode::Simulation)
}

type BytesOf = fn(&Scene) -> ConfigBytes;

const FORMATS: [(&str, BytesOf); 3] = [
    ("f32", bytes_of::<f32>),
    ("f64", bytes_of::<f64>),
    ("fixed", bytes_of::<Fix>),
];

/// All that a run shows in two seconds, to the last bit; its sensor is frozen for a while.
fn seen(run: &mut Run) -> (Vec<u64>, Vec<String>) {
    let (mut rows, mut events) = (Vec::new(), Vec::new());
    for tick in 0..4_000 {
        let fault = (3_000..3_100).contains(&tick).then_some(WireFault::Frozen);
        run.slave_mut(0).unwrap().set_fault(fault);
        let row = run.tick();
        let pairs = row.pairs();
        rows.extend(pairs.as_flattened().iter().map(|value| value.to_bits()));
        events.extend(run.events().iter().map(|event| format!("{event:?}")));
    }
    (rows, events)
}

fn answers(run: &mut Run, commands: &[Command]) -> Vec<Answer> {
    let mut answers = Vec::new();
    for (tag, command) in (1..).zip(commands) {
        let command = *command;
        run.module_mut().request(TaggedCommand { tag, command });
        run.tick();
        let packets = run.module_mut().take_packets();
        answers.extend(packets.iter().filter_map(|packet| match packet {
            Packet::Answer(answer) => Some(*answer),
            Packet::Record(_) | Packet::Event(_) => None,
        }));
    }
    answers
}

fn is_done(answer: &Answer) -> bool {
    answer.status == CommandStatus::Done
}

fn answer(run: &mut Run, commands: &[Command]) -> (CommandStatus, [i32; 2]) {
    let last = *answers(run, commands).last().unwrap();
    (last.status, last.values)
}

fn requests(bytes: &[u8]) -> Vec<Command> {
    let mut requests = vec![Command::Forget];
    for (number, four) in bytes.chunks(4).enumerate() {
        let mut word = [0; 4];
        word[..four.len()].copy_from_slice(four);
        requests.push(Command::Stage(number as u8, u32::from_le_bytes(word)));
    }
    requests.push(Command::Apply(bytes.len() as u32));
    requests
}

/// The configuration that a module runs by, word by word, and whether it is another than that
/// of the start.
fn running(run: &mut Run) -> (Vec<u8>, bool) {
    let (status, [crc, length]) = answer(run, &[Command::Scene]);
    assert_eq!(status, CommandStatus::Done);
    let (length, is_other) = (length & !CONFIG_CHANGED, length & CONFIG_CHANGED != 0);
    let words = (length as u32).div_ceil(4);
    let reads: Vec<_> = (0..words).step_by(2).map(Command::Config).collect();
    let read = answers(run, &reads);
    let two = read.iter().flat_map(|answer| answer.values);
    let mut bytes: Vec<u8> = two.flat_map(i32::to_le_bytes).collect();
    let rest = bytes.split_off(length as usize);
    assert!(rest.iter().all(|byte| *byte == 0));
    assert_eq!(Header::of(&bytes).unwrap().crc, crc.cast_unsigned());
    let (status, _) = answer(run, &[Command::Config(words)]);
    assert_eq!(status, CommandStatus::OutOfRange);
    (bytes, is_other)
}

/// Keys that can be set while a module runs, behind what the scene has before, and the field of
/// those whose limit protects. But for what the scene's start is computed from, of which there is a
/// test of its own, and of the stop, which the world has too: the other one would move with the
/// margin. A motor of 50 degrees a second whisks only where nothing is asked of its winding.
const FREE: &str = "
    | motor.kp=0.08 |
    | motor.kd=0.0009 |
    motor.kp=0.004 motor.kd=0.0012 | motor.slew_per_s=35 |
    | motor.approach_deg_s=222 |
    | rcp.gain=2.5 rcp.tau_s=0.4 |
    | cia.gain=1.9 cia.tau_s=0.03 |
    | whisking.noise=0.2 |
    | classifier.contact_min=0.2 |
    | classifier.threshold=0.9999999 |
    | classifier.prior={smooth=0.999} |
    classifier.prior={smooth=0.999} | classifier.prior={smooth=0.2} |
    classifier.threshold=0.6 | classifier.thresholds={smooth=0.9999999,carpet=0.9999999} |
    | motor.duty_limit=0.3 motor.homing_duty=0.12 | Guards
    | motor.min_deg=44 motor.max_deg=91 | Guards
    motor.max_deg=90 motor.far_stop_deg=100 | motor.travel_margin_deg=0 | Guards
    | motor.following_limit_deg=1 | Guards
    motor.continuous_duty=1 | motor.top_speed_deg_s=50 | Guards
    motor.kp=0.002 | motor.unmoved_duty=0 | Guards
    whisking.frequency_hz=0.5 | motor.continuous_duty=0.02 | Guards
    | motor.homing_duty=0.12 | Homing
    | sensor.jump_per_s=20 | SensorLimits
    | sensor.frozen_s=0.02 | SensorLimits";

/// A change before the first tick is as good as a scene that had it. A limit that protects
/// changes only while no motor is armed.
#[test]
fn a_module_that_is_set_is_one_of_that_scene() {
    let mut without_effect = Vec::new();
    for row in FREE.trim_start().lines() {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let (base, set, protects) = (cells[0], cells[1], cells[2]);
        for (numbers, bytes_of) in FORMATS {
            let old = scene(numbers, base);
            let new = scene(numbers, &[base, set].join(" "));
            let mut commands = requests(&bytes_of(&new));
            if !protects.is_empty() {
                let mut armed = run(&old);
                let (status, values) = answer(&mut armed, &commands);
                assert_eq!(status, CommandStatus::Armed, "{set}, {numbers}");
                let refusal = ConfigError::Armed(field(protects));
                assert_eq!(refusal_of(values), Some(refusal));
                let (bytes, is_other) = running(&mut armed);
                assert!(bytes == *bytes_of(&old) && !is_other);
                commands.insert(0, Command::Stop);
                commands.push(Command::Arm);
            }
            let mut tuned = run(&old);
            for command in commands {
                let request = TaggedCommand { tag: 1, command };
                tuned.module_mut().request(request);
            }
            let (found, expected) = (seen(&mut tuned), seen(&mut run(&new)));
            assert!(found == expected, "{set}, {numbers}");
            let (bytes, is_other) = running(&mut tuned);
            assert!(bytes == *bytes_of(&new) && is_other);
            if found == seen(&mut run(&old)) {
                without_effect.push((set, numbers));
            }
        }
    }
    assert!(without_effect.is_empty(), "{without_effect:?}");
}

/// A frequency is of the start too: a module has its constants at once, and the whisks come at
/// its pace.
#[test]
fn a_frequency_takes_effect_at_once() {
    for (numbers, bytes_of) in FORMATS {
        let free = "plant.obstacle_deg=[170]";
        let old = scene(numbers, free);
        let new = scene(numbers, &format!("{free} whisking.frequency_hz=5"));
        let mut tuned = run(&old);
        let answered = answers(&mut tuned, &requests(&bytes_of(&new)));
        assert!(answered.iter().all(is_done));
        assert_eq!(running(&mut tuned), (bytes_of(&new).to_vec(), true));
        // From two seconds on: homed, and on its circle.
        let theta: Vec<f64> = (0..14_000).map(|_| tuned.tick().theta_deg[0]).collect();
        let theta = &theta[4_000..];
        let [low, high] =
            [f64::min, f64::max].map(|end| theta.iter().copied().reduce(end).unwrap());
        assert!(high - low > 20.0, "{numbers}: {low} to {high}");
        let middle = low + (high - low) / 2.0;
        let pairs = theta.windows(2);
        let rises = pairs.filter(|two| two[0] < middle && two[1] >= middle);
        let rises = rises.count();
        assert!((24..=26).contains(&rises), "{numbers}: {rises} in 5 s");
    }
}

fn refused(run: &mut Run, bytes: &[u8]) -> ConfigError {
    let before = running(run);
    let (status, values) = answer(run, &requests(bytes));
    assert_eq!(status, CommandStatus::OutOfRange);
    assert_eq!(running(run), before);
    refusal_of(values).unwrap()
}

const FIXED: &str = "
    name=other | Name
    tick_hz=4000 | TickHz
    head.sides=both whisking.start=[[1,0],[1,0]] plant.obstacle_deg=[80,80] | Sides
    head.whiskers_per_side=2 | Whiskers
    sensor.mode=slow tick_hz=500 | TickHz
    sensor.zero_after_s=10 | Zero
    sensor.self_motion_s=2 | SelfMotion
    telemetry.rtt=false | Links
    whisking.integrator=euler | Integrator
    whisking.noise=0 | Noise
    seed=2 | Seed
    motor.driver=six-step | Driver
    motor.on_fault=stop-all | OnFault
    motor.arm=on-command | Arm
    motor.rest=at-start | Homing
    motor.gear=12 | Encoder";

#[test]
fn what_a_module_is_built_from_is_refused_by_its_name() {
    let text = format!("{TEXTURED}{SEQUENTIAL}");
    for (numbers, bytes_of) in FORMATS {
        let mut module = run(&scene(numbers, ""));
        for row in FIXED.trim().lines() {
            let (set, name) = row.split_once(" | ").unwrap();
            let found = refused(&mut module, &bytes_of(&scene(numbers, set)));
            assert_eq!(found, ConfigError::Shape(field(name)), "{set}, {numbers}");
        }
        // Parts that come and go.
        for (has, lacks) in [
            (CIA, Field::ContactMin),
            ("contact_min = 0.05\n", Field::Cia),
        ] {
            let without = scene_of(&format!("{text}{has}"), numbers, "");
            let found = refused(&mut module, &bytes_of(&without));
            assert_eq!(found, ConfigError::Shape(lacks));
        }
    }
}

/// Why bytes are none is for the tests of the firmware.
#[test]
fn what_is_no_configuration_for_it_changes_nothing() {
    let scene = scene("f32", "");
    let good = bytes_of::<f32>(&scene).to_vec();
    let mut module = run(&scene);
    assert_eq!(refused(&mut module, &[]), ConfigError::Absent);
    let cut = &good[..good.len() - 1];
    assert_eq!(refused(&mut module, cut), ConfigError::TooLong);
    for place in (HEADER_BYTES..good.len()).step_by(29) {
        let mut bytes = good.clone();
        bytes[place] ^= 0x10;
        let found = refused(&mut module, &bytes);
        assert_eq!(found, ConfigError::Damaged, "byte {place}");
    }
    let board = bytes_for::<f32>(&scene, BoardCode::NucleoF446re);
    assert_eq!(refused(&mut module, &board), ConfigError::Board(1));
    for kp in [f32::NAN, f32::MAX] {
        let mut config = config_of::<f32>(&scene, (None, None), false, "").unwrap();
        config.motion.as_mut().unwrap().servo.pd.kp = kp;
        let bytes = encode(&config, BoardCode::Simulation).unwrap();
        let found = refused(&mut module, &bytes);
        assert_eq!(found, ConfigError::Range(Field::Kp), "{kp}");
    }
    // A word is lost on its way, or more are asked for than came.
    let before = running(&mut module);
    let mut commands = requests(&good);
    let apply = commands.pop().unwrap();
    commands.remove(4);
    let found = answer(&mut module, &commands);
    assert_eq!(found, (CommandStatus::OutOfRange, [3, 0]));
    let (status, values) = answer(&mut module, &[apply]);
    assert_eq!(status, CommandStatus::OutOfRange);
    assert_eq!(refusal_of(values), Some(ConfigError::TooLong));
    assert_eq!(running(&mut module), before);
}

/// An answer may be lost: asking again changes nothing. A module says that it differs, until
/// it has the scene's configuration again.
#[test]
fn a_request_may_be_repeated_and_the_difference_is_shown() {
    let (old, new) = (scene("fixed", ""), scene("fixed", "motor.kd=0.0009"));
    let [from, to] = [&old, &new].map(|scene| bytes_of::<Fix>(scene).to_vec());
    let mut module = run(&old);
    let mut after = |commands: Vec<Command>| {
        let twice: Vec<_> = commands.iter().flat_map(|one| [*one; 2]).collect();
        let answered = answers(&mut module, &twice);
        assert!(answered.iter().all(is_done));
        running(&mut module)
    };
    assert_eq!(after(vec![Command::Forget]), (from.clone(), false));
    assert_eq!(after(requests(&to)), (to.clone(), true));
    assert_eq!(after(requests(&from)), (from, false));
    // A start makes all as the scene has it.
    after(requests(&to));
    module.reset(old.seed).unwrap();
    assert!(seen(&mut module) == seen(&mut run(&old)));
}
