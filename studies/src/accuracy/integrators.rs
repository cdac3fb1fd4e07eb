//! Error of θ' against run time: every integrator, number format and tick.

use anyhow::Result;
use whisking::Integrator;

use super::{Case, Counts, Format, Scheme, TARGETS, Truth, cell};
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

/// Errors in degrees of one scheme, by frequency and tick.
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
    let curve = |(n, errors): (usize, &Errors), f: usize| {
        let cost = cost(errors.scheme)?;
        let points = TICKS_HZ.iter().zip(errors.degrees[f]);
        let points = points.map(|(hz, degrees)| (cost * hz, degrees)).collect();
        let mark = match errors.scheme.integrator {
            Integrator::Exact => Mark::Dot,
            Integrator::Euler => Mark::Ring,
        };
        Some(Series::new(&errors.scheme.name(), n, mark, points))
    };
    let schemes = || measured.iter().enumerate();
    let curves: [Vec<Series>; FREQUENCIES_HZ.len()] =
        core::array::from_fn(|f| schemes().filter_map(|of| curve(of, f)).collect());
    // One scale for all, so that panels can be compared.
    let all = curves.iter().flatten().flat_map(|series| &series.points);
    if all.clone().next().is_none() {
        return Ok(None);
    }
    let x = Axis::decades(work, all.clone().map(|point| point.0));
    let y = Axis::decades("largest error, degrees", all.map(|point| point.1));
    let panels = FREQUENCIES_HZ.iter().zip(curves);
    let panels = panels.map(|(hz, of)| Panel::new(&format!("{hz} Hz"), x.clone(), y.clone(), of));
    draw(&panels.collect::<Vec<_>>()).map(Some)
}

/// Errors that one might live with, degrees.
const BOUNDS_DEG: [f64; 3] = [0.05, 1e-3, 1e-4];

pub(super) fn choice(page: &mut Page, measured: &[Errors], counts: &Counts) -> Result<()> {
    for ((name, target), file) in TARGETS.into_iter().zip(["choose.svg", "choose-m0.svg"]) {
        let cost = |scheme| counts.tick(scheme, target);
        let Some(svg) = diagram(measured, "instructions a second", cost)? else {
            continue;
        };
        page.say(format_args!(
            "**{name}.** The points of a curve are ticks of 2, 1, 0.5, 0.25 and 0.1 ms, from left to \
             right."
        ));
        let what = format!("error against instructions a second, {name}");
        page.picture(file, &what, svg);
        page.say("The cheapest that keeps its error below a bound:");
        let line = |(f, frequency_hz): (usize, &f64)| {
            let cell = |bound| cheapest(measured, f, bound, cost);
            row(format!("{frequency_hz} Hz"), BOUNDS_DEG.map(cell))
        };
        page.table(
            "f_W | 0.05 degrees | 0.001 degrees | 0.0001 degrees",
            FREQUENCIES_HZ.iter().enumerate().map(line),
        );
    }
    Ok(())
}

/// Scheme and tick of least work whose error stays below `bound`, at the `f`th frequency.
fn cheapest(
    measured: &[Errors],
    f: usize,
    bound: f64,
    cost: impl Fn(Scheme) -> Option<f64>,
) -> String {
    let points = measured.iter().flat_map(|errors| {
        let cost = cost(errors.scheme);
        let ticks = TICKS_HZ.iter().zip(errors.degrees[f]);
        let enough = ticks.filter(move |(_, degrees)| *degrees <= bound);
        enough.filter_map(move |(hz, _)| Some((cost? * hz, errors.scheme, hz)))
    });
    let Some((work, scheme, hz)) = points.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return "none".to_owned();
    };
    let (name, millions) = (scheme.name(), work / 1e6);
    format!("{name}, {} ms ({millions:.2} million/s)", 1e3 / hz)
}

fn costs(page: &mut Page, counts: &Counts) {
    let line = |scheme: Scheme| {
        let counted = TARGETS.map(|(_, target)| counts.tick(scheme, target));
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

pub(super) fn section(page: &mut Page, near: &[Errors], counts: &Counts) -> Result<()> {
    page.heading(2, "Integrators");
    costs(page, counts);
    page.heading(3, "Goals");
    let goal = |(format, frequency_hz, tick_hz, goal): (Format, f64, f64, f64)| {
        let scheme = Scheme {
            integrator: Integrator::Exact,
            format,
        };
        let found = of(near, scheme, frequency_hz, tick_hz);
        let (name, tick_ms) = (scheme.name(), 1e3 / tick_hz);
        vec![
            format!("{name}, {frequency_hz} Hz, {tick_ms} ms"),
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
    Some(errors.degrees[f][tick])
}

fn table(page: &mut Page, measured: &[Errors]) {
    for (f, frequency_hz) in FREQUENCIES_HZ.iter().enumerate() {
        let header = format!("{frequency_hz} Hz | 0.1 ms | 0.25 ms | 0.5 ms | 1 ms | 2 ms");
        let line = |errors: &Errors| row(errors.scheme.name(), errors.degrees[f].map(short));
        page.table(&header, measured.iter().map(line));
    }
}

#[cfg(test)]
mod tests {
    use super::{Errors, Format, Scheme, cheapest};
    use whisking::Integrator::{Euler, Exact};

    #[test]
    fn the_cheapest_below_the_bound_is_neither_the_best_nor_the_cheapest_of_all() {
        let errors = |scheme, error: f64| Errors {
            scheme,
            degrees: [[error, 2.0 * error, 4.0 * error, 8.0 * error, 16.0 * error]; 4],
        };
        let [good, cheap] = [Exact, Euler].map(|integrator| Scheme {
            integrator,
            format: Format::F64,
        });
        let measured = [errors(good, 1e-3), errors(cheap, 2e-3)];
        let cost = |scheme| Some(if scheme == cheap { 10.0 } else { 100.0 });
        // The cheap one reaches 0.01 at 0.5 ms and 2000 · 10, the good one at 1 ms and 1000 · 100.
        let found = cheapest(&measured, 0, 0.01, cost);
        assert_eq!(found, "euler f64, 0.5 ms (0.02 million/s)");
        assert_eq!(cheapest(&measured, 0, 1e-4, cost), "none");
    }
}
