//! A sensor whose zero is found by itself.

use mlx90333::{Decoder, Word};

use crate::SensorFault;
use crate::io::WordSource;
use crate::zero::Zero;

/// A source whose zero is found by itself.
#[derive(Debug)]
pub struct Zeroed<F> {
    source: F,
    zero: Zero,
}

impl<F> Zeroed<F> {
    /// A source at mid-scale until its first silence.
    pub fn new(source: F) -> Self {
        Self {
            source,
            zero: Zero::default(),
        }
    }

    /// The source itself.
    pub const fn source_mut(&mut self) -> &mut F {
        &mut self.source
    }
}

impl<F: WordSource> WordSource for Zeroed<F> {
    #[inline]
    fn words(&mut self, decoder: Decoder) -> Result<[Word; 2], SensorFault> {
        self.source.words(decoder)
    }

    #[inline]
    fn begin(&mut self) {
        self.source.begin();
    }

    #[inline]
    fn zero(&mut self) -> Option<&mut Zero> {
        Some(&mut self.zero)
    }
}
