//! The IMP of all vibrissae of a pad, window by window, and over a sweep.

use super::peaks::{Band, Peaks};
use crate::error::Error;

/// The IMP of N vibrissae: an immutable configuration. PSIK's pad has N = 33.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Imp<const N: usize> {
    window: u32,
    band: Band,
}

/// What changes as samples come in: 32 N + 8 bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImpState<const N: usize> {
    vibrissae: [Peaks; N],
    /// Samples to the end of the window; not zero.
    left: u32,
}

impl<const N: usize> Imp<N> {
    /// An IMP averaged over windows of so many samples.
    ///
    /// # Errors
    ///
    /// The window or N is zero.
    pub const fn new(window: u32, band: Band) -> Result<Self, Error> {
        if window == 0 {
            return Err(Error::Window(0));
        }
        if N == 0 {
            return Err(Error::Channels);
        }
        Ok(Self { window, band })
    }

    /// The state before the first sample.
    pub fn state(&self) -> ImpState<N> {
        ImpState {
            vibrissae: [Peaks::default(); N],
            left: self.window,
        }
    }

    /// Takes a sample of all vibrissae, x and y in codes. With the last of a
    /// window comes the IMP of each over that window, in units of 2⁻¹⁶ code a
    /// sample.
    #[inline]
    pub fn push(&self, state: &mut ImpState<N>, codes: &[[i16; 2]; N]) -> Option<[u32; N]> {
        for (peaks, [x, y]) in state.vibrissae.iter_mut().zip(codes) {
            peaks.push(self.band, *x, *y);
        }
        state.left = state.left.wrapping_sub(1);
        if state.left != 0 {
            return None;
        }
        state.left = self.window;
        Some(end(state))
    }

    /// The end of a sweep: the IMP of the window left open, if it holds a
    /// sample. The state is then as new.
    pub fn finish(&self, state: &mut ImpState<N>) -> Option<[u32; N]> {
        let found = (state.left < self.window).then(|| end(state));
        *state = self.state();
        found
    }
}

#[inline(never)]
fn end<const N: usize>(state: &mut ImpState<N>) -> [u32; N] {
    state.vibrissae.each_mut().map(Peaks::take)
}

/// The sum of the IMP over the windows of a sweep: what PSIK section 3.2.1
/// gives its network, one number a vibrissa.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImpSweep<const N: usize> {
    sums: [i32; N],
}

impl<const N: usize> Default for ImpSweep<N> {
    fn default() -> Self {
        Self { sums: [0; N] }
    }
}

impl<const N: usize> ImpSweep<N> {
    /// Adds a window. Sums stop at 2³¹ − 1.
    #[inline]
    pub fn add(&mut self, window: &[u32; N]) {
        for (sum, &imp) in self.sums.iter_mut().zip(window) {
            *sum = sum.saturating_add_unsigned(imp);
        }
    }

    /// The sums, in units of 2⁻¹⁶ code a sample: as f32 the
    /// inputs of a [`crate::mlp::Mlp`].
    pub fn sums(&self) -> &[i32; N] {
        &self.sums
    }
}
