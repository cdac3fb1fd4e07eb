//! One module a data set: which job is which condition, and how it is recorded.

pub(crate) mod corridor;
pub(crate) mod floor;
pub(crate) mod head;
pub(crate) mod pad;
pub(crate) mod table;
mod whiskers;

use host_sim::Error;

/// The physics refused a setting of a rig.
fn refused(error: impl std::fmt::Display) -> Error {
    Error::Work(format!("physics: {error}"))
}
