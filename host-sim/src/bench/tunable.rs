//! The constants of a scene's module that can be changed while it runs, as words.

use std::collections::BTreeMap;

use firmware::{Tunable, Visitor};
use plan::NumberFormat;
use scene::Scene;
use whisking::{AsWords, Bound, Fix, Real, WordRow};

use super::config::{RunsOn, broken, config};
use crate::Error;

/// AsWords of constants by their numbers.
pub type ConstantWords = BTreeMap<u8, [u32; 2]>;

/// A constant of a module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TunableConstant {
    /// Its words in the module's number format.
    pub words: [u32; 2],
    /// Its value.
    pub value: f64,
}

/// Constants by their numbers.
pub type TunableConstants = BTreeMap<u8, TunableConstant>;

/// Any constant that is one.
const ANY: Bound = Bound::signed(62);

/// Collects what it is shown, or what takes its place.
struct Collected<'i> {
    instead: &'i ConstantWords,
    found: TunableConstants,
}

impl Visitor for Collected<'_> {
    fn constant<T: AsWords>(&mut self, number: u8, place: &mut T, _: Bound) {
        let given = self.instead.get(&number);
        let read = given.and_then(|words| T::from_words(*words, ANY));
        let (words, value) = (place.words(), read.unwrap_or(*place).value());
        let words = given.copied().unwrap_or(words);
        self.found.insert(number, TunableConstant { words, value });
    }

    fn in_row<T: WordRow>(&mut self, number: u8, row: &mut T, n: usize, _: Bound) {
        let mut read = *row;
        let given = self.instead.get(&number);
        // AsWords that are none leave what is there.
        let _ = given.is_some_and(|words| read.set_words(n, *words, ANY));
        let words = given.copied().unwrap_or(row.words(n));
        let value = read.value(n);
        self.found.insert(number, TunableConstant { words, value });
    }
}

/// The constants of `scene` in a number format, those of `instead` in place of its own; `gate`
/// is the contact of its model.
///
/// # Errors
/// [`Error::Input`] if the scene's position control is unstable, or if it and its model do not
/// fit each other; [`Error::Work`] for more than one whisker a side.
pub fn tunable_constants(
    scene: &Scene,
    gate: Option<f32>,
    format: NumberFormat,
    runs_on: RunsOn,
    instead: &ConstantWords,
) -> Result<TunableConstants, Error> {
    match format {
        NumberFormat::Single => of::<f32>(scene, gate, runs_on, instead),
        NumberFormat::Double => of::<f64>(scene, gate, runs_on, instead),
        NumberFormat::Fixed => of::<Fix>(scene, gate, runs_on, instead),
    }
}

fn of<R: Real>(
    scene: &Scene,
    gate: Option<f32>,
    runs_on: RunsOn,
    instead: &ConstantWords,
) -> Result<TunableConstants, Error> {
    match scene.head.sides.count() {
        1 => shaped::<R, 1>(scene, gate, runs_on, instead),
        _ => shaped::<R, 2>(scene, gate, runs_on, instead),
    }
}

fn shaped<R: Real, const S: usize>(
    scene: &Scene,
    gate: Option<f32>,
    runs_on: RunsOn,
    instead: &ConstantWords,
) -> Result<TunableConstants, Error> {
    let plan = plan::motion::<R, S, 1>(scene).map_err(broken)?;
    let mut config = config(scene, plan.as_ref(), gate, runs_on)?;
    let mut collected = Collected {
        instead,
        found: TunableConstants::new(),
    };
    config.visit(&mut collected);
    Ok(collected.found)
}
