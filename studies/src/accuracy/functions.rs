//! Elementary functions: error and instructions of the product's, of Rust's
//! libm and of micromath.

use anyhow::Result;
use whisking::{Fix, Real};

use super::counts::{Counts, Target, cell};
use crate::chart::{Axis, Mark, Panel, Series};
use crate::page::{Page, short, verdict};

/// Intervals of the grid of each function.
const GRID: i32 = 600_000;

/// A function of which there are several implementations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Tanh,
    Exp,
    Unit,
}

/// Who implements it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Maker {
    F64,
    F32,
    Fixed,
    Libm,
    Micromath,
}

impl Function {
    pub(super) const ALL: [Self; 3] = [Self::Tanh, Self::Exp, Self::Unit];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Tanh => "tanh 2x",
            Self::Exp => "exp(−x²)",
            Self::Unit => "unit vector",
        }
    }

    const fn range(self) -> &'static str {
        match self {
            Self::Tanh => "|2x| ≤ 3",
            Self::Exp => "x from 0 to 1.5",
            Self::Unit => "a component of (x, y)/r, r from 0.05 to 1.5, all directions",
        }
    }

    /// Largest error at most, micromath's instructions at most halved: a
    /// thousandth of micromath's error, and 97 and 83 instructions.
    const fn goal(self) -> Option<(f64, f64)> {
        match self {
            Self::Tanh => Some((1.1e-6, 48.5)),
            Self::Exp => Some((1.2e-6, 41.5)),
            Self::Unit => None,
        }
    }
}

impl Maker {
    pub(super) const ALL: [Self; 5] = [
        Self::F64,
        Self::F32,
        Self::Fixed,
        Self::Libm,
        Self::Micromath,
    ];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::F64 => "whisking f64",
            Self::F32 => "whisking f32",
            Self::Fixed => "whisking fixed",
            Self::Libm => "Rust libm f32",
            Self::Micromath => "micromath f32",
        }
    }

    /// Kernel and format in the table of instructions.
    const fn kernel(self, function: Function) -> (&'static str, &'static str) {
        let format = match self {
            Self::F64 => "f64",
            Self::Fixed => "fix",
            Self::F32 | Self::Libm | Self::Micromath => "f32",
        };
        let kernel = match (self, function) {
            (Self::Libm, Function::Tanh) => "peer: libm tanhf",
            (Self::Libm, Function::Exp) => "peer: libm expf",
            (Self::Libm, Function::Unit) => "peer: libm sqrtf",
            (Self::Micromath, Function::Tanh) => "peer: micromath tanh by exp",
            (Self::Micromath, Function::Exp) => "peer: micromath exp",
            (Self::Micromath, Function::Unit) => "peer: micromath invsqrt",
            (_, Function::Tanh) => "drive",
            (_, Function::Exp) => "exp_neg_square",
            (_, Function::Unit) => "unit",
        };
        (kernel, format)
    }

    /// The function at (`x`, `y`), and the input as this format holds it.
    #[inline]
    pub(super) fn at(self, function: Function, x: f64, y: f64) -> (f64, [f64; 2]) {
        match self {
            Self::F64 => ours::<f64>(function, x, y),
            Self::F32 => ours::<f32>(function, x, y),
            Self::Fixed => ours::<Fix>(function, x, y),
            Self::Libm => theirs(function, x, y, libm::tanhf, libm::expf, |square| {
                1.0 / libm::sqrtf(square)
            }),
            Self::Micromath => {
                // By full path: std's own methods of these names would win.
                let tanh = |x: f32| {
                    let e = micromath::F32Ext::exp(x + x);
                    (e - 1.0) / (e + 1.0)
                };
                let exp = micromath::F32Ext::exp;
                theirs(function, x, y, tanh, exp, micromath::F32Ext::invsqrt)
            }
        }
    }
}

/// The product's; tanh 2x is 2 W − 1.
#[inline]
fn ours<R: Real>(function: Function, x: f64, y: f64) -> (f64, [f64; 2]) {
    let [x, y] = [x, y].map(R::from_f64);
    let value = match function {
        Function::Tanh => 2.0 * whisking::muscle::drive(x).to_f64() - 1.0,
        Function::Exp => x.exp_neg_square().to_f64(),
        Function::Unit => R::unit(x, y).map_or(f64::NAN, |[x, _]| x.to_f64()),
    };
    (value, [x, y].map(R::to_f64))
}

#[inline]
fn theirs(
    function: Function,
    x: f64,
    y: f64,
    tanh: impl Fn(f32) -> f32,
    exp: impl Fn(f32) -> f32,
    inverse_root: impl Fn(f32) -> f32,
) -> (f64, [f64; 2]) {
    let [x, y] = [x as f32, y as f32];
    let value = match function {
        Function::Tanh => tanh(x + x),
        Function::Exp => exp(-(x * x)),
        Function::Unit => x * inverse_root(x * x + y * y),
    };
    (f64::from(value), [x, y].map(f64::from))
}

fn truth(function: Function, [x, y]: [f64; 2]) -> f64 {
    match function {
        Function::Tanh => libm::tanh(2.0 * x),
        Function::Exp => libm::exp(-x * x),
        Function::Unit => x / libm::sqrt(x * x + y * y),
    }
}

