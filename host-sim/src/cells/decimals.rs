//! Numbers with a fixed count of decimals, as `format!("{value:.9}")` writes
//! them, in a fifth of the time: most of a simulation's time went there.
//!
//! value · 10ⁿ = m 5ⁿ · 2^(e + n) for a value m · 2^e: an integer of 74 bits at
//! the most, shifted and rounded to even. So the digits are exact.

use std::io::Write as _;

/// 5⁹ has 21 bits, which with a mantissa of 53 leaves room in 128.
const MOST_DECIMALS: u32 = 9;

/// Sizes from here on are left to the standard library: below, value · 10⁹ fits in 64 bits.
const LIMIT: f64 = (1_u64 << 33) as f64;

/// Appends `value` with `decimals` decimals, rounded to the nearest, ties to even.
pub(super) fn append(line: &mut Vec<u8>, value: f64, decimals: u32) {
    // False for what is not a number.
    let fits = value.abs() < LIMIT && decimals <= MOST_DECIMALS;
    if !fits {
        // Writing to memory does not fail.
        let _ = write!(line, "{value:.*}", decimals as usize);
        return;
    }
    if value.is_sign_negative() {
        line.push(b'-');
    }
    let scale = 10_u64.pow(decimals);
    let scaled = scaled(value, decimals);
    let mut digits = itoa::Buffer::new();
    line.extend_from_slice(digits.format(scaled / scale).as_bytes());
    if decimals > 0 {
        line.push(b'.');
        // The one in front keeps the zeros, and is left out.
        let decimals = digits.format(scale + scaled % scale).as_bytes();
        line.extend_from_slice(decimals.get(1..).unwrap_or_default());
    }
}

/// |value| · 10^decimals, rounded to an integer.
fn scaled(value: f64, decimals: u32) -> u64 {
    let bits = value.to_bits();
    let exponent = (bits >> 52 & 0x7FF) as i32;
    let fraction = bits & ((1 << 52) - 1);
    // Numbers below the normal ones have no hidden bit.
    let (mantissa, exponent) = match exponent {
        0 => (fraction, -1074),
        _ => (fraction | 1 << 52, exponent - 1075),
    };
    let product = u128::from(mantissa) * u128::from(5_u64.pow(decimals));
    let shift = exponent + decimals as i32;
    if shift >= 0 {
        return (product << shift) as u64;
    }
    let shift = shift.unsigned_abs();
    if shift > 127 {
        return 0;
    }
    let (whole, rest) = ((product >> shift) as u64, product & ((1 << shift) - 1));
    let half = 1 << (shift - 1);
    let up = rest > half || (rest == half && whole & 1 == 1);
    whole + u64::from(up)
}

#[cfg(test)]
mod tests {
    use super::append;
    use proptest::prelude::*;

    #[track_caller]
    fn same(value: f64) {
        for decimals in [0, 1, 3, 9] {
            let mut line = Vec::new();
            append(&mut line, value, decimals);
            let found = String::from_utf8(line).unwrap();
            assert_eq!(found, format!("{value:.*}", decimals as usize));
        }
    }

    #[test]
    fn ties_zeros_limits_and_what_is_no_number_are_as_the_standard_library_has_them() {
        let limit = (1_u64 << 33) as f64;
        let short = [
            0.0, 0.5, 1.5, 2.5, 0.25, 0.35, 0.125, 0.0625, 1e-9, 5e-10, 4.9e-10, 1.5e-9, 1e-300,
            5e-324, 99.5, 100.0, 16383.0, 8191.5, 1e300,
        ];
        let long = [0.999_999_999_5, 9.999_999_999_9, f64::MIN_POSITIVE];
        let ends = [limit, limit - 0.5, limit + 0.5, f64::INFINITY, f64::NAN];
        for &value in short.iter().chain(&long).chain(&ends) {
            same(value);
            same(-value);
        }
        // Exact ties at nine decimals: odd multiples of 2⁻¹⁰ have ten.
        for n in 0..5000 {
            same(f64::from(n) / 1024.0);
            same(f64::from(n) / 16.0);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 20_000, ..ProptestConfig::default() })]

        #[test]
        fn any_number_is_as_the_standard_library_has_it(bits: u64, value in -1e4_f64..1e4) {
            for value in [f64::from_bits(bits), value, 2e-4 * value, value.round()] {
                same(value);
            }
        }
    }
}
