//! The link to a PC: answers to requests, and records that find room or are counted.

use firmware::{About, Config, Event, Link, ModelState, Place, Refusal, may_load};
use wire::CommandStatus::{Armed, Done, NoWhisker, NotHere, OutOfRange};
use wire::{Answer, Command, Flags, Load, TaggedCommand, TickRecord, WhiskerId};

use crate::command::{Whiskers, module, nominal, servo, tick};
use crate::hardware::{Bent, feeling, passive};

const ABOUT: About = About {
    model: ModelState::Refused(Refusal::Damaged),
};

fn ask(
    link: &mut Link,
    module: &mut Whiskers<f32>,
    config: &Config<f32>,
    command: Command,
) -> Answer {
    let request = TaggedCommand { tag: 9, command };
    let answer = link.carry_out(module, config, request, ABOUT, 41);
    assert_eq!((answer.tag, answer.sequence), (9, 41));
    assert_eq!(answer.command, command.number());
    answer
}

fn records(
    link: &mut Link,
    module: &Whiskers<f32>,
    config: &Config<f32>,
    (sequence, room): (u32, usize),
) -> Vec<TickRecord> {
    let mut records = Vec::new();
    link.send(module, config, sequence, &mut |record| {
        let fits = records.len() < room;
        if fits {
            records.push(record);
        }
        fits
    });
    records
}

const fn q24(value: f64) -> i32 {
    (value * 16_777_216.0) as i32
}

const SECOND: WhiskerId = WhiskerId { side: 0, number: 1 };

#[test]
fn what_is_out_of_range_or_not_there_is_refused_and_changes_nothing() {
    let (mut module, config) = module::<f32>();
    let mut link = Link::new();
    let nowhere = WhiskerId { side: 1, number: 0 };
    // Setpoints reach from 30 to 140 degrees, θ' being 100 θ + 50.
    for (command, status) in [
        (Command::Setpoint(SECOND, q24(0.3)), Done),
        (Command::Setpoint(SECOND, q24(0.91)), OutOfRange),
        (Command::Setpoint(SECOND, q24(-0.21)), OutOfRange),
        (Command::Setpoint(nowhere, q24(0.3)), NoWhisker),
        (Command::Gain(SECOND, q24(0.5)), Done),
        (Command::Gain(SECOND, q24(2.01)), OutOfRange),
        (Command::Gain(SECOND, -1), OutOfRange),
        (Command::Gain(SECOND, i32::MIN), OutOfRange),
        (Command::Clear(SECOND), Done),
        (Command::Home(SECOND), NotHere),
    ] {
        let answer = ask(&mut link, &mut module, &config, command);
        assert_eq!(answer.status, status, "{command:?}");
        let setpoint = servo(&module).setpoint().unwrap();
        assert!((setpoint - 0.3).abs() < 1e-6, "{command:?}");
    }
    assert_eq!(nominal(&module, 1), 0.5);
    ask(&mut link, &mut module, &config, Command::Release(SECOND));
    assert_eq!(servo(&module).setpoint(), None);
}

#[test]
fn it_says_what_it_is() {
    let (mut module, config) = module::<f32>();
    let mut link = Link::new();
    let mut ask = |command| ask(&mut link, &mut module, &config, command).values;
    assert_eq!(ask(Command::Hello), [2000, 2]);
    let letters = |values: [i32; 2]| values.map(i32::to_le_bytes).concat();
    assert_eq!(letters(ask(Command::Name(0))), b"a scene ");
    assert_eq!(letters(ask(Command::Name(8))), b"of bench");
    assert_eq!(letters(ask(Command::Name(13))), b"nch\0\0\0\0\0");
    assert_eq!(letters(ask(Command::Name(255))), [0; 8]);
    let [numbers, patch] = ask(Command::Version);
    let version = format!("{}.{}.{patch}", numbers >> 16, numbers & 0xFFFF);
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
    assert_eq!(ask(Command::Model), [0, -5]);
}

#[test]
fn a_motor_is_off_in_the_tick_after_stop_and_armed_only_by_command() {
    let (mut module, config) = module::<f32>();
    let mut link = Link::new();
    let setpoint = Command::Setpoint(SECOND, q24(0.3));
    ask(&mut link, &mut module, &config, setpoint);
    let driven = |module: &mut Whiskers<f32>| {
        for _ in 0..100 {
            tick(module, &config);
        }
        tick(module, &config)[1]
    };
    assert!((driven(&mut module) - 0.3).abs() < 2e-4);
    let mut done = |module: &mut Whiskers<f32>, command| {
        let answer = ask(&mut link, module, &config, command);
        assert_eq!(answer.status, Done);
    };
    done(&mut module, Command::Stop);
    assert_eq!(tick(&mut module, &config)[1], 0.0);
    assert_eq!(driven(&mut module), 0.0);
    done(&mut module, Command::Arm);
    assert!((driven(&mut module) - 0.3).abs() < 2e-4);
}

