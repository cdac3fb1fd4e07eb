//! The papers' claims with the misprinted formulas and with the reading that
//! the product follows: its own equations in f64, with that one changed.
//!
//! Everything runs as the papers have it: forward Euler, 2 kHz, 2 Hz, no noise,
//! both sides started at ψ = (1, 0); measured over the last five whisks of ten
//! seconds.

pub(crate) mod figures;

use serde::Deserialize;
use whisking::oscillator::OscillatorIntegrator;
use whisking::{Integrator, PatternGenerator, State};

use figures::{FREE, Printed, Row, run};

use super::schemes::PAPERS;
use crate::page::Page;
use crate::paper::biotact::{FIG6, FIG7, FIG8, FIG9, Figure};
use crate::peaks::peaks;
use crate::refused::refused;
use host_sim::Error;

const WHISK_TICKS: usize = 1_000;
/// Whisks that are measured.
const WHISKS: usize = 5;
/// π at which a contact begins, and below which it has ended.
const TOUCH: f64 = 0.05;
const RELEASE: f64 = 0.02;
/// Phase difference of the sides from which they lock, rad.
const APART: f64 = 0.2;
const LEFT: usize = 0;

/// What is measured, of a side if it has two.
#[derive(Debug, Clone, Copy, Deserialize)]
enum Quantity {
    /// Largest θ of the left.
    Theta,
    /// Largest θ' of a side, degrees.
    Highest,
    /// Peaks of θ' of a side a whisk.
    Peaks,
    /// Contacts of a side a whisk.
    Contacts,
    /// Smallest and largest g of the left whisker.
    Gain,
}

impl Quantity {
    fn measure(self, side: usize, rows: &[Row]) -> String {
        // Whole whisks, cut where the left side is most retracted.
        let tail = rows.len().saturating_sub((WHISKS + 1) * WHISK_TICKS);
        let (_, rows) = rows.split_at(tail);
        let first = rows.iter().take(WHISK_TICKS).enumerate();
        let cut = first.min_by(|a, b| a.1.theta_deg[LEFT].total_cmp(&b.1.theta_deg[LEFT]));
        let rows = rows.iter().skip(cut.map_or(0, |(at, _)| at));
        let rows = rows.take(WHISKS * WHISK_TICKS);
        let highest = |of: &dyn Fn(&Row) -> f64| rows.clone().map(of).fold(f64::MIN, f64::max);
        let a_whisk = |count: usize| format!("{}", count as f64 / WHISKS as f64);
        match self {
            Self::Theta => format!(
                "{:.4}",
                (highest(&|row| row.theta_deg[LEFT]) - 50.0) / 100.0
            ),
            Self::Highest => format!("{:.1}°", highest(&|row| row.theta_deg[side])),
            Self::Peaks => a_whisk(peaks(rows.map(|row| row.theta_deg[side]))),
            Self::Contacts => a_whisk(contacts(rows.map(|row| row.contact[side]))),
            Self::Gain => format!(
                "{:.3} to {:.3}",
                -highest(&|row| -row.g[LEFT]),
                highest(&|row| row.g[LEFT])
            ),
        }
    }
}

/// Contacts begun, from none on.
fn contacts(signal: impl Iterator<Item = f64>) -> usize {
    let (mut count, mut touching) = (0, false);
    for pi in signal {
        count += usize::from(!touching && pi > TOUCH);
        touching = pi > TOUCH || (touching && pi >= RELEASE);
    }
    count
}

/// A row of the table.
#[derive(Deserialize)]
struct Claim {
    /// What is claimed, where, and how it is measured.
    what: String,
    /// The figure whose run it is.
    figure: String,
    quantity: Quantity,
    side: usize,
    /// What is misprinted.
    printed: Printed,
}

/// The figures by their names in the table.
const FIGURES: [(&str, Figure); 5] = [
    ("6", FIG6),
    ("7", FIG7),
    ("8", FIG8),
    ("9", FIG9),
    ("free", FREE),
];

/// The table.
pub(super) fn section(page: &mut Page) -> Result<(), Error> {
    page.heading(2, "Misprints");
    page.say(
        "What the papers claim (BIOTACT, Sullivan et al. 2011), measured with the product's own \
         equations in f64 (forward Euler, 2 kHz, 2 Hz, no noise, the last five of twenty \
         whisks): once as the product reads the formula, once as it is printed.",
    );
    let mut rows = Vec::new();
    let mut claims = csv::Reader::from_reader(include_bytes!("misprints/claims.csv").as_slice());
    for row in claims.deserialize() {
        let row: Claim = row.map_err(refused)?;
        let (misprint, reading) = formulas(row.printed);
        let figure = FIGURES.iter().find(|(name, _)| *name == row.figure);
        let (_, figure) = figure.ok_or_else(|| refused("no such figure"))?;
        let measure = |printed| {
            let rows = run(figure, printed);
            rows.map(|rows| row.quantity.measure(row.side, &rows))
        };
        rows.push(vec![
            row.what,
            misprint.to_owned(),
            reading.to_owned(),
            measure(row.printed)?,
            measure(Printed::Nothing)?,
        ]);
    }
    page.table(
        "claim | as printed | as read | measured as printed | measured as read",
        rows,
    );
    page.say(format_args!(
        "Coupling (eq. 4): the text speaks of a time constant of one whisking period. With \
         τ₁₁ = 2 T_W, as printed beside it, a phase difference of 0.2 rad between the sides is \
         measured to decay with {:.3} T_W.",
        locking()?
    ));
    Ok(())
}

