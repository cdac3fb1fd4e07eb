//! Capturing: from records to a recording, label by label.

mod alike;
mod checks;
mod file;
mod label;
mod touches;

pub(crate) use checks::Checks;
pub(crate) use file::{CALIBRATION, FIRST_TOUCH, Recording, SIDE, origin_of};
pub(crate) use label::{Label, Stands, stands, token};
pub(crate) use touches::{Touches, sampled};
