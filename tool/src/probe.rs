//! A board behind its debug probe, by probe-rs; without the feature `probe` a message how to
//! get it.

#[cfg(feature = "probe")]
mod behind;
#[cfg(feature = "probe")]
mod brown_out;
#[cfg(feature = "probe")]
mod find;
#[cfg(feature = "probe")]
mod flash;
#[cfg(feature = "probe")]
mod memory;
#[cfg(not(feature = "probe"))]
mod without;

#[cfg(not(feature = "probe"))]
pub(crate) use without::{flash, is_there, open, seen};
#[cfg(feature = "probe")]
pub(crate) use {behind::open, find::is_there, find::seen, flash::flash};

/// A probe on USB, as far as it is seen without the chip behind it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SeenProbe {
    pub(crate) name: String,
    pub(crate) serial: String,
    pub(crate) may_open: bool,
    /// The chip behind it by its [identity](crate::source::Board::chip_id), or why that
    /// cannot be read.
    pub(crate) chip: Result<u16, String>,
    /// What the module in the chip says that it runs, if one answers.
    pub(crate) module: Option<String>,
}