/// Time constant of the phase difference of the sides in whisks, from 0.2 rad
/// over two whisks, by the exact integrator in f64.
fn locking() -> Result<f64, Error> {
    let settings = PAPERS.settings(Integrator::Exact);
    let config = settings.build::<f64>().map_err(refused)?;
    let start = settings.start(apart(), [[1.0]; 2]).map_err(refused)?;
    let mut state = State::<f64, 2, 1>::new(&start, 1);
    for _ in 0..2 * WHISK_TICKS {
        config.step(&mut state, [0.0; 2]);
    }
    Ok(time_constant(config.oscillators.psi(&state.oscillators)))
}

/// Both sides on their circle, [`APART`] from each other.
fn apart() -> [[f64; 2]; 2] {
    [[1.0, 0.0], [libm::cos(APART), libm::sin(APART)]]
}

/// In whisks, from what is left of [`APART`] after two.
fn time_constant([left, right]: [[f64; 2]; 2]) -> f64 {
    let phase = |[a, b]: [f64; 2]| libm::atan2(b, a);
    -2.0 / libm::log((phase(right) - phase(left)) / APART)
}

const fn formulas(printed: Printed) -> (&'static str, &'static str) {
    match printed {
        Printed::Nothing => ("", ""),
        Printed::Mass => ("eq. 7: m = f_W²/100", "m = T_W²/100"),
        Printed::Lift => ("eq. 12: σ_g ζ", "g_nominal + σ_g ζ"),
        Printed::Decay => ("eq. 13: T/(τ_g (1 − g))", "(T/τ_g)(g_nominal − g)"),
    }
}

#[cfg(test)]
mod tests {
    use crate::accuracy::reference::{Case, GRID, State as Continuous};

    use super::{FIG6, FIG8, FIG9, FREE, LEFT, Printed, Quantity, run};

    const RIGHT: usize = 1;

    fn measure(figure: &super::Figure, of: (Quantity, usize), printed: Printed) -> String {
        of.0.measure(of.1, &run(figure, printed).unwrap())
    }

    /// Figures of an independent program for both readings.
    #[test]
    fn claims_hold_as_read_and_fail_as_printed() {
        use Printed::{Lift, Mass, Nothing};
        for (figure, quantity, side, printed, expected) in [
            (&FIG6, Quantity::Highest, LEFT, Nothing, "149.7°"),
            (&FIG6, Quantity::Highest, LEFT, Mass, "137.5°"),
            (&FIG8, Quantity::Peaks, LEFT, Nothing, "2"),
            (&FIG8, Quantity::Peaks, LEFT, Mass, "1"),
            (&FIG8, Quantity::Contacts, LEFT, Mass, "1"),
            (&FIG9, Quantity::Highest, RIGHT, Nothing, "130.4°"),
            (&FIG9, Quantity::Highest, RIGHT, Mass, "114.4°"),
            (&FIG9, Quantity::Contacts, RIGHT, Nothing, "1"),
            (&FIG9, Quantity::Contacts, RIGHT, Lift, "0"),
            (&FREE, Quantity::Gain, LEFT, Nothing, "1.000 to 1.000"),
        ] {
            assert_eq!(
                measure(figure, (quantity, side), printed),
                expected,
                "{quantity:?} {printed:?}"
            );
        }
    }

    /// The same start solved by the reference: the same decay over the same
    /// two whisks.
    #[test]
    fn sides_lock_as_the_continuous_equations_do() {
        let mut truth = Continuous::new(&Case {
            psi: super::apart(),
            gain: 1.0,
        });
        for _ in 0..2 * GRID {
            truth = truth.runge_kutta(1.0 / GRID as f64, [1.0; 3]);
        }
        let [expected, found] = [super::time_constant(truth.psi), super::locking().unwrap()];
        assert!((found - expected).abs() < 1e-4, "{found} {expected}");
        assert!((expected - 2.0).abs() < 0.01, "{expected}");
    }

    #[test]
    fn the_printed_decay_never_rests_at_the_nominal_gain() {
        let range = measure(&FREE, (Quantity::Gain, LEFT), Printed::Decay);
        assert_ne!(range, "1.000 to 1.000");
    }
}
