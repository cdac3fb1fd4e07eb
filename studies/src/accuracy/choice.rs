//! The pictures to pick an integrator by, and what they say in words.

use super::counts::{Counts, Target};
use super::integrators::{Errors, FREQUENCIES_HZ, TICKS_HZ, diagram};
use super::schemes::Scheme;
use crate::page::{Page, row};
use anyhow::Result;

/// Errors that one might live with, degrees.
const BOUNDS_DEG: [f64; 3] = [0.05, 1e-3, 1e-4];

pub(super) fn section(page: &mut Page, measured: &[Errors], counts: &Counts) -> Result<()> {
    for (target, file) in Target::ALL.into_iter().zip(["choose.svg", "choose-m0.svg"]) {
        let cost = |scheme| counts.tick(scheme, target);
        let Some(svg) = diagram(measured, "instructions a second", cost)? else {
            continue;
        };
        page.say(format_args!(
            "**{}.** The points of a curve are ticks of 2, 1, 0.5, 0.25 and 0.1 ms, from left to \
             right.",
            target.name()
        ));
        let what = format!("error against instructions a second, {}", target.name());
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

/// Scheme and tick of least work whose error stays below `bound`, at the
/// `f`th frequency.
fn cheapest(
    measured: &[Errors],
    f: usize,
    bound: f64,
    cost: impl Fn(Scheme) -> Option<f64>,
) -> String {
    let mut best: Option<(f64, String)> = None;
    for errors in measured {
        let row = errors.degrees.get(f).into_iter().flatten();
        for (hz, degrees) in TICKS_HZ.iter().zip(row) {
            let Some(work) = cost(errors.scheme).map(|cost| cost * hz) else {
                continue;
            };
            let better = best.as_ref().is_none_or(|(least, _)| work < *least);
            if *degrees <= bound && better {
                let name = errors.scheme.name();
                let millions = work / 1e6;
                let text = format!("{name}, {} ms ({millions:.2} million/s)", 1e3 / hz);
                best = Some((work, text));
            }
        }
    }
    best.map_or_else(|| "none".to_owned(), |(_, text)| text)
}

#[cfg(test)]
mod tests {
    use super::cheapest;
    use crate::accuracy::integrators::Errors;
    use crate::accuracy::schemes::{Format, Scheme};
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
