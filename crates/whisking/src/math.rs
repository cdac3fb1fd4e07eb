//! Elementary functions of the tick, for each number format.

pub(crate) mod constant;
pub(crate) mod fixed;
pub(crate) mod product;
pub(crate) mod single;
