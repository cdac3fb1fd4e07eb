//! Both pads of the mobile robot: deflections, distances and the smoothed IMP.

use anyhow::Result;
use physics::{Plate, Pose, TouchingWhisker};

use super::{pad, whiskers};
use crate::classifiers::imp::Imp;
use crate::paper::psik::{ARCS, RATE_HZ, VIBRISSAE};
use crate::rigs::{Corridor, Robot, Vibrissa};

/// Inputs of the network: the vibrissae of both sides.
pub(crate) const INPUTS: usize = 2 * VIBRISSAE;
const BITS: usize = 8;
/// Window of the IMP's mean, samples (50 ms; chosen).
pub(crate) const WINDOW: u32 = 58;

struct Side {
    whiskers: Vec<(Vibrissa, TouchingWhisker)>,
    imp: Imp,
    /// Low-passed deflection, 0 to 1, and IMP of each vibrissa.
    bent: [f32; VIBRISSAE],
    power: [f32; VIBRISSAE],
}

pub(crate) struct Pads {
    sides: [Side; 2],
    /// Of the low-pass filters, a tick and a window.
    keep: f32,
    keep_window: f32,
}

pub(crate) struct Felt {
    /// D of the left and the right (PSIK eq. 1), mm.
    pub(crate) distance_mm: [f64; 2],
    /// x and y of one vibrissa of the left pad, codes.
    pub(crate) one: [f32; 2],
    /// The smoothed IMP of all vibrissae, where a window ends.
    pub(crate) window: Option<Vec<f32>>,
}

impl Pads {
    pub(crate) fn new(rig: &Corridor, seeds: [u64; 2]) -> Result<Self> {
        let side = |seed| {
            anyhow::Ok(Side {
                whiskers: whiskers::pad(&rig.layout, (rig.full_scale_rad, rig.follicle), seed)?,
                imp: Imp::new(WINDOW),
                bent: [0.0; VIBRISSAE],
                power: [0.0; VIBRISSAE],
            })
        };
        let [left, right] = seeds;
        let dt_s = 1.0 / RATE_HZ;
        Ok(Self {
            sides: [side(left)?, side(right)?],
            keep: libm::exp(-dt_s / rig.smooth_s) as f32,
            keep_window: libm::exp(-f64::from(WINDOW) * dt_s / rig.smooth_s) as f32,
        })
    }

    /// A tick: `wall` says what a vibrissa of a side (0: left) may touch, by its pose.
    pub(crate) fn step(
        &mut self,
        robot: &Robot,
        wall: impl Fn(usize, &Pose) -> Option<Plate>,
    ) -> Felt {
        let mut felt = Felt {
            distance_mm: [0.0; 2],
            one: [0.0; 2],
            window: None,
        };
        let (keep, keep_window) = (self.keep, self.keep_window);
        for (number, side) in self.sides.iter_mut().enumerate() {
            let mut codes = [[0; 2]; VIBRISSAE];
            let all = side.whiskers.iter_mut().zip(&mut codes).zip(&mut side.bent);
            for (((vibrissa, whisker), code), bent) in all {
                let pose = Corridor::pose(robot, number, vibrissa);
                let plate = wall(number, &pose);
                whisker.step(&pose, plate.as_ref(), 1.0 / RATE_HZ);
                *code = pad::codes(whisker.reading(), BITS);
                let [x, y] = code.map(f32::from);
                // A deflection of both axes at their ends counts as 1.
                let deflection = (x.hypot(y) / 127.0).min(1.0);
                *bent = keep * *bent + (1.0 - keep) * deflection;
            }
            if number == 0 {
                felt.one = pad::widened(codes[pad::ONE], BITS);
            }
            felt.distance_mm[number] = distance_mm(&side.bent);
            if let Some(window) = side.imp.push(&codes) {
                for (power, imp) in side.power.iter_mut().zip(window) {
                    let imp = imp as f32 / 65_536.0;
                    *power = keep_window * *power + (1.0 - keep_window) * imp;
                }
                felt.window.get_or_insert_default().extend(side.power);
            }
        }
        felt
    }
}

/// The distance of what a pad touches, D = (1/N) Σ_i (1 − V_i) L_i (PSIK eq. 1),
/// mm: V_i is the mean of an arc over `bent`, the deflection of each vibrissa,
/// arc by arc, 0 to 1.
fn distance_mm(bent: &[f32; VIBRISSAE]) -> f64 {
    let mut rest = bent.as_slice();
    let arcs = ARCS.map(|(size, length_mm)| {
        // The sizes add up to the vibrissae.
        let (arc, after) = rest.split_at_checked(size).unwrap_or((rest, &[]));
        rest = after;
        (1.0 - arc.iter().sum::<f32>() / size as f32) * length_mm as f32
    });
    f64::from(arcs.iter().sum::<f32>() / ARCS.len() as f32)
}

#[cfg(test)]
mod tests {
    use super::{VIBRISSAE, distance_mm};

    #[test]
    fn distance_is_the_paper_s_and_arcs_take_their_vibrissae_and_no_others() {
        assert_eq!(distance_mm(&[0.0; VIBRISSAE]), 1035.0 / 8.0);
        assert_eq!(distance_mm(&[1.0; VIBRISSAE]), 0.0);
        let mut bent = [0.0; VIBRISSAE];
        // The last of arc 5 (100 mm), two of arc 6 (90 mm), one of arc 8 (55 mm).
        (bent[24], bent[25], bent[27], bent[32]) = (1.0, 0.25, 0.5, 1.0);
        let expected = (1035.0 - 100.0 / 5.0 - 90.0 * 0.75 / 3.0 - 55.0 / 2.0) / 8.0;
        assert!((distance_mm(&bent) - expected).abs() < 1e-4);
    }
}
