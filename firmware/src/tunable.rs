//! The constants of a configuration that can be changed while a module runs, each with its
//! number.
//!
//! A part that was left out of the program has none. What only the start uses, and what types
//! say, is no constant: which integrator, which parts, how many whiskers.

mod numbers;
mod parts;

pub use numbers::{TUNABLE_COUNT, number, tunable_name};

use whisking::{AsWords, Bound, WordRow};

/// Does something with every constant of a configuration.
pub trait Visitor {
    /// A constant.
    fn constant<T: AsWords>(&mut self, number: u8, place: &mut T, bound: Bound);

    /// One of a row, its `n`-th.
    fn in_row<T: WordRow>(&mut self, number: u8, row: &mut T, n: usize, bound: Bound);
}

/// Has constants, in number format `R`.
pub trait Tunable<R> {
    /// Shows all of them to the visitor, in the order of their numbers within a part.
    fn visit(&mut self, visitor: &mut impl Visitor);
}

/// Nothing.
impl<R> Tunable<R> for () {
    fn visit(&mut self, _: &mut impl Visitor) {}
}

/// There or not at run time, for simulations of any scene.
impl<R, T: Tunable<R>> Tunable<R> for Option<T> {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        if let Some(part) = self {
            part.visit(visitor);
        }
    }
}
