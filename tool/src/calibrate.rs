//! What `whisker calibrate` and `whisker check` do with a module: moving one whisker and
//! listening to it, and what is read from that.

mod findings;
mod identify;
mod listening;
mod moves;
mod picture;
mod watched;

pub(crate) use findings::{Finding, findings, table};
pub(crate) use identify::{Gains, Motor, identify, suggest};
pub(crate) use listening::Listening;
pub(crate) use moves::{Push, REST_DEG, lead, push, steps};
pub(crate) use picture::{ANGLE, Panel, picture};
pub(crate) use watched::{HALF_RANGE, LEAST_S, MIDDLE, Watched, Zero, at_rest, is_at_end, watch};
