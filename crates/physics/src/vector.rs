//! Arithmetic on triples: points (m), directions and forces (N).

/// Three components.
pub(super) type V3 = [f64; 3];

/// a·b.
#[inline]
pub(super) fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
#[inline]
pub(super) fn cross(a: V3, b: V3) -> V3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// a + s b.
#[inline]
pub(super) fn add(a: V3, s: f64, b: V3) -> V3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// a − b.
#[inline]
pub(super) fn sub(a: V3, b: V3) -> V3 {
    add(a, -1.0, b)
}

/// s a.
#[inline]
pub(super) fn scale(s: f64, a: V3) -> V3 {
    a.map(|x| s * x)
}

/// |a|.
#[inline]
pub(super) fn length(a: V3) -> f64 {
    dot(a, a).sqrt()
}

/// |a| of a pair: faster than a function that minds overflow, and the same on
/// every machine.
#[inline]
pub(super) fn length2([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// a/|a|, and `or` where a is zero or not finite.
pub(super) fn unit(a: V3, or: V3) -> V3 {
    let size = length(a);
    if size > 1e-12 && size.is_finite() {
        scale(1.0 / size, a)
    } else {
        or
    }
}

/// The part of a that is perpendicular to the unit vector `n`, as a unit vector;
/// any perpendicular one where there is none.
pub(super) fn across(a: V3, n: V3) -> V3 {
    let other = if n[0].abs() < 0.6 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let any = unit(cross(n, other), [0.0, 0.0, 1.0]);
    unit(add(a, -dot(a, n), n), any)
}
