//! The whole head: twelve whiskers a side, with motors, elastic shafts and sensors, before
//! obstacles, moved by the module (BIOTACT section III-D, Figs. 7 and 9).

use anyhow::Result;
use rayon::prelude::*;
use scene::{GateSettings, Scene};

use super::patterns::{FREQUENCY_HZ, LEFT, RIGHT, Row, TICK_HZ, WHISK, angles, contacts};
use crate::experiment::request::Request;
use crate::page::{Page, figure, row};
use crate::paper::biotact::{FIG9, OBSTACLES_DEG};
use host_sim::run::Run;

/// Whisks that are left out, as the motors settle, and those that are measured.
const LEAD: usize = 4;
const WHISKS: usize = 16;

/// The head without obstacles, with the noise and the gains of the head's experiments.
fn head(request: &Request) -> Result<Scene> {
    let rig = &request.rigs.head;
    let (kp, kd) = (rig.motor.kp, rig.motor.kd);
    let text = format!(
        "name = 'array'\ntick_hz = {TICK_HZ}\nduration_s = {}\nseed = {}\n\
         [head]\nwhiskers_per_side = 12\n\
         [whisking]\nfrequency_hz = {FREQUENCY_HZ:?}\nintegrator = 'exact'\ncoupling = true\n\
         noise = {:?}\ngain = 1.0\nstart = [[1.0, 0.0], [1.0, 0.0]]\n\
         [motor]\nkp = {kp:?}\nkd = {kd:?}\n\
         [plant]\nkind = 'whisker'\ntextures = ['smooth']\npresent_s = 1000.0\n\
         obstacle_deg = [{NOTHING:?}, {NOTHING:?}]\nstiffness = 0.1\n",
        (LEAD + WHISKS) as f64 / FREQUENCY_HZ,
        // A seed of TOML has 63 bits.
        request.seed & (u64::MAX >> 1),
        rig.noise,
    );
    Ok(Scene::from_str("array.toml", &text)?)
}

/// Where no whisker comes, degrees.
const NOTHING: f64 = 300.0;

const LEFT_DEG: f64 = OBSTACLES_DEG[LEFT];

/// What the head is put before, where that is on either side, degrees, and whether it has CIA
/// beside RCP.
type Case = (&'static str, [f64; 2], bool);

const CASES: [Case; 5] = [
    ("nothing", [NOTHING; 2], true),
    ("a body on the left, RCP", [LEFT_DEG, NOTHING], false),
    ("a body on the left, RCP and CIA", [LEFT_DEG, NOTHING], true),
    ("bodies on both sides, RCP", OBSTACLES_DEG, false),
    ("bodies on both sides, RCP and CIA", OBSTACLES_DEG, true),
];

struct Moved {
    /// Mean over the whisks of the largest angle of the front whisker of a side, degrees.
    peak_deg: [f64; 2],
    /// Contacts of a side a whisk.
    contacts: [f64; 2],
}

fn run((_, obstacles_deg, has_cia): Case, scene: &Scene) -> Result<Moved> {
    let mut scene = scene.clone();
    let gate = |(gain, whisks): (f64, f64)| GateSettings {
        gain,
        tau_s: whisks / FREQUENCY_HZ,
    };
    scene.rcp = FIG9.rcp.map(gate);
    scene.cia = FIG9.cia.filter(|_| has_cia).map(gate);
    if let Some(obstacle) = &mut scene.plant.obstacle {
        obstacle.obstacle_deg = obstacles_deg.to_vec();
    }
    let mut run = Run::new(&scene, None)?;
    for _ in 0..LEAD * WHISK {
        run.tick();
    }
    let rows: Vec<Row> = (0..WHISKS * WHISK).map(|_| run.tick().angle_deg).collect();
    Ok(Moved {
        peak_deg: [LEFT, RIGHT].map(|side| {
            let peaks = rows.chunks(WHISK).map(|whisk| angles(whisk, side).1);
            peaks.sum::<f64>() / WHISKS as f64
        }),
        contacts: [LEFT, RIGHT].map(|side| contacts(&rows, side, WHISKS)),
    })
}

pub(super) fn section(page: &mut Page, request: &Request) -> Result<()> {
    let scene = head(request)?;
    let moved = CASES.into_par_iter().map(|case| run(case, &scene));
    let moved = moved.collect::<Result<Vec<Moved>>>()?;
    page.say(format_args!(
        "**The whole head**: 24 whiskers, 12 a side, with the gains of Fig. 9, each with its motor \
         and an elastic shaft of 112 mm, before plates that a straight whisker touches at {} degrees \
         on the left and {} on the right. Mean of {WHISKS} whisks.",
        OBSTACLES_DEG[LEFT], OBSTACLES_DEG[RIGHT]
    ));
    let line = |((what, ..), moved): (&Case, &Moved)| {
        let cells = [
            figure(moved.peak_deg[LEFT], 1),
            figure(moved.peak_deg[RIGHT], 1),
            figure(moved.contacts[LEFT], 2),
            figure(moved.contacts[RIGHT], 2),
        ];
        row(*what, cells.map(|cell| format!("**{cell}**")))
    };
    let header = format!(
        "before | left up to, degrees | right up to, degrees | left past {} degrees, times a whisk | \
         right past {} degrees, times a whisk",
        OBSTACLES_DEG[LEFT], OBSTACLES_DEG[RIGHT]
    );
    page.table(&header, CASES.iter().zip(&moved).map(line));
    let [free, one_side, without, with] = [0, 2, 3, 4].map(|n| &moved[n]);
    let (left, right) = (one_side.peak_deg[LEFT], one_side.peak_deg[RIGHT]);
    page.claim(
        "BIOTACT section III-D, 24 whiskers with bodies: an obstacle on the left holds the left \
         back and lets the right protract more",
        "so",
        format_args!(
            "left up to {}, right up to {}; free {} and {} degrees",
            figure(left, 1),
            figure(right, 1),
            figure(free.peak_deg[LEFT], 1),
            figure(free.peak_deg[RIGHT], 1)
        ),
        (
            (free.peak_deg[LEFT] - left).min(right - free.peak_deg[RIGHT]),
            "degrees",
        ),
    );
    let (found, missed) = (with.contacts[RIGHT], without.contacts[RIGHT]);
    page.claim(
        "BIOTACT Fig. 9, 24 whiskers with bodies: with CIA the right finds its obstacle",
        "1 contact a whisk, none without CIA",
        format_args!(
            "{} contacts a whisk, {} without CIA",
            figure(found, 2),
            figure(missed, 2)
        ),
        ((found - 0.5).min(0.5 - missed), "contacts a whisk"),
    );
    Ok(())
}
