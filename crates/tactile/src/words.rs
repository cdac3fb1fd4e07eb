//! Where a model's words lie, and what the code that reads them has to know of.

/// The words of a model's file.
pub trait Words: AsRef<[u32]> {
    /// Whether the model may have roughness, floors and touches. Where not, a program
    /// has no code for them.
    const JOINT: bool = true;
}

impl Words for &[u32] {}

#[cfg(feature = "std")]
impl Words for std::boxed::Box<[u32]> {}

/// The words of a model without roughness, floors or touches, as the papers' are; see
/// [`Model::into_single`](crate::Model::into_single).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Single<W = &'static [u32]>(pub(crate) W);

impl<W: AsRef<[u32]>> AsRef<[u32]> for Single<W> {
    fn as_ref(&self) -> &[u32] {
        self.0.as_ref()
    }
}

impl<W: AsRef<[u32]>> Words for Single<W> {
    const JOINT: bool = false;
}
