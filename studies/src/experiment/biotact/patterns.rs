//! BIOTACT Figs. 6 to 9: the pattern generator before simulated obstacles (eq. 11), without a body:
//! gains, RCP, strong and fast RCP, CIA. And the whole head (section III-D): twelve whiskers a side,
//! with motors, elastic shafts and sensors, before obstacles, moved by the module.

use anyhow::Result;
use host_sim::run::Run;
use rayon::prelude::*;
use scene::Scene;
use whisking::{GateSettings, Integrator, Settings, State, degrees, filter};

use crate::chart::{Mark, Series, linear, panel};
use crate::experiment::Request;
use crate::moments::range;
use crate::page::{Page, bold, figure};
use crate::paper::biotact::{
    FIG6_GAINS, FIG9_CIA, GENTLE, Gate, OBSTACLES_DEG, OVERLAP_GAIN, STRONG,
};

const TICK_HZ: f64 = 2_000.0;
const FREQUENCY_HZ: f64 = 2.0;
/// Ten seconds.
const RUN_TICKS: usize = 20_000;
const WHISK: usize = (TICK_HZ / FREQUENCY_HZ) as usize;
/// Whisks that are measured and shown: the last of a run.
const WHISKS: usize = 3;
const LEFT: usize = 0;
const RIGHT: usize = 1;

/// A tick: θ' of both sides, degrees.
type Row = [f64; 2];

fn gate((gain, whisks): Gate) -> GateSettings {
    GateSettings {
        gain,
        tau_s: whisks / FREQUENCY_HZ,
    }
}

/// A run with the product's own equations in f64, as the paper has them: forward Euler, no noise,
/// both sides started at ψ = (1, 0); with RCP before obstacles at [`OBSTACLES_DEG`]. Its last whisks.
fn run(gain: f64, rcp: Option<Gate>, cia: Option<Gate>) -> Result<Vec<Row>> {
    let settings = Settings {
        tick_hz: TICK_HZ,
        frequency_hz: FREQUENCY_HZ,
        integrator: Integrator::Euler,
        coupling: true,
        noise: 0.0,
        rcp: rcp.map(gate),
        cia: cia.map(gate),
    };
    let config = settings.build::<f64>()?;
    let start = settings.start(&[[1.0, 0.0]; 2], &[&[gain][..]; 2]);
    let mut state = State::new(&start?, 1);
    let h50 = filter::Config::<f64>::new(filter::CORNER_HZ, TICK_HZ)?;
    let mut filters = [filter::State::default(); 2];
    let mut angles = [50.0; 2];
    let tick = |_| {
        let mut contact = [0.0; 2];
        if rcp.is_some() {
            let sides = contact.iter_mut().zip(&mut filters);
            for ((contact, filter), (angle, at)) in sides.zip(angles.iter().zip(OBSTACLES_DEG)) {
                let x = (OVERLAP_GAIN * (angle - at).max(0.0)).min(1.0);
                *contact = h50.process(filter, x).abs();
            }
        }
        config.step(&mut state, &contact);
        for (angle, theta) in angles.iter_mut().zip(state.theta()) {
            *angle = degrees(theta);
        }
        angles
    };
    let rows: Vec<Row> = (0..RUN_TICKS).map(tick).collect();
    Ok(rows[RUN_TICKS - WHISKS * WHISK..].to_vec())
}

/// Least and largest θ' of a side, degrees.
fn angles(rows: &[Row], side: usize) -> (f64, f64) {
    range(rows.iter().map(|row| row[side]))
}

/// Contacts of a side a whisk, of so many: how often it comes past its obstacle.
fn contacts(rows: &[Row], side: usize, whisks: usize) -> f64 {
    let beyond = |row: &Row| row[side] > OBSTACLES_DEG[side];
    let pairs = rows.iter().zip(rows.iter().skip(1));
    let count = pairs.filter(|(a, b)| !beyond(a) && beyond(b)).count();
    count as f64 / whisks as f64
}

fn curve(name: &str, rows: &[Row], side: usize) -> Series {
    // Every tenth tick is plenty for a picture.
    let points = rows.iter().enumerate().step_by(10);
    let points = points.map(|(n, row)| (n as f64 / TICK_HZ, row[side]));
    Series::curve(name, points.collect())
}

