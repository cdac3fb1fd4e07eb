//! What a timer can do.

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Kind {
    /// It counts 16 bits of time.
    #[default]
    Basic,
    /// It has channels, too.
    General,
    /// It counts 32 bits, and has channels.
    Wide,
    /// It has channels, and its outputs need BDTR.MOE.
    Advanced,
}

impl Kind {
    pub(super) const fn mask(self) -> u32 {
        match self {
            Self::Wide => u32::MAX,
            Self::Basic | Self::General | Self::Advanced => 0xFFFF,
        }
    }
}
