//! BIOTACT Figs. 6 to 9: the pattern generator before simulated obstacles
//! (eq. 11), without a body: gains, RCP, strong and fast RCP, CIA.

use crate::chart::{Mark, Series, linear, panel};
use crate::moments::range;
use crate::page::Page;
use crate::paper::biotact::{
    FIG6, FIG6_GAINS, FIG7, FIG8, FIG9, Figure, OBSTACLES_DEG, OVERLAP_GAIN,
};
use anyhow::Result;
use whisking::{GateSettings, Integrator, Settings, State, degrees, filter};

pub(super) const TICK_HZ: f64 = 2_000.0;
pub(super) const FREQUENCY_HZ: f64 = 2.0;
/// Ten seconds.
const RUN_TICKS: usize = 20_000;
pub(super) const WHISK: usize = (TICK_HZ / FREQUENCY_HZ) as usize;
/// Whisks that are measured and shown: the last of a run.
const WHISKS: usize = 3;
pub(super) const LEFT: usize = 0;
pub(super) const RIGHT: usize = 1;

/// A tick: θ' of both sides, degrees.
pub(super) type Row = [f64; 2];

/// A gate of the paper, whose time constant is a share of the whisk period.
fn gate((gain, whisks): (f64, f64)) -> GateSettings {
    GateSettings {
        gain,
        tau_s: whisks / FREQUENCY_HZ,
    }
}

/// A run with the product's own equations in f64, as the paper has them: forward Euler, no noise,
/// both sides started at ψ = (1, 0).
fn run(figure: &Figure) -> Result<Vec<Row>> {
    let settings = Settings {
        tick_hz: TICK_HZ,
        frequency_hz: FREQUENCY_HZ,
        integrator: Integrator::Euler,
        coupling: true,
        noise: 0.0,
        rcp: figure.rcp.map(gate),
        cia: figure.cia.map(gate),
    };
    let config = settings.build::<f64>()?;
    let start = settings.start(&[[1.0, 0.0]; 2], &[&[figure.gain][..]; 2]);
    let mut state = State::new(&start?, 1);
    let h50 = filter::Config::<f64>::new(filter::CORNER_HZ, TICK_HZ)?;
    let mut filters = [filter::State::default(); 2];
    let mut angles = [50.0; 2];
    let tick = |_| {
        let mut contact = [0.0; 2];
        if figure.obstacles {
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
    Ok((0..RUN_TICKS).map(tick).collect())
}

fn tail(figure: &Figure) -> Result<Vec<Row>> {
    let rows = run(figure)?;
    let from = rows.len().saturating_sub(WHISKS * WHISK);
    Ok(rows.into_iter().skip(from).collect())
}

/// Least and largest θ' of a side, degrees.
pub(super) fn angles(rows: &[Row], side: usize) -> (f64, f64) {
    range(rows.iter().map(|row| row[side]))
}

/// Contacts of a side a whisk, of so many: how often it comes past its obstacle.
pub(super) fn contacts(rows: &[Row], side: usize, whisks: usize) -> f64 {
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

pub(super) fn section(page: &mut Page) -> Result<()> {
    gains(page)?;
    obstacles(page)
}

fn gains(page: &mut Page) -> Result<()> {
    let (mut curves, mut said, mut highest) = (Vec::new(), Vec::new(), Vec::new());
    for gain in FIG6_GAINS {
        let rows = tail(&Figure { gain, ..FIG6 })?;
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
    let x = linear("s", 0.0, end);
    let y = linear("θ', degrees", 50.0, 160.0);
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

fn obstacles(page: &mut Page) -> Result<()> {
    let free = tail(&Figure { gain: 1.0, ..FIG6 })?;
    let end = (WHISKS * WHISK) as f64 / TICK_HZ;
    let mut panels = Vec::new();
    let mut runs = Vec::new();
    for (title, figure) in [
        ("Fig. 7: RCP, σ_z = 0.7, τ_z = T_W/4", FIG7),
        ("Fig. 8: RCP, σ_z = 2, τ_z = T_W/10", FIG8),
        ("Fig. 9: as Fig. 7, and CIA, σ_g = 0.5, τ_g = T_W/4", FIG9),
    ] {
        let rows = tail(&figure)?;
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
        (
            (right - 5.0 - left).min(OBSTACLES_DEG[RIGHT] - right),
            "degrees",
        ),
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
