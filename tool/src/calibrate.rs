//! What `whisker calibrate` and `whisker check` do with a module: moving one whisker and
//! listening to it, and what is read from that.

mod findings;
mod identify;
mod listening;
mod moves;
mod picture;
mod rest;
mod watched;

pub(crate) use findings::{Finding, findings, table};
pub(crate) use identify::{Gains, Motor, identify, suggest};
pub(crate) use listening::Listening;
pub(crate) use moves::{Push, REST_DEG, lead, push, steps};
pub(crate) use picture::{ANGLE, Panel, picture};
pub(crate) use rest::{HALF_RANGE, MIDDLE, Zero, is_at_end};
pub(crate) use watched::{LEAST_S, Watched, watch};
