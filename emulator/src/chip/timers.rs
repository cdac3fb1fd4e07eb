//! Which timers the chip has, and what each can do.

/// Their places in [`super::Chip::timers`]: those of APB1, then those of APB2.
pub(super) const TIM2: usize = 0;
pub(super) const TIM3: usize = 1;
pub(super) const TIM5: usize = 2;
pub(super) const TIM6: usize = 3;
pub(super) const TIM7: usize = 4;
pub(super) const TIM1: usize = 5;
pub(super) const TIM8: usize = 6;

/// What a timer can do.
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

/// All of them.
pub(super) const KINDS: [Kind; 7] = [
    Kind::Wide,
    Kind::General,
    Kind::Wide,
    Kind::Basic,
    Kind::Basic,
    Kind::Advanced,
    Kind::Advanced,
];

impl Kind {
    /// Largest count.
    pub(super) const fn mask(self) -> u32 {
        match self {
            Self::Wide => u32::MAX,
            Self::Basic | Self::General | Self::Advanced => 0xFFFF,
        }
    }
}