/// Point `n` of [`GRID`].
pub(super) fn point(function: Function, n: i32) -> (f64, f64) {
    let part = f64::from(n) / f64::from(GRID);
    match function {
        Function::Tanh => (3.0 * part - 1.5, 0.0),
        Function::Exp => (1.5 * part, 0.0),
        // A spiral: every direction and every radius, without a common period.
        Function::Unit => {
            let (sin, cos) = libm::sincos(f64::from(n) * 0.37);
            let r = 0.05 + 1.45 * part;
            (r * cos, r * sin)
        }
    }
}

/// Largest and root-mean-square error over the grid.
fn errors(function: Function, maker: Maker) -> [f64; 2] {
    let (mut worst, mut squares) = (0.0_f64, 0.0);
    for n in 0..=GRID {
        let (x, y) = point(function, n);
        let (found, held) = maker.at(function, x, y);
        let error = found - truth(function, held);
        worst = worst.max(error.abs());
        squares += error * error;
    }
    [worst, libm::sqrt(squares / f64::from(GRID + 1))]
}

/// Errors and instructions of every function and implementation.
pub(super) fn section(page: &mut Page, counts: &Counts) -> Result<()> {
    page.heading(2, "Elementary functions");
    page.say(format_args!(
        "Errors are absolute, at the input as the format holds it, over {GRID} points, against \
         libm in f64, which is also what the product's f64 calls: its own error is therefore \
         below what this table can show. The drive of a muscle is (tanh 2x + 1)/2. For the unit \
         vector libm's row counts its square root alone and micromath's its inverse root, \
         without products and division."
    ));
    page.say(
        "Goals, for the product's f32 and fixed: a thousandth of micromath's error (tanh 1.1e-3, \
         exp 1.2e-3) at half its instructions on the Cortex-M4F (97 and 83) or fewer.",
    );
    let mut panels = Vec::new();
    for function in Function::ALL {
        let measured = Maker::ALL.map(|maker| (maker, errors(function, maker)));
        let count = |maker: Maker, target| {
            let (kernel, format) = maker.kernel(function);
            counts.of(kernel, format, target)
        };
        let row = |(maker, [worst, rms]): (Maker, [f64; 2])| {
            let work = count(maker, Target::M4F);
            vec![
                maker.name().to_owned(),
                short(worst),
                short(rms),
                cell(work),
                cell(count(maker, Target::M0)),
                judged(function, maker, worst, work),
            ]
        };
        page.say(format_args!(
            "**{}**, {}.",
            function.name(),
            function.range()
        ));
        page.table(
            "implementation | largest error | RMS error | Cortex-M4F instructions | Cortex-M0+ | goals",
            measured.map(row),
        );
        let point = |(maker, [worst, _]): (Maker, [f64; 2])| {
            Some((maker, (count(maker, Target::M4F)?, worst)))
        };
        panels.push((function, measured.into_iter().filter_map(point).collect()));
    }
    picture(page, panels)
}

fn judged(function: Function, maker: Maker, worst: f64, work: Option<f64>) -> String {
    let ours = matches!(maker, Maker::F32 | Maker::Fixed);
    match function.goal().filter(|_| ours) {
        None => String::new(),
        Some((error, instructions)) => format!(
            "error {}, instructions {}",
            verdict(worst <= error),
            work.map_or("not counted", |work| verdict(work <= instructions))
        ),
    }
}

type Points = Vec<(Maker, (f64, f64))>;

fn picture(page: &mut Page, panels: Vec<(Function, Points)>) -> Result<()> {
    let panel = |(function, points): (Function, Points)| {
        let x = points.iter().map(|(_, point)| point.0);
        // An error of zero (f64 against itself) has no place on the scale.
        let y = points.iter().flat_map(|(_, (_, y))| [y / 2.0, y * 2.0]);
        Panel {
            title: function.name().to_owned(),
            x: Axis::decades("instructions, Cortex-M4F", x),
            y: Axis::decades("largest error", y),
            series: points
                .iter()
                .map(|(maker, (x, y))| {
                    let points = if *y > 0.0 { vec![(*x, *y)] } else { Vec::new() };
                    Series::new(maker.name(), *maker as usize, Mark::Dot, points).unjoined()
                })
                .collect(),
        }
    };
    let full = panels.into_iter().filter(|(_, points)| !points.is_empty());
    let panels: Vec<Panel> = full.map(panel).collect();
    if !panels.is_empty() {
        page.panels("functions.svg", "error against instructions", &panels)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Function, Maker, errors};

    /// micromath's known errors, and the goals that follow from them.
    #[test]
    fn errors_are_the_known_ones_and_the_product_s_a_thousandth() {
        for (function, known) in [(Function::Tanh, 1.1e-3), (Function::Exp, 1.2e-3)] {
            let [micromath, _] = errors(function, Maker::Micromath);
            assert!(
                (micromath / known - 1.0).abs() < 0.1,
                "{function:?}: {micromath:e}"
            );
            for maker in [Maker::F32, Maker::Fixed] {
                let [worst, rms] = errors(function, maker);
                assert!(
                    worst <= known / 1000.0 && rms < worst,
                    "{maker:?}: {worst:e}"
                );
            }
            assert!(errors(function, Maker::Libm)[0] < 2e-7);
        }
        assert!(errors(Function::Unit, Maker::F32)[0] < 3e-7);
        assert!(errors(Function::Unit, Maker::F64)[0] < 1e-15);
    }
}
