//! What a board finds as it reads an MLX90333 by its driver, before the first tick: the same driver
//! over the same trait that the simulator reads by.
//!
//! It reports, and disarms nothing: what is still wrong in a tick is a fault there within 0.1 s.

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::SpiDevice;
use micromath::F32;
use mlx90333::timing::SS_HIGH_US;
use mlx90333::{Mlx90333, Word};

use crate::SensorFault;
use crate::boards::Pacing;
use crate::faults::number;
use crate::io::decode_otherwise;

/// How often it is read.
pub const READINGS: u8 = 16;

/// Farther from the first a code counts as this far, so that sums have 32 bits.
const FARTHEST: i32 = 4_095;

/// Numbers of faults that a frame can have, from that of the bus on.
const FIRST: u8 = number::BUS;
const FAULTS: usize = (number::STUCK_WORDS - FIRST + 1) as usize;

/// What was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SelfTest {
    good: u8,
    faults: [u8; FAULTS],
    noise_tenths: [u16; 2],
}

impl SelfTest {
    /// Reads `sensor`, whose start-up is over. Where a frame was refused it rests for as long as it
    /// needs to find the start of the next.
    pub fn of<SPI: SpiDevice>(
        sensor: &mut Mlx90333<SPI>,
        delay: &mut impl DelayNs,
        pacing: Pacing,
    ) -> Self {
        let mut found = Self::default();
        let (mut x, mut y) = (Spread::default(), Spread::default());
        for _ in 0..READINGS {
            let read = sensor.read_raw_paced(pacing.gap_ns);
            let read = read.map_err(|_| SensorFault::Bus).and_then(|bytes| {
                decode_otherwise(sensor.decoder(), bytes).map_err(SensorFault::Frame)
            });
            let rest_us = match read {
                Ok(frame) => {
                    found.good += 1;
                    x.add(frame.first);
                    y.add(frame.second);
                    pacing.rest_us
                }
                Err(fault) => {
                    let place = fault.code().wrapping_sub(FIRST);
                    if let Some(count) = found.faults.get_mut(usize::from(place)) {
                        *count += 1;
                    }
                    pacing.rest_us.max(SS_HIGH_US)
                }
            };
            delay.delay_us(rest_us);
        }
        found.noise_tenths = [x.tenths(found.good), y.tenths(found.good)];
        found
    }

    /// Readings that were good frames, of [`READINGS`].
    pub const fn good(&self) -> u8 {
        self.good
    }

    /// The numbers of the others' faults, and how many had each.
    pub fn faults(&self) -> impl Iterator<Item = (u8, u8)> {
        let counts = (FIRST..).zip(self.faults.iter().copied());
        counts.filter(|(_, count)| *count > 0)
    }

    /// Root mean square of the good readings of x and y about their mean, tenths of a code: up to
    /// 6.1 % more than it is, by micromath's root (docs/decisions.md).
    pub const fn noise_tenths(&self) -> [u16; 2] {
        self.noise_tenths
    }
}

/// Sums over the codes of a channel, as they differ from the first.
#[derive(Debug, Clone, Copy, Default)]
struct Spread {
    first: Option<i32>,
    sum: i32,
    squares: u32,
}

impl Spread {
    // Once in the program, as the next.
    #[inline(never)]
    fn add(&mut self, word: Word) {
        let code = word.signed14().into();
        let from_first = (code - *self.first.get_or_insert(code)).clamp(-FARTHEST, FARTHEST);
        self.sum += from_first;
        self.squares += (from_first * from_first) as u32;
    }

    /// Of so many codes, 16 at most.
    #[inline(never)]
    fn tenths(self, count: u8) -> u16 {
        let count = u32::from(count);
        // The variance times the square of the count.
        let spread = (count * self.squares).saturating_sub(self.sum.unsigned_abs().pow(2));
        let tenths = (10 * root(spread) + count / 2).checked_div(count);
        tenths.unwrap_or(0) as u16
    }
}

fn root(square: u32) -> u32 {
    F32(square as f32).sqrt().0 as u32
}

#[cfg(test)]
mod tests {
    use mlx90333::Word;

    use super::{FARTHEST, READINGS, Spread, root};

    /// Of any spread: as large as it is, or up to 6.07 % larger, and then rounded down.
    #[test]
    fn the_root_is_within_six_per_cent() {
        let mut largest = 0.0_f64;
        let most = u32::from(READINGS) * u32::from(READINGS - 1) * (FARTHEST * FARTHEST) as u32;
        let steps = std::iter::successors(Some(1_u32), |n| n.checked_add(n / 997 + 1));
        for spread in steps.take_while(|n| *n <= most) {
            let exact = f64::from(spread).sqrt();
            let error = f64::from(root(spread)) / exact - 1.0;
            assert!(error > -1.0 / exact && error < 0.0607, "{spread}: {error}");
            largest = largest.max(error);
        }
        assert!(largest > 0.06, "{largest}");
        assert_eq!(root(0), 0);
    }

    /// Within what the root and tenths are rounded by.
    #[test]
    fn noise_is_the_root_mean_square_about_the_mean() {
        let tenths = |codes: &[u16]| {
            let mut spread = Spread::default();
            let words = codes.iter().map(|code| Word::new(code << 2));
            words.for_each(|word| spread.add(word));
            spread.tenths(codes.len() as u8)
        };
        assert_eq!(tenths(&[]), 0);
        assert_eq!(tenths(&[8_192]), 0);
        assert_eq!(tenths(&[9_000; 16]), 0);
        for (codes, exact) in [
            ([8_190, 8_194].repeat(8), 2.0),
            ([8_191, 8_192, 8_193, 8_192].repeat(4), 0.5_f64.sqrt()),
            (vec![8_192, 8_192, 8_192, 8_196], 3.0_f64.sqrt()),
            ([8_000, 8_400].repeat(8), 200.0),
        ] {
            let found = f64::from(tenths(&codes)) / 10.0;
            let bounds = exact - 0.1..exact * 1.061 + 0.1;
            assert!(bounds.contains(&found), "{found}, is {exact}");
        }
        // Farther than is counted, and no sum overflows.
        assert_eq!(tenths(&[0, 16_383].repeat(8)) / 100, 204);
    }
}
