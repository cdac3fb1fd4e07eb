//! Matrix exponentials of small matrices in f64, for building configurations.

/// An N × N matrix, rows first.
pub(crate) type Matrix<const N: usize> = [[f64; N]; N];

pub(crate) fn identity<const N: usize>() -> Matrix<N> {
    core::array::from_fn(|i| core::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }))
}

pub(crate) fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..N).map(|k| a[i][k] * b[k][j]).sum()))
}

pub(crate) fn scaled<const N: usize>(a: &Matrix<N>, factor: f64) -> Matrix<N> {
    a.map(|row| row.map(|x| x * factor))
}

/// exp(A) by scaling and squaring of a Taylor sum; relative error near 1e-15
/// for the well-scaled matrices used here. The norm must be below 2^60.
pub(crate) fn exponential<const N: usize>(a: &Matrix<N>) -> Matrix<N> {
    let norm = a
        .iter()
        .map(|row| row.iter().map(|x| x.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let mut halvings = 0;
    let mut scale = 1.0;
    while norm * scale > 0.5 && halvings < 60 {
        scale *= 0.5;
        halvings += 1;
    }
    let small = scaled(a, scale);
    let mut sum = identity();
    let mut term = identity();
    for k in 1..=16 {
        term = scaled(&product(&term, &small), 1.0 / f64::from(k));
        for (s, t) in sum.iter_mut().flatten().zip(term.iter().flatten()) {
            *s += t;
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::exponential;

    #[test]
    fn a_rotation_generator_gives_a_rotation() {
        for angle in [1e-6, 0.3, 2.0, 40.0] {
            let e = exponential(&[[0.0, -angle], [angle, 0.0]]);
            let (s, c) = (libm::sin(angle), libm::cos(angle));
            for (x, y) in [(e[0][0], c), (e[0][1], -s), (e[1][0], s), (e[1][1], c)] {
                assert!((x - y).abs() < 1e-13, "{angle}: {x} {y}");
            }
        }
    }

    #[test]
    fn a_stiff_diagonal_decays() {
        let e = exponential(&[[-50.0, 0.0], [0.0, -0.5]]);
        assert!((e[0][0] / libm::exp(-50.0) - 1.0).abs() < 1e-12);
        assert!((e[1][1] - libm::exp(-0.5)).abs() < 1e-15);
    }
}
