//! A scene played tick by tick, with a hand on its sensors.

use config::{RunsOn, Target};
use firmware::design_parameters::{HOLD_S, RECOVER_S, ticks};
use firmware::{Event, Place, SensorFault};
use host_sim::run::Run;
use host_sim::trace::Row;
use mlx90333::FRAME_LEN;
use scene::Scene;
use whisking::motor::Fault;

/// Ticks a second of [`scene`].
pub(crate) const TICK_HZ: u64 = 2000;

/// Ticks for which a reading is held, and good ones before a whisker moves again.
pub(crate) const HOLD: u64 = of(HOLD_S);
pub(crate) const RECOVER: u64 = of(RECOVER_S);

/// So many seconds, in ticks.
pub(crate) const fn of(seconds: f64) -> u64 {
    ticks(seconds, TICK_HZ as u32) as u64
}

/// The first whisker of the left side.
pub(crate) const LEFT: Place = Place::new(0, 0);

/// What a board without a model is configured for.
pub(crate) const BOARD: Target<'_> = Target {
    runs_on: RunsOn::Board,
    gate: None,
    classes: None,
    overrides: "",
};

/// What came of a scene; a row a tick.
#[derive(Default)]
pub(crate) struct Played {
    pub(crate) rows: Vec<Row>,
    /// Events but touches and frames, with their tick, from 0.
    pub(crate) events: Vec<(u64, Event)>,
    /// Frames that were shown, with their tick.
    pub(crate) frames: Vec<(u64, Place, [u8; FRAME_LEN])>,
    /// What was listened to: tick and codes x, y of the left first whisker.
    pub(crate) heard: Vec<(u64, [u16; 2])>,
}

/// A scene of both sides, 4 whisks a second with noise, at rest for the first
/// quarter of a second or so; `plant` and `more` follow.
pub(crate) fn scene(whiskers_per_side: usize, plant: &str, more: &str) -> Scene {
    let whisking = "frequency_hz = 4.0\ncoupling = true\nnoise = 0.005\ngain = 1.0\n\
                    start = [[1.0, 0.0], [0.9, 0.1]]";
    let head = format!("whiskers_per_side = {whiskers_per_side}");
    read(&head, whisking, plant, more)
}

/// One whisker in free air that whisks so often a second; keys of its motor follow.
pub(crate) fn alone(frequency_hz: f64, motor: &str) -> Scene {
    let whisking = format!("frequency_hz = {frequency_hz:?}\nnoise = 0.005\ngain = 1.0");
    alone_with(&whisking, motor)
}

/// The same with these keys of its whisking.
pub(crate) fn alone_with(whisking: &str, motor: &str) -> Scene {
    let plant = textured(300.0).replace("[300.0, 300.0]", "[300.0]");
    let whisking = format!("{whisking}\ncoupling = false\nstart = [[1.0, 0.0]]");
    let head = "whiskers_per_side = 1\nsides = \"left\"";
    read(head, &whisking, &plant, &format!("[motor]\n{motor}"))
}

