//! A division of 64 bits by 33, bit by bit: the compiler's takes a kilobyte of flash where a core
//! has none, and here there is time.

/// ⌊(2³² `upper` + `lower`) / `divisor`⌋, which fits where `upper` is less than the divisor.
pub(crate) fn divide(upper: u32, lower: u32, divisor: u64) -> u32 {
    let (mut rest, mut quotient) = (u64::from(upper), 0);
    for bit in (0..u32::BITS).rev() {
        rest = 2 * rest + u64::from((lower >> bit) & 1);
        quotient *= 2;
        if rest >= divisor {
            rest -= divisor;
            quotient += 1;
        }
    }
    quotient
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::divide;

    proptest! {
        #[test]
        fn it_is_a_division(divisor in 1..1_u64 << 33, share: u32, lower: u32) {
            let most = (divisor - 1).min(u32::MAX.into());
            let upper = ((u128::from(share) * u128::from(most + 1)) >> 32) as u32;
            let exact = ((u64::from(upper) << 32) | u64::from(lower)) / divisor;
            prop_assert_eq!(u64::from(divide(upper, lower, divisor)), exact);
        }
    }
}