#[test]
fn records_report_what_the_tick_has_done() {
    let (mut module, config) = module::<f32>();
    let mut link = Link::new();
    let setpoint = Command::Setpoint(SECOND, q24(0.3));
    ask(&mut link, &mut module, &config, setpoint);
    ask(&mut link, &mut module, &config, Command::Stream(true));
    for _ in 0..100 {
        tick(&mut module, &config);
    }
    let found = records(&mut link, &module, &config, (101, 2));
    let [first, second] = found[..] else {
        panic!("a record for each whisker: {found:?}");
    };
    // The code 0xC000 is bent to the right by half; the whisker stands at rest.
    assert_eq!(second.codes(), [0xC000 >> 2, 8192]);
    assert_eq!((second.sequence, first.sequence), (101, 101));
    assert!((wire::degrees(second.setpoint) - 80.0).abs() < 0.02);
    assert!((wire::degrees(second.measured) - 50.0).abs() < 0.02);
    assert!((f64::from(second.duty) / 32_767.0 - 0.3).abs() < 2e-4);
    let felt = wire::unit(second.contact);
    assert!((felt - module.whiskers()[1].felt()).abs() < 2e-4, "{felt}");
    let running = Flags::FRESH | Flags::VALID | Flags::ARMED | Flags::RUNNING;
    assert_eq!(second.flags, running);

    ask(&mut link, &mut module, &config, Command::Stop);
    tick(&mut module, &config);
    let second = records(&mut link, &module, &config, (102, 2))[1];
    assert_eq!(second.duty, 0);
    assert_eq!(second.flags, Flags::FRESH | Flags::VALID);

    let place = Place::new(0, 1);
    link.note(&Event::Touch { place, number: 1 });
    link.note(&Event::MotorGivenUp(place));
    let flags = |found: Vec<TickRecord>| [found[0].flags, found[1].flags];
    let touched = flags(records(&mut link, &module, &config, (103, 2)));
    let still = Flags::FRESH | Flags::VALID;
    let once = still | Flags::FAULT;
    assert_eq!(touched, [once, once | Flags::TOUCHING]);
    link.note(&Event::TouchEnd { place, number: 1 });
    let ended = flags(records(&mut link, &module, &config, (104, 2)));
    assert_eq!(ended, [still; 2]);
}

#[test]
fn records_without_room_are_lost_whole_and_counted() {
    let (mut module, config) = module::<f32>();
    let mut link = Link::new();
    assert!(records(&mut link, &module, &config, (1, 2)).is_empty());
    assert!(!link.streams(), "none were asked for");
    ask(&mut link, &mut module, &config, Command::Stream(true));
    for tick in 2..5 {
        assert!(records(&mut link, &module, &config, (tick, 0)).is_empty());
    }
    let answer = ask(&mut link, &mut module, &config, Command::Status);
    assert_eq!(answer.values, [6, 0]);
    let found = [5, 6].map(|tick| records(&mut link, &module, &config, (tick, 2)));
    let lost: Vec<bool> = found
        .iter()
        .flatten()
        .map(|record| record.flags.contains(Flags::LOST))
        .collect();
    assert_eq!(lost, [true, false, false, false]);
    ask(&mut link, &mut module, &config, Command::Stream(false));
    assert!(!link.streams());
}

#[test]
fn a_passive_module_streams_and_refuses_what_needs_a_motor() {
    let config = feeling::<f32>(None);
    let mut module = passive(&config, [Bent(0xC000)]);
    let mut link = Link::new();
    let left = WhiskerId::default();
    for command in [
        Command::Arm,
        Command::Stop,
        Command::Home(left),
        Command::Gain(left, q24(1.0)),
        Command::Setpoint(left, 0),
    ] {
        let request = TaggedCommand { tag: 1, command };
        let answer = link.carry_out(&mut module, &config, request, ABOUT, 0);
        assert_eq!(answer.status, NoWhisker, "{command:?}");
    }
}

#[test]
fn a_scene_is_loaded_with_motors_off_and_where_there_is_room() {
    let load = |config, model| Load { config, model };
    let room = load(100, 8);
    assert_eq!(may_load(load(9, 1), room, true), Err(Armed));
    for (asked, status) in [
        (load(0, 1), Err(OutOfRange)),
        (load(4, 1), Err(OutOfRange)),
        (load(5, 0), Ok(())),
        (load(100, 8), Ok(())),
        (load(101, 8), Err(OutOfRange)),
        (load(100, 9), Err(OutOfRange)),
        (load(u16::MAX, u16::MAX), Err(OutOfRange)),
    ] {
        assert_eq!(may_load(asked, room, false), status, "{asked:?}");
    }
    // What a link alone is asked for, without a board's loader.
    let (mut module, config) = module::<f32>();
    let mut link = Link::new();
    let of_a_loader = [
        Command::Load(load(9, 1)),
        Command::Word(0, 0),
        Command::Restart,
    ];
    for command in of_a_loader {
        let answer = ask(&mut link, &mut module, &config, command);
        assert_eq!(answer.status, NotHere, "{command:?}");
    }
}
