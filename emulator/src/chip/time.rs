//! The emulated chip's time.

/// Time since power-up, picoseconds: wraps after half a year.
pub(crate) type Ps = u64;