pub(super) fn gains(page: &mut Page) -> Result<()> {
    let (mut curves, mut said, mut highest) = (Vec::new(), Vec::new(), Vec::new());
    for gain in FIG6_GAINS {
        let rows = run(gain, None, None)?;
        let (low, high) = angles(&rows, LEFT);
        said.push(format!("{low:.1} to {high:.1} at g = {gain}"));
        highest.push(high);
        curves.push(curve(&format!("g = {gain}"), &rows, LEFT));
    }
    page.say(format_args!(
        "**Fig. 6**: free whisking with four gains. θ' goes from {} degrees.",
        said.join(", ")
    ));
    let end = (WHISKS * WHISK) as f64 / TICK_HZ;
    let (x, y) = (linear("s", 0.0, end), linear("θ', degrees", 50.0, 160.0));
    let panels = [panel("Fig. 6", x, y, &curves, Mark::Nothing)];
    let what = "Free whisking with four gains";
    page.panels("biotact-fig6.svg", what, &panels)?;
    let most = (highest.last().copied().unwrap_or(0.0) - 50.0) / 100.0;
    let rises = highest.iter().zip(highest.iter().skip(1));
    let rise = rises.map(|(a, b)| (b - a) / 100.0).fold(f64::MAX, f64::min);
    page.claim(
        "BIOTACT Fig. 6: a higher gain gives a higher θ', and at g = 2 θ approaches unity but does not exceed it",
        "so",
        format_args!("largest θ = {most:.4} at g = 2"),
        (rise.min(most - 0.95).min(1.0 - most), "of θ"),
    );
    Ok(())
}

pub(super) fn obstacles(page: &mut Page) -> Result<()> {
    let free = run(1.0, None, None)?;
    let end = (WHISKS * WHISK) as f64 / TICK_HZ;
    let mut panels = Vec::new();
    let mut runs = Vec::new();
    let fig_9 = "Fig. 9: as Fig. 7, and CIA, σ_g = 0.5, τ_g = T_W/4";
    for (title, rcp, cia) in [
        ("Fig. 7: RCP, σ_z = 0.7, τ_z = T_W/4", GENTLE, None),
        ("Fig. 8: RCP, σ_z = 2, τ_z = T_W/10", STRONG, None),
        (fig_9, GENTLE, Some(FIG9_CIA)),
    ] {
        let rows = run(1.0, Some(rcp), cia)?;
        let level = |name: &str, side: usize| {
            let at = OBSTACLES_DEG[side];
            Series::curve(name, vec![(0.0, at), (end, at)])
        };
        let curves = [
            curve("left", &rows, LEFT),
            curve("right", &rows, RIGHT),
            curve("not modulated", &free, LEFT),
            level("obstacle of the left", LEFT),
            level("obstacle of the right", RIGHT),
        ];
        let (x, y) = (linear("s", 0.0, end), linear("θ', degrees", 50.0, 140.0));
        panels.push(panel(title, x, y, &curves, Mark::Nothing));
        runs.push(rows);
    }
    page.say(
        "**Figs. 7 to 9**: the generator before obstacles at 100 degrees on the left and 125 on \
         the right (eq. 11, σ_x = 0.1).",
    );
    let what = "RCP and CIA before obstacles";
    page.panels("biotact-fig7-9.svg", what, &panels)?;
    let highest = |n: usize, side| angles(&runs[n], side).1;
    let touches = |n: usize, side| contacts(&runs[n], side, WHISKS);
    let (left, right) = (highest(0, LEFT), highest(0, RIGHT));
    page.claim(
        "BIOTACT Fig. 7: RCP holds the left back, by 5 degrees or more; the right does not reach its obstacle",
        "left suppressed, right below 125 degrees",
        format_args!("left up to {left:.1}, right up to {right:.1} degrees"),
        ((right - 5.0 - left).min(OBSTACLES_DEG[RIGHT] - right), "degrees"),
    );
    let (strong, gentle) = (touches(1, LEFT), touches(0, LEFT));
    page.claim(
        "BIOTACT Fig. 8: strong and fast RCP makes two distinct contacts a whisk",
        "2",
        format_args!("{strong:.1}; {gentle:.1} with Fig. 7's"),
        ((strong - 1.5).min(1.5 - gentle), "contacts a whisk"),
    );
    let (with, without) = (touches(2, RIGHT), touches(0, RIGHT));
    page.claim(
        "BIOTACT Fig. 9: with CIA the right finds its obstacle",
        "beyond 125 degrees, 1 contact a whisk",
        format_args!(
            "up to {:.1} degrees, {with:.1} contacts a whisk; {without:.1} without CIA",
            highest(2, RIGHT),
        ),
        ((with - 0.5).min(0.5 - without), "contacts a whisk"),
    );
    Ok(())
}

