//! Error of θ' against run time: every integrator, number format and tick.

use anyhow::Result;
use whisking::Integrator;

use super::counts::{Counts, Target, cell};
use super::reference::{Case, Truth};
use super::schemes::{Format, Scheme};
use crate::chart::{Axis, Mark, Panel, Series, draw};
use crate::page::{Page, row, short, verdict};

pub(super) const FREQUENCIES_HZ: [f64; 4] = [0.5, 2.0, 8.0, 25.0];
/// Tick rates, Hz: 0.1, 0.25, 0.5, 1 and 2 ms.
pub(super) const TICKS_HZ: [f64; 5] = [10_000.0, 4_000.0, 2_000.0, 1_000.0, 500.0];

/// The start of the papers' comparison: one side on its circle, one inside.
pub(super) const NEAR: Case = Case {
    psi: [[1.0, 0.0], [0.6, 0.5]],
    gain: 1.0,
};
/// A harder one: far apart, one side near the origin, twice the gain.
const FAR: Case = Case {
    psi: [[-1.0, 0.4], [0.1, 0.0]],
    gain: 2.0,
};

/// What the product is to reach from [`NEAR`]: format, f_W, tick rate, degrees.
const GOALS: [(Format, f64, f64, f64); 7] = [
    (Format::F32, 2.0, 2_000.0, 1e-4),
    (Format::F32, 8.0, 2_000.0, 2e-4),
    (Format::F32, 25.0, 2_000.0, 6e-4),
    (Format::F32, 25.0, 500.0, 0.2),
    (Format::Fixed, 2.0, 2_000.0, 1e-3),
    (Format::Fixed, 8.0, 2_000.0, 1e-3),
    (Format::Fixed, 25.0, 2_000.0, 3e-3),
];

const fn exact(format: Format) -> Scheme {
    Scheme {
        integrator: Integrator::Exact,
        format,
    }
}

/// Errors in degrees of one scheme, by frequency and tick.
#[derive(Debug)]
pub(super) struct Errors {
    pub(super) scheme: Scheme,
    pub(super) degrees: [[f64; TICKS_HZ.len()]; FREQUENCIES_HZ.len()],
}

pub(super) fn measure(case: &Case) -> Result<Vec<Errors>> {
    let truth = Truth::solve(case);
    let of = |scheme: Scheme| {
        let mut degrees = [[0.0; TICKS_HZ.len()]; FREQUENCIES_HZ.len()];
        for (row, frequency_hz) in degrees.iter_mut().zip(FREQUENCIES_HZ) {
            for (cell, tick_hz) in row.iter_mut().zip(TICKS_HZ) {
                *cell = scheme.error(case, &truth, frequency_hz, tick_hz)?;
            }
        }
        Ok(Errors { scheme, degrees })
    };
    Scheme::all().map(of).collect()
}

/// A work-precision diagram for each frequency. `cost` is what one tick takes,
/// `None` where that is not known; the axis `work` then counts it a second.
pub(super) fn diagram(
    measured: &[Errors],
    work: &'static str,
    cost: impl Fn(Scheme) -> Option<f64>,
) -> Result<Option<String>> {
    let points = |errors: &Errors, f: usize| -> Vec<(f64, f64)> {
        let cost = cost(errors.scheme);
        let row = errors.degrees.get(f).into_iter().flatten();
        let all = TICKS_HZ.iter().zip(row);
        all.filter_map(|(hz, degrees)| Some((cost? * hz, *degrees)))
            .collect()
    };
    let panel = |f: usize, frequency_hz: f64| Panel {
        title: format!("{frequency_hz} Hz"),
        x: Axis::decades(work, [].into_iter()),
        y: Axis::decades("largest error, degrees", [].into_iter()),
        series: measured
            .iter()
            .enumerate()
            .map(|(n, errors)| {
                let mark = match errors.scheme.integrator {
                    Integrator::Exact => Mark::Dot,
                    Integrator::Euler => Mark::Ring,
                };
                Series::new(&errors.scheme.name(), n, mark, points(errors, f))
            })
            .filter(|series| !series.points.is_empty())
            .collect(),
    };
    let mut panels: Vec<Panel> = FREQUENCIES_HZ
        .into_iter()
        .enumerate()
        .map(|(f, hz)| panel(f, hz))
        .collect();
    let all: Vec<(f64, f64)> = panels
        .iter()
        .flat_map(|panel| &panel.series)
        .flat_map(|series| series.points.iter().copied())
        .collect();
    if all.is_empty() {
        return Ok(None);
    }
    // One scale for all, so that panels can be compared.
    for panel in &mut panels {
        panel.x = Axis::decades(panel.x.name, all.iter().map(|point| point.0));
        panel.y = Axis::decades(panel.y.name, all.iter().map(|point| point.1));
    }
    draw(&panels).map(Some)
}

