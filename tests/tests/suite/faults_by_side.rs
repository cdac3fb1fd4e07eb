//! What a fault of one side does to the other: nothing, unless the scene says that all
//! stop; and what is left of the lost side's touch: nothing.

use crate::played::{
    HOLD, Played, TICK_HZ, angles, extent, is_unaffected, of, play, play_once, scene, textured,
    undisturbed,
};
use firmware::design_parameters::RETRY_S;
use firmware::{Event, Place};
use host_sim::bus::WireFault;
use host_sim::run::Run;
use scene::Scene;
use whisking::motor::{Fault, STALL_S};

const SIDES: [Place; 2] = [Place::new(0, 0), Place::new(1, 0)];
const RCP: &str = "[rcp]\ngain = 0.7\ntau_s = 0.0625\n";
const CIA: &str = "[cia]\ngain = 0.5\ntau_s = 0.125\n";
const STOP_ALL: &str = "[motor]\non_fault = \"stop-all\"\n";

/// Both sides whisk against a surface, the right one less far.
fn touching(more: &str) -> Scene {
    scene(1, &textured(90.0), &format!("{RCP}{more}"))
}

/// The ticks from `from` in which a side has contact; its first is after rest.
fn first_touch(played: &Played, side: usize, from: u64) -> u64 {
    let rows = played.rows.iter().enumerate().skip(from as usize);
    let mut touching = rows.filter(|(_, row)| row.contact[side] > 0.2);
    touching.next().map(|(tick, _)| tick as u64).unwrap()
}

fn events_of(played: &Played, place: Place) -> Vec<(u64, Event)> {
    let is_its = |event: &Event| match event {
        Event::SensorLost(at, _)
        | Event::SensorBack(at)
        | Event::MotorFault(at, _)
        | Event::MotorRetry(at) => *at == place,
        _ => false,
    };
    let events = played.events.iter();
    events.filter(|(_, event)| is_its(event)).copied().collect()
}

#[test]
fn a_motor_that_stalls_feels_nothing_while_it_rests() {
    // The guard of the encoder would be first.
    let scene = touching("[motor]\nunmoved_duty = 2\n");
    let sound = undisturbed(&scene, 8000);
    for (side, place) in SIDES.into_iter().enumerate() {
        let start = first_touch(&sound, side, 2000) + 4;
        let played = play(&scene, 8000, |tick, run| {
            let holds = (start..start + 2000).contains(&tick);
            run.motor_mut(side).unwrap().block(holds);
        });
        let [
            (fault, Event::MotorFault(_, Fault::Stall)),
            (retry, Event::MotorRetry(_)),
        ] = events_of(&played, place)[..]
        else {
            panic!("{:?}", played.events);
        };
        // Not before it has been driven hard for so long.
        let expected = start + of(STALL_S)..start + 1500;
        assert!(expected.contains(&fault), "{fault}");
        assert_eq!((retry - fault, played.events.len()), (of(RETRY_S), 2));
        // It is held in the surface all the while.
        let contact = |tick: u64| played.rows[tick as usize].contact[side];
        assert!(contact(fault) > 0.05, "{}", contact(fault));
        assert!((fault + 1..=retry).all(|tick| contact(tick) == 0.0));
        let touches_again = (retry + 1..8000).any(|tick| contact(tick) > 0.2);
        assert!(touches_again);
        is_unaffected(&played, &sound, 1 - side);
    }
}

/// The right whisker touches nothing: what excites it comes from the left.
#[test]
fn a_lost_side_excites_no_other() {
    let plant = "kind = \"ideal\"\nobstacle_deg = [60.0, 300.0]\nstiffness = 0.02\n";
    let scene = scene(1, plant, CIA);
    let sound = undisturbed(&scene, 3000);
    let start = first_touch(&sound, 0, 1000);
    let played = play_once(&scene, 3000, start, |run| {
        run.slave_mut(0).unwrap().set_fault(Some(WireFault::Silent));
    });
    let gain = |played: &Played, tick: u64| played.rows[tick as usize].g;
    let lost = start + HOLD;
    assert!(gain(&played, lost - 1)[1] > 1.1);
    // From the tick of the loss on it only returns, with its time constant; in single
    // precision.
    let decay = (-1.0 / (0.125 * TICK_HZ as f64)).exp();
    for tick in lost..3000 {
        let [before, after] = [tick - 1, tick].map(|tick| gain(&played, tick)[1] - 1.0);
        assert!((after - before * decay).abs() < 1e-7, "{tick}");
    }
    assert!((lost..3000).any(|tick| gain(&sound, tick)[1] > 1.3));
}

#[test]
fn a_fault_of_one_stops_all_where_the_scene_says_so() {
    let scene = touching(STOP_ALL);
    let sound = undisturbed(&scene, 8000);
    let disturbances: [fn(&mut Run, bool); 2] = [
        |run, on| {
            let fault = on.then_some(WireFault::LineLow);
            run.slave_mut(0).unwrap().set_fault(fault);
        },
        |run, on| run.motor_mut(0).unwrap().block(on),
    ];
    for disturb in disturbances {
        let start = first_touch(&sound, 0, 2000);
        let played = play(&scene, 8000, |tick, run| {
            disturb(run, (start..start + 1800).contains(&tick));
        });
        let events = events_of(&played, SIDES[0]);
        let [(fault, _), (gone, _)] = events[..] else {
            panic!("{:?}", played.events);
        };
        assert_eq!(played.events, events, "the other side has no fault");
        // Off: friction and the shorted winding stop it, though θ' goes on.
        let course = angles(&played, 1);
        assert!(extent(&course[fault as usize + 200..gone as usize]) < 0.01);
        assert!(extent(&course[..fault as usize]) > 20.0);
        assert!(extent(&course[gone as usize + 600..]) > 20.0, "again");
        let theta: Vec<f64> = played.rows.iter().map(|row| row.theta_deg[1]).collect();
        assert!(extent(&theta[fault as usize + 200..gone as usize]) > 10.0);
    }
}

/// Its touch ends with the fault, and the next has the next number.
#[test]
fn a_touch_is_over_when_its_sensor_is_lost() {
    let scene = touching("");
    let touches = |run: &Run| -> Vec<Event> {
        let is_touch =
            |event: &&Event| matches!(event, Event::Touch { .. } | Event::TouchEnd { .. });
        run.events().iter().filter(is_touch).copied().collect()
    };
    let mut run = Run::new(&scene, None).unwrap();
    let number = loop {
        run.tick();
        if let [Event::Touch { number: 3, .. }] = touches(&run)[..] {
            break 3;
        }
        assert!(run.row().t_s < 5.0);
    };
    run.slave_mut(0).unwrap().set_fault(Some(WireFault::Silent));
    let place = SIDES[0];
    for tick in 0..=HOLD {
        run.tick();
        let is_last = tick == HOLD;
        let expected = is_last.then_some(Event::TouchEnd { place, number });
        assert_eq!(touches(&run), Vec::from_iter(expected));
    }
    for _ in 0..500 {
        run.tick();
        assert_eq!((run.row().touch[0], touches(&run).len()), (0, 0));
    }
    run.slave_mut(0).unwrap().set_fault(None);
    let next = loop {
        run.tick();
        if let [event] = touches(&run)[..] {
            break event;
        }
        assert!(run.row().t_s < 7.0);
    };
    let number = number + 1;
    assert_eq!(next, Event::Touch { place, number });
}
