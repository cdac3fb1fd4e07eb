//! A part of a configuration that may be absent: by type, so that the compiler
//! leaves it out, or at run time.

/// Holds a `T`, or does not.
///
/// A board uses [`Present`] and [`Absent`]: the compiler then knows which parts
/// there are although their constants stand in RAM. Simulations of any scene
/// use `Option`.
pub trait Optional<T> {
    /// The part, if there is one.
    fn part(&self) -> Option<&T>;

    /// The same, to be changed.
    fn part_mut(&mut self) -> Option<&mut T>;
}

/// A part that is there.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "bake",
    derive(databake::Bake),
    databake(path = whisking)
)]
pub struct Present<T>(
    /// The part.
    pub T,
);

/// A part that is not there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(
    feature = "bake",
    derive(databake::Bake),
    databake(path = whisking)
)]
pub struct Absent;

impl<T> Optional<T> for Present<T> {
    #[inline]
    fn part(&self) -> Option<&T> {
        Some(&self.0)
    }

    #[inline]
    fn part_mut(&mut self) -> Option<&mut T> {
        Some(&mut self.0)
    }
}

impl<T> Optional<T> for Absent {
    #[inline]
    fn part(&self) -> Option<&T> {
        None
    }

    #[inline]
    fn part_mut(&mut self) -> Option<&mut T> {
        None
    }
}

impl<T> Optional<T> for Option<T> {
    #[inline]
    fn part(&self) -> Option<&T> {
        self.as_ref()
    }

    #[inline]
    fn part_mut(&mut self) -> Option<&mut T> {
        self.as_mut()
    }
}