fn costs(page: &mut Page, counts: &Counts) {
    let line = |scheme: Scheme| {
        let counted = Target::ALL.map(|target| counts.tick(scheme, target));
        row(scheme.name(), counted.map(cell))
    };
    page.table(
        "instructions a tick | Cortex-M4F | Cortex-M0+",
        Scheme::all().map(line),
    );
    page.say(
        "Counted in an emulator (the Cortex-M0+ as a Cortex-M0, whose instructions it has): the whole pattern generator, gates included, two sides with one \
         whisker each. Instructions are not cycles.",
    );
}

/// Goals beside what was measured, and the errors of every combination.
pub(super) fn section(page: &mut Page, near: &[Errors], counts: &Counts) -> Result<()> {
    page.heading(2, "Integrators");
    costs(page, counts);
    page.heading(3, "Goals");
    let goal = |(format, frequency_hz, tick_hz, goal): (Format, f64, f64, f64)| {
        let scheme = exact(format);
        let found = of(near, scheme, frequency_hz, tick_hz);
        vec![
            format!(
                "exact {}, {frequency_hz} Hz, {} ms",
                format.name(),
                1e3 / tick_hz
            ),
            found.map_or_else(|| "not measured".to_owned(), short),
            format!("{goal:.0e}"),
            verdict(found.is_some_and(|found| found <= goal)).to_owned(),
        ]
    };
    page.table("run | largest error, degrees | goal | ", GOALS.map(goal));
    page.heading(3, "Every combination");
    page.say(
        "Largest error of θ' in degrees over ten whisks, both sides, from the first tick. Sides \
         start at ψ = (1, 0) and (0.6, 0.5), g = 1. Only the product of frequency and tick \
         enters the equations: 2 Hz at 2 ms has the errors of 8 Hz at 0.5 ms.",
    );
    table(page, near);
    if let Some(svg) = diagram(near, "ticks a second", |_| Some(1.0))? {
        page.picture("ticks.svg", "error against tick rate", svg);
    }
    page.heading(3, "Another start, twice the gain");
    page.say(
        "Sides start at ψ = (−1, 0.4) and (0.1, 0), g = 2: nearly opposite and one near the \
         origin, where the radial part and the coupling, which the exact integrator splits, are \
         strongest. The split is of second order in the tick; it fades as the sides settle.",
    );
    table(page, &measure(&FAR)?);
    Ok(())
}

fn of(measured: &[Errors], scheme: Scheme, frequency_hz: f64, tick_hz: f64) -> Option<f64> {
    let errors = measured.iter().find(|errors| errors.scheme == scheme)?;
    let f = FREQUENCIES_HZ.iter().position(|f| *f == frequency_hz)?;
    let tick = TICKS_HZ.iter().position(|hz| *hz == tick_hz)?;
    errors.degrees.get(f)?.get(tick).copied()
}

fn table(page: &mut Page, measured: &[Errors]) {
    for (f, frequency_hz) in FREQUENCIES_HZ.iter().enumerate() {
        let header = format!("{frequency_hz} Hz | 0.1 ms | 0.25 ms | 0.5 ms | 1 ms | 2 ms");
        let line = |errors: &Errors| {
            let cells = errors.degrees.get(f).into_iter().flatten();
            let cells = cells.map(|degrees| short(*degrees));
            row(errors.scheme.name(), cells)
        };
        page.table(&header, measured.iter().map(line));
    }
}

#[cfg(test)]
mod tests {
    use super::{GOALS, NEAR, exact, measure, of};

    #[test]
    fn every_goal_is_met() {
        let measured = measure(&NEAR).unwrap();
        for (format, frequency_hz, tick_hz, goal) in GOALS {
            let scheme = exact(format);
            let found = of(&measured, scheme, frequency_hz, tick_hz).unwrap();
            assert!(
                found <= goal,
                "{scheme:?} {frequency_hz} {tick_hz}: {found:e}"
            );
        }
    }
}
