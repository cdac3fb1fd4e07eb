//! The two integrators by name.

use serde::{Deserialize, Serialize};

/// How oscillators, muscles and gates are stepped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integrator {
    /// The papers' forward Euler, step for step.
    Euler,
    /// Structure preserving: exact linear parts, exact decays, fourth-order muscle.
    Exact,
}
