//! Vectors of three components: points (m), directions and forces (N).

/// A vector.
pub type V3 = [f64; 3];

/// The scalar product a·b.
#[inline]
pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product a × b.
#[inline]
pub fn cross(a: V3, b: V3) -> V3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// a + s b.
#[inline]
pub fn add(a: V3, s: f64, b: V3) -> V3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// a − b.
#[inline]
pub fn sub(a: V3, b: V3) -> V3 {
    add(a, -1.0, b)
}

/// s a.
#[inline]
pub fn scale(s: f64, a: V3) -> V3 {
    a.map(|x| s * x)
}

/// |a|.
#[inline]
pub fn length(a: V3) -> f64 {
    dot(a, a).sqrt()
}

/// |a| of a pair. Unlike `hypot` it does not guard against overflow; it is faster
/// and the same on every machine.
#[inline]
pub fn length2([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// a/|a|, or `or` where |a| is below 1e-12 or not finite.
#[inline]
pub fn unit(a: V3, or: V3) -> V3 {
    direction(a).unwrap_or(or)
}

/// The part of a that is perpendicular to the unit vector `n`, as a unit vector;
/// any perpendicular one where there is none.
#[inline]
pub fn across(a: V3, n: V3) -> V3 {
    let part = add(a, -dot(a, n), n);
    direction(part).unwrap_or_else(|| {
        let other = if n[0].abs() < 0.6 {
            [1.0, 0.0, 0.0]
        } else {
            [0.0, 1.0, 0.0]
        };
        unit(cross(n, other), [0.0, 0.0, 1.0])
    })
}

/// a/|a|; none where |a| is below 1e-12 or not finite.
#[inline]
fn direction(a: V3) -> Option<V3> {
    let size = length(a);
    (size > 1e-12 && size.is_finite()).then(|| scale(1.0 / size, a))
}