fn read(head: &str, whisking: &str, plant: &str, more: &str) -> Scene {
    let text = format!(
        "name = \"played\"\ntick_hz = {TICK_HZ}\nduration_s = 20\nseed = 1\n[head]\n{head}\n\
         [whisking]\nintegrator = \"exact\"\n{whisking}\n[plant]\n{plant}\n{more}"
    );
    Scene::from_str("played.toml", &text).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Simulated motors, whiskers and a smooth surface at an angle.
pub(crate) fn textured(at_deg: f64) -> String {
    format!(
        "kind = \"textured\"\nobstacle_deg = [{at_deg:?}, {at_deg:?}]\nstiffness = 0.1\n\
         textures = [\"smooth\"]\npresent_s = 100000\n"
    )
}

/// Plays `ticks` of a scene; `act` is called before each.
pub(crate) fn play(scene: &Scene, ticks: u64, act: impl FnMut(u64, &mut Run)) -> Played {
    play_until(scene, ticks, |_| false, act)
}

/// A motor that was given up is off for good: it coasts no longer than this.
const COASTS: u64 = 2 * TICK_HZ;

/// The same, to the end of what the left motor does once it is given up, if it is.
pub(crate) fn play_until_given_up(
    scene: &Scene,
    ticks: u64,
    act: impl FnMut(u64, &mut Run),
) -> Played {
    let ends = |event: &Event| *event == Event::MotorGivenUp(LEFT);
    play_until(scene, ticks, ends, act)
}

fn play_until(
    scene: &Scene,
    mut ticks: u64,
    ends: impl Fn(&Event) -> bool,
    mut act: impl FnMut(u64, &mut Run),
) -> Played {
    let mut run = Run::new(scene, None).unwrap();
    let mut played = Played::default();
    let mut tick = 0;
    while tick < ticks {
        act(tick, &mut run);
        played.rows.push(run.tick());
        for event in run.events() {
            match *event {
                Event::Touch { .. } | Event::TouchEnd { .. } => {}
                Event::Frame(place, bytes) => played.frames.push((tick, place, bytes)),
                event => played.events.push((tick, event)),
            }
        }
        let sample = run.sample();
        played
            .heard
            .extend(sample.map(|sample| (tick, sample.codes)));
        if run.events().iter().any(&ends) {
            ticks = ticks.min(tick + COASTS);
        }
        tick += 1;
    }
    played
}

/// Plays `ticks` of a scene, in which something is done once, before a tick.
pub(crate) fn play_once(scene: &Scene, ticks: u64, at: u64, act: impl Fn(&mut Run)) -> Played {
    play(scene, ticks, |tick, run| {
        if tick == at {
            act(run);
        }
    })
}

pub(crate) fn undisturbed(scene: &Scene, ticks: u64) -> Played {
    play(scene, ticks, |_, _| {})
}

/// Motors that whisk freely, with these keys of theirs.
pub(crate) fn free_with(motor: &str) -> Scene {
    scene(1, &textured(300.0), &format!("[motor]\n{motor}"))
}

/// Motors that whisk freely; contact suppresses, but there is none.
pub(crate) fn free(whiskers_per_side: usize) -> Scene {
    let rcp = "[rcp]\ngain = 0.7\ntau_s = 0.0625\n";
    scene(whiskers_per_side, &textured(300.0), rcp)
}

/// Where the first whisker of a side is, tick by tick.
pub(crate) fn angles(played: &Played, side: usize) -> Vec<f64> {
    played.rows.iter().map(|row| row.angle_deg[side]).collect()
}

/// How far the left whisker is from its setpoint, degrees.
pub(crate) fn error_deg(row: &Row) -> f64 {
    (row.theta_deg[0] - row.angle_deg[0]).abs()
}

/// The largest of these distances from a tick on.
pub(crate) fn farthest(played: &Played, from: u64) -> f64 {
    let rows = played.rows[from as usize..].iter();
    rows.map(error_deg).fold(0.0, f64::max)
}

/// The faults of the left motor with their ticks.
pub(crate) fn faults(played: &Played) -> Vec<(u64, Fault)> {
    let fault = |(tick, event): &(u64, Event)| match event {
        Event::MotorFault(LEFT, fault) => Some((*tick, *fault)),
        _ => None,
    };
    played.events.iter().filter_map(fault).collect()
}

/// The only fault, the left sensor's: its tick, what it was, and when the sensor came back, if it
/// did.
#[track_caller]
pub(crate) fn lost(played: &Played) -> (u64, SensorFault, Option<u64>) {
    match played.events[..] {
        [(tick, Event::SensorLost(LEFT, fault))] => (tick, fault, None),
        [
            (tick, Event::SensorLost(LEFT, fault)),
            (back, Event::SensorBack(LEFT)),
        ] => (tick, fault, Some(back)),
        ref other => panic!("{other:?}"),
    }
}

/// θ′ of the left whisker, tick by tick.
pub(crate) fn setpoints(played: &Played) -> Vec<f64> {
    played.rows.iter().map(|row| row.theta_deg[0]).collect()
}

pub(crate) fn extent(values: &[f64]) -> f64 {
    let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    top - values.iter().copied().fold(f64::INFINITY, f64::min)
}

pub(crate) fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

/// What is of a side in a row is the same to the last bit.
#[track_caller]
pub(crate) fn is_unaffected(played: &Played, sound: &Played, side: usize) {
    let course = |played: &Played| -> Vec<[f64; 7]> {
        let rows = played.rows.iter();
        rows.map(|row| row.pairs().map(|pair| pair[side])).collect()
    };
    assert!(course(played) == course(sound));
}
