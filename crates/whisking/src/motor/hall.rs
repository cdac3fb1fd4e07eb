//! Follows a rotor through its Hall sectors and counts them.

use super::{Fault, Sector};

/// Position from Hall codes: a wrapping count of sectors, forward positive,
/// and a check that the rotor is not too fast for the tick.
///
/// Between two ticks the shorter way round is taken:
///
/// | sectors forward | counted as |
/// |---|---|
/// | 0 | no motion |
/// | 1, 5 | +1, −1 |
/// | 2, 4 | +2, −2; a skip |
/// | 3 | ±3 the way it last moved; a skip, and a wrong guess leaves the count 6 off |
///
/// `skip_limit` skips in succession are a fault. With a limit of N a steady rotor passes below
/// 2 − 1/N sectors per tick and is caught above; from 5 on the codes look like slow motion the
/// other way, but a motor must run up through the speeds between. With one pole pair at 2000 Hz,
/// one sector per tick is 20 000 turns per minute, and the default N = 4 allows 35 000. A 10 Hz
/// whisk of ±50° through an 11:1 gear needs at most 5 800 (0.29 sectors per tick).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HallTracker {
    skip_limit: u8,
    sector: Option<Sector>,
    counts: i32,
    backward: bool,
    skips: u8,
}

impl HallTracker {
    /// A tracker at count zero that faults at `skip_limit` skips in succession; 0 is taken as 1.
    pub const fn new(skip_limit: u8) -> Self {
        Self {
            skip_limit,
            sector: None,
            counts: 0,
            backward: false,
            skips: 0,
        }
    }

    /// Takes in the Hall code of this tick (bit 0 is sensor 1). The first
    /// valid code only gives the sector.
    ///
    /// # Errors
    /// [`Fault::InvalidHall`], with nothing changed; [`Fault::SkippedSector`],
    /// with the motion counted all the same.
    #[inline]
    pub fn update(&mut self, code: u8) -> Result<Sector, Fault> {
        let sector = Sector::from_hall(code).ok_or(Fault::InvalidHall(code))?;
        let ahead = self.sector.map_or(0, |last| sector.ahead_of(last));
        self.sector = Some(sector);
        let moved: i32 = match ahead {
            0 => 0,
            1 => 1,
            2 => 2,
            3 if !self.backward => 3,
            3 => -3,
            4 => -2,
            _ => -1,
        };
        if moved != 0 {
            self.backward = moved < 0;
        }
        self.counts = self.counts.wrapping_add(moved);
        self.skips = if moved.unsigned_abs() > 1 {
            self.skips.saturating_add(1)
        } else {
            0
        };
        if self.skips >= self.skip_limit.max(1) {
            return Err(Fault::SkippedSector);
        }
        Ok(sector)
    }

    /// Sectors passed since the start, forward less backward, wrapping.
    #[inline]
    pub const fn counts(&self) -> i32 {
        self.counts
    }

    /// Forgets the skips in succession; position and count stay.
    pub fn forget_skips(&mut self) {
        self.skips = 0;
    }
}
