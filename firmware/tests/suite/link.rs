//! The link to a PC: answers to requests, and records that find room or are counted.

use firmware::{About, Config, Event, Link, ModelState, Place, Refusal, may_load};
use wire::CommandStatus::{Armed, Done, NoWhisker, NotHere, OutOfRange};
use wire::{Answer, Command, Flags, Load, TaggedCommand, TickRecord, WhiskerId};

use crate::command::{Whiskers, module, nominal, servo, tick};
use crate::hardware::{Bent, feeling, passive};

const SECOND: WhiskerId = WhiskerId { side: 0, number: 1 };

/// A setpoint of 0.3 for the second whisker; setpoints reach from 30 to 140 degrees, θ' being
/// 100 θ + 50.
const SETPOINT: Command = Command::Setpoint(SECOND, q24(0.3));

const fn q24(value: f64) -> i32 {
    (value * 16_777_216.0) as i32
}

struct Desk {
    module: Whiskers<f32>,
    config: Config<f32>,
    link: Link,
}

impl Desk {
    fn new() -> Self {
        let (module, config) = module();
        let link = Link::new();
        Self {
            module,
            config,
            link,
        }
    }

    fn ask(&mut self, command: Command) -> Answer {
        let about = About {
            model: ModelState::Refused(Refusal::Damaged),
        };
        let request = TaggedCommand { tag: 9, command };
        let (module, config) = (&mut self.module, &self.config);
        let answer = self.link.carry_out(module, config, request, about, 41);
        assert_eq!((answer.tag, answer.sequence), (9, 41));
        assert_eq!(answer.command, command.number());
        answer
    }

    /// Duties after so many ticks.
    fn tick(&mut self, count: usize) -> [f64; 2] {
        let mut duties = (0..count).map(|_| tick(&mut self.module, &self.config));
        duties.next_back().unwrap()
    }

    fn records(&mut self, sequence: u32, room: usize) -> Vec<TickRecord> {
        let mut records = Vec::new();
        let (module, config) = (&self.module, &self.config);
        self.link.send(module, config, sequence, &mut |record| {
            let fits = records.len() < room;
            if fits {
                records.push(record);
            }
            fits
        });
        records
    }
}

#[test]
fn what_is_out_of_range_or_not_there_is_refused_and_changes_nothing() {
    let mut desk = Desk::new();
    let nowhere = WhiskerId { side: 1, number: 0 };
    for (command, status) in [
        (SETPOINT, Done),
        (Command::Setpoint(SECOND, q24(0.91)), OutOfRange),
        (Command::Setpoint(SECOND, q24(-0.21)), OutOfRange),
        (Command::Setpoint(nowhere, q24(0.3)), NoWhisker),
        (Command::Gain(SECOND, q24(0.5)), Done),
        (Command::Gain(SECOND, q24(2.01)), OutOfRange),
        (Command::Gain(SECOND, -1), OutOfRange),
        (Command::Gain(SECOND, i32::MIN), OutOfRange),
        (Command::Clear(SECOND), Done),
        (Command::Home(SECOND), NotHere),
        // What a link alone is asked for, without a board's loader.
        (Command::Load(Load::default()), NotHere),
        (Command::Word(0, 0), NotHere),
        (Command::Restart, NotHere),
    ] {
        assert_eq!(desk.ask(command).status, status, "{command:?}");
        let setpoint = servo(&desk.module).setpoint().unwrap();
        assert!((setpoint - 0.3).abs() < 1e-6, "{command:?}");
    }
    assert_eq!(nominal(&desk.module, 1), 0.5);
    desk.ask(Command::Release(SECOND));
    assert_eq!(servo(&desk.module).setpoint(), None);
}

#[test]
fn it_says_what_it_is() {
    let mut desk = Desk::new();
    let mut ask = |command| desk.ask(command).values;
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
    let mut desk = Desk::new();
    desk.ask(SETPOINT);
    assert!((desk.tick(101)[1] - 0.3).abs() < 2e-4);
    assert_eq!(desk.ask(Command::Stop).status, Done);
    assert_eq!(desk.tick(1)[1], 0.0);
    assert_eq!(desk.tick(101)[1], 0.0);
    assert_eq!(desk.ask(Command::Arm).status, Done);
    assert!((desk.tick(101)[1] - 0.3).abs() < 2e-4);
}

#[test]
fn records_report_what_the_tick_has_done() {
    let mut desk = Desk::new();
    desk.ask(SETPOINT);
    desk.ask(Command::Stream(true));
    desk.tick(100);
    let found = desk.records(101, 2);
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
    assert!((felt - desk.module.whiskers()[1].felt()).abs() < 2e-4);
    let still = Flags::FRESH | Flags::VALID;
    assert_eq!(second.flags, still | Flags::ARMED | Flags::RUNNING);

    desk.ask(Command::Stop);
    desk.tick(1);
    let second = desk.records(102, 2)[1];
    assert_eq!((second.duty, second.flags), (0, still));

    let place = Place::new(0, 1);
    desk.link.note(&Event::Touch { place, number: 1 });
    desk.link.note(&Event::MotorGivenUp(place));
    let once = still | Flags::FAULT;
    let found = desk.records(103, 2).into_iter();
    assert!(
        found
            .map(|record| record.flags)
            .eq([once, once | Flags::TOUCHING])
    );
    desk.link.note(&Event::TouchEnd { place, number: 1 });
    let found = desk.records(104, 2).into_iter();
    assert!(found.map(|record| record.flags).eq([still; 2]));
}

#[test]
fn records_without_room_are_lost_whole_and_counted() {
    let mut desk = Desk::new();
    assert!(desk.records(1, 2).is_empty());
    assert!(!desk.link.streams(), "none were asked for");
    desk.ask(Command::Stream(true));
    for tick in 2..5 {
        assert!(desk.records(tick, 0).is_empty());
    }
    assert_eq!(desk.ask(Command::Status).values, [6, 0]);
    let found = [5, 6].map(|tick| desk.records(tick, 2)).concat();
    let lost = found
        .iter()
        .map(|record| record.flags.contains(Flags::LOST));
    assert!(lost.eq([true, false, false, false]));
    desk.ask(Command::Stream(false));
    assert!(!desk.link.streams());
}

#[test]
fn a_passive_module_streams_and_refuses_what_needs_a_motor() {
    let config = feeling::<f32>(None);
    let mut module = passive(&config, [Bent(0xC000)]);
    let mut link = Link::new();
    let about = About {
        model: ModelState::NotHere,
    };
    let left = WhiskerId::default();
    for command in [
        Command::Arm,
        Command::Stop,
        Command::Home(left),
        Command::Gain(left, q24(1.0)),
        Command::Setpoint(left, 0),
    ] {
        let request = TaggedCommand { tag: 1, command };
        let answer = link.carry_out(&mut module, &config, request, about, 0);
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
}
