//! The same bits on every machine: fingerprints of the elementary functions and
//! of the noise.
//!
//! Errors are measured beside each function; they cannot tell one last bit of
//! a table from another. A fingerprint can. Whoever changes a table, a
//! coefficient or the order of operations on purpose puts the new one here.

use crate::settings::plain;
use whisking::muscle::drive;
use whisking::{Elementary, Fix, Integrator, Settings, noise};

/// Fowler, Noll and Vo's hash (FNV-1a, 64 bits).
pub(crate) struct Fingerprint(u64);

impl Fingerprint {
    pub(crate) const fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    fn add_bytes(&mut self, bytes: impl IntoIterator<Item = u8>) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }

    /// Adds a number's bits.
    pub(crate) fn add(&mut self, number: f64) {
        self.add_bytes(number.to_bits().to_le_bytes());
    }

    pub(crate) const fn value(&self) -> u64 {
        self.0
    }
}

/// The fingerprint of 32-bit words.
fn fingerprint(words: impl Iterator<Item = u32>) -> u64 {
    let mut print = Fingerprint::new();
    print.add_bytes(words.flat_map(u32::to_le_bytes));
    print.value()
}

#[track_caller]
fn same(found: u64, expected: u64) {
    assert!(found == expected, "fingerprint {found:#x}");
}

/// Every 1/2^17 from −1.5 to 1.5, in Q28.
fn grid() -> impl Iterator<Item = i32> {
    (-(3 << 16)..=(3 << 16)).map(|n| n << 11)
}

/// Every 1/2^21 from −1/16 to 1/16, in Q28.
fn near() -> impl Iterator<Item = i32> {
    (-(1 << 17)..=(1 << 17)).map(|n| n << 7)
}

fn single(x: i32) -> f32 {
    x as f32 / 268_435_456.0
}

#[test]
fn elementary_functions_in_fixed_point() {
    let drives = fingerprint(grid().map(|x| drive(Fix(x)).0 as u32));
    same(drives, 0xEEC1_BF99_05F9_C3A4);
    let exp = fingerprint(grid().map(|x| Fix(x).exp_neg_square().0 as u32));
    same(exp, 0x21A2_A510_C408_EEA5);
    let excess = fingerprint(near().map(|x| Fix(x).one_minus_inv_sqrt().0 as u32));
    same(excess, 0x76F8_3F96_3A9A_2ACB);
    // All directions, at radii over several powers of two.
    let unit =
        grid().filter_map(|x| Fix::unit(Fix(x), Fix((x >> 3).wrapping_mul(5) ^ 0x0123_4567)));
    let unit = fingerprint(unit.flatten().map(|x| x.0 as u32));
    same(unit, 0x92C8_9D82_EE16_24D3);
}

#[test]
fn elementary_functions_in_single_precision() {
    let drives = fingerprint(grid().map(|x| drive(single(x)).to_bits()));
    same(drives, 0x2662_B01A_C848_7B62);
    let exp = fingerprint(grid().map(|x| single(x).exp_neg_square().to_bits()));
    same(exp, 0x83CE_425D_B4D4_9790);
    let excess = fingerprint(near().map(|x| single(x).one_minus_inv_sqrt().to_bits()));
    same(excess, 0x04BD_F5A9_3A58_197D);
    let unit = grid().filter_map(|x| f32::unit(single(x), single(x >> 3) * 5.0 + 0.3));
    let unit = fingerprint(unit.flatten().map(f32::to_bits));
    same(unit, 0x0C76_7EE8_8320_D6C8);
}

#[test]
fn noise_of_a_seed() {
    let settings = Settings {
        coupling: true,
        noise: 0.005,
        ..plain(Integrator::Exact, 2_000.0, 8.0)
    };
    let config: noise::Config<f64> = settings.build().unwrap().noise.unwrap();
    let mut state = noise::State::<f64>::new(2, 1);
    let numbers = (0..200_000).flat_map(|_| config.step(&mut state)).flatten();
    let bits = numbers.map(f64::to_bits);
    let noise = fingerprint(bits.flat_map(|bits| [bits as u32, (bits >> 32) as u32]));
    same(noise, 0x7524_2B41_3AC7_657E);
}
