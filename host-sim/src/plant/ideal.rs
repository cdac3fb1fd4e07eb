//! Contact as BIOTACT simulates it: a spring without dynamics.

use super::{BadSetting, Head, Plant};

/// BIOTACT eq. 11: x = ⟨σ_x max(0, θ′ − θ′_lim)⟩ within ±1, y = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Ideal {
    head: Head,
    x: Vec<f64>,
}

impl Ideal {
    /// Whiskers that touch nothing until the first [`Plant::advance`].
    ///
    /// # Errors
    /// A stiffness out of range or an obstacle that is not a number.
    pub fn new(head: Head) -> Result<Self, BadSetting> {
        head.check()?;
        let x = head.limits().map(|_| 0.0).collect();
        Ok(Self { head, x })
    }
}

impl Plant for Ideal {
    fn deflection(&self, n: usize) -> [f64; 2] {
        [self.x.get(n).copied().unwrap_or(0.0), 0.0]
    }

    fn advance(&mut self, angles_deg: &[f64], dt_s: f64) {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return;
        }
        let limits = self.head.limits();
        for ((x, limit), angle) in self.x.iter_mut().zip(limits).zip(angles_deg) {
            if angle.is_finite() {
                *x = (self.head.stiffness * (angle - limit).max(0.0)).min(1.0);
            }
        }
    }

    fn restart(&mut self, _seed: u64) {
        self.x.fill(0.0);
    }
}