/// Whisks that are left out, as the motors settle, and those that are measured.
const LEAD: usize = 4;
const HEAD_WHISKS: usize = 16;

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
        (LEAD + HEAD_WHISKS) as f64 / FREQUENCY_HZ,
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

/// Of each side the mean over the whisks of the largest angle of the front whisker, degrees, and
/// the contacts a whisk.
type Moved = [[f64; 2]; 2];

fn run_head((_, obstacles_deg, has_cia): Case, scene: &Scene) -> Result<Moved> {
    let mut scene = scene.clone();
    scene.rcp = Some(gate(GENTLE));
    scene.cia = has_cia.then(|| gate(FIG9_CIA));
    if let Some(obstacle) = &mut scene.plant.obstacle {
        obstacle.obstacle_deg = obstacles_deg.to_vec();
    }
    let mut run = Run::new(&scene, None)?;
    for _ in 0..LEAD * WHISK {
        run.tick();
    }
    let rows: Vec<Row> = (0..HEAD_WHISKS * WHISK)
        .map(|_| run.tick().angle_deg)
        .collect();
    let peak_deg = |side| {
        let peaks = rows.chunks(WHISK).map(|whisk| angles(whisk, side).1);
        peaks.sum::<f64>() / HEAD_WHISKS as f64
    };
    let contacts = |side| contacts(&rows, side, HEAD_WHISKS);
    Ok([[LEFT, RIGHT].map(peak_deg), [LEFT, RIGHT].map(contacts)])
}

pub(super) fn whole_head(page: &mut Page, request: &Request) -> Result<()> {
    let scene = head(request)?;
    let moved = CASES.into_par_iter().map(|case| run_head(case, &scene));
    let moved = moved.collect::<Result<Vec<Moved>>>()?;
    page.say(format_args!(
        "**The whole head**: 24 whiskers, 12 a side, with the gains of Fig. 9, each with its motor \
         and an elastic shaft of 112 mm, before plates that a straight whisker touches at {} degrees \
         on the left and {} on the right. Mean of {HEAD_WHISKS} whisks.",
        OBSTACLES_DEG[LEFT], OBSTACLES_DEG[RIGHT]
    ));
    let line = |((what, ..), [peak_deg, contacts]): (&Case, &Moved)| {
        let cells = peak_deg.map(|deg| figure(deg, 1)).into_iter();
        bold(*what, cells.chain(contacts.map(|count| figure(count, 2))))
    };
    let header = format!(
        "before | left up to, degrees | right up to, degrees | left past {LEFT_DEG} degrees, times a \
         whisk | right past {} degrees, times a whisk",
        OBSTACLES_DEG[RIGHT]
    );
    page.table(&header, CASES.iter().zip(&moved).map(line));
    let [free, [left, right]] = [0, 2].map(|n| moved[n][0]);
    let [a, b, c, d] = [left, right, free[LEFT], free[RIGHT]].map(|deg| figure(deg, 1));
    page.claim(
        "BIOTACT section III-D, 24 whiskers with bodies: an obstacle on the left holds the left \
         back and lets the right protract more",
        "so",
        format_args!("left up to {a}, right up to {b}; free {c} and {d} degrees"),
        ((free[LEFT] - left).min(right - free[RIGHT]), "degrees"),
    );
    let [missed, found] = [3, 4].map(|n| moved[n][1][RIGHT]);
    let [without, with] = [missed, found].map(|count| figure(count, 2));
    page.claim(
        "BIOTACT Fig. 9, 24 whiskers with bodies: with CIA the right finds its obstacle",
        "1 contact a whisk, none without CIA",
        format_args!("{with} contacts a whisk, {without} without CIA"),
        ((found - 0.5).min(0.5 - missed), "contacts a whisk"),
    );
    Ok(())
}
