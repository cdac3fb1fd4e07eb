//! Number formats, and the configurations that the build script has made in each.

use firmware::{Config, MotionConfig};
use whisking::{Fix, MAX_SIDES, Number, Real, filter, oscillator};

/// A number format to be measured, with the bytes of modules: 2 kHz, 2 whisks a second, sides
/// coupled, contact filter, RCP and CIA, a classifier of the first whisker.
pub trait Format: Number {
    /// Its name in the table.
    const NAME: &'static str;
    /// One side with a whisker.
    const LONE: &'static [u8];
    /// Two sides with a whisker each.
    const PAIR: &'static [u8];
    /// Two sides with twelve whiskers each.
    const HEAD: &'static [u8];
    /// As [`Self::PAIR`], with the papers' integrators.
    const EULER: &'static [u8];
    /// As [`Self::PAIR`], with noise, which few scenes have.
    const NOISY: &'static [u8];
}

macro_rules! bytes {
    ($module:literal, $format:literal) => {
        include_bytes!(concat!(env!("OUT_DIR"), "/", $module, "-", $format))
    };
}

macro_rules! formats {
    ($($number:ty: $name:literal,)*) => {$(
        impl Format for $number {
            const NAME: &'static str = $name;
            const LONE: &'static [u8] = bytes!("1x1", $name);
            const PAIR: &'static [u8] = bytes!("2x1", $name);
            const HEAD: &'static [u8] = bytes!("2x12", $name);
            const EULER: &'static [u8] = bytes!("2x1-euler", $name);
            const NOISY: &'static [u8] = bytes!("2x1-noise", $name);
        }
    )*};
}

formats! {
    f32: "f32",
    f64: "f64",
    Fix: "fix",
}

/// The configuration of these bytes.
///
/// # Panics
/// If there is no room for so many whiskers.
pub fn config<R: Format>(bytes: &[u8]) -> Config<R> {
    postcard::from_bytes(bytes).expect("room for all whiskers")
}

/// What the kernels take of a configuration.
#[derive(Debug)]
pub struct Parts<R: Real> {
    /// The contact filter.
    pub h50: filter::Config<R>,
    /// All that moves.
    pub motion: MotionConfig<R>,
}

/// The parts of the configuration of these bytes.
///
/// # Panics
/// As [`config`].
pub fn parts<R: Format>(bytes: &[u8]) -> Parts<R> {
    let Config {
        contact, motion, ..
    } = config(bytes);
    let both = contact.zip(motion);
    let (h50, motion) = both.expect("an active module that feels");
    Parts { h50, motion }
}

/// Oscillators with their drives.
pub type Oscillators<'p, R> = (
    &'p oscillator::Config<R>,
    oscillator::State<R>,
    [R; MAX_SIDES],
);

/// The oscillators of a configuration, at their start.
pub fn oscillators<R: Real>(parts: &Parts<R>) -> Oscillators<'_, R> {
    let start = parts.motion.start.sides.iter();
    let state = oscillator::State::new(start.map(|side| side.oscillator).collect());
    (
        &parts.motion.whisking.oscillators,
        state,
        [R::ZERO; MAX_SIDES],
    )
}
