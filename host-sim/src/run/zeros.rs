//! What simulated sensors read at rest.

use scene::Scene;

/// A code of 14 bits as a deflection.
const CODE: f64 = 1.0 / 8191.0;

/// By side: deflections at the start, and by how much they change in a second.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Zeros {
    start: [[f64; 2]; 2],
    drift: [[f64; 2]; 2],
}

impl Zeros {
    /// Those of a scene.
    pub(super) fn new(scene: &Scene) -> Self {
        let of = |codes: &Option<Vec<[f64; 2]>>| {
            let pair = |side| codes.as_deref().and_then(|sides| sides.get(side).copied());
            [0, 1].map(|side: usize| pair(side).unwrap_or_default().map(|codes| codes * CODE))
        };
        Self {
            start: of(&scene.plant.zero_codes),
            drift: of(&scene.plant.zero_drift),
        }
    }

    /// A deflection of a whisker on `side` as its sensor has it, `t_s` after the start. In the
    /// first tick it is itself: no frame has come by then, and a module takes its sensors to be
    /// at mid-scale.
    pub(super) fn added(&self, side: usize, t_s: f64, deflection: [f64; 2]) -> [f64; 2] {
        let (Some(start), Some(drift)) = (self.start.get(side), self.drift.get(side)) else {
            return deflection;
        };
        if t_s <= 0.0 {
            return deflection;
        }
        [0, 1].map(|axis: usize| deflection[axis] + (start[axis] + t_s * drift[axis]))
    }
}
