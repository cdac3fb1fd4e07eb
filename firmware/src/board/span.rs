//! Words of memory that nothing writes.

/// Words that stay where and as they are.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    pub(crate) address: usize,
    pub(crate) words: usize,
}

impl Span {
    pub(crate) const NONE: Self = Self {
        address: 0,
        words: 0,
    };

    /// Those of something which stays where it is and which nothing writes from now on. A part
    /// of a word at its end is left out; there is none.
    pub(crate) fn of<T: ?Sized>(constant: &T) -> Self {
        Self {
            address: core::ptr::from_ref(constant).addr(),
            words: size_of_val(constant) / size_of::<u32>(),
        }
    }
}
