//! Where a model's words lie, and what the code that reads them has to know of.

/// Whether models may have roughness, floors and touches. Where not, a program has no code
/// for them and refuses such models: it was built without the feature `joint`.
pub const JOINT: bool = cfg!(feature = "joint");

/// Whether models may have a second opinion; likewise, the feature `opinion`.
pub const OPINION: bool = cfg!(feature = "opinion");

/// Whether classes may have priors and thresholds of their own; likewise, the feature `priors`.
pub const PRIORS: bool = cfg!(feature = "priors");

/// The words of a model's file.
pub trait Words: AsRef<[u32]> {}

impl Words for &[u32] {}

#[cfg(feature = "std")]
impl Words for std::boxed::Box<[u32]> {}
