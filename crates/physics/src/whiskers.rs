//! The whiskers of the papers.
//!
//! Lengths, taper and frequencies are the papers'; moduli and follicles are
//! fitted to the frequencies, damping is a choice. A known misfit: with one
//! modulus, one follicle and hubs of 2 mm, the three whiskers of BIOTACT come out
//! at 87.0, 45.2 and 23.0 Hz for 86, 50 and 21 measured. No modulus and no
//! follicle does better than ±8 %: shafts that differ in length alone have
//! frequencies that fall as 1/L² when clamped and more slowly on a spring, but
//! the measured f L² is 0.55, 0.63 and 0.52 Hz m². The printed shafts differ in
//! thickness, then, and the hubs here do, by up to 14 %.

use core::f64::consts::PI;

use crate::shaft::{Follicle, Shaft};

/// Young's modulus of acrylonitrile butadiene styrene, Pa, and its density,
/// kg/m³: middle of the usual ranges, 2.0 to 2.6 GPa and 1030 to 1070.
const ABS: [f64; 2] = [2.3e9, 1050.0];

/// Alumina-filled photopolymer as printed: a density of its kind (a choice) and
/// the modulus that then fits the frequencies of BIOTACT on the whole.
const PRINTED: [f64; 2] = [1.394e9, 1200.0];

/// Stiffness along the shaft, N/m: rubber of 1 MPa, sheared in a ring 10 mm deep
/// between diameters of 2 and 6 mm (2 π G h/ln 3), with G a third of the modulus.
const AXIAL_N_M: f64 = 2e4;

/// Whiskers of the BIOTACT sensor, from the front.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Biotact {
    /// 80 mm, 86 Hz.
    Front,
    /// 112 mm, 50 Hz.
    Middle,
    /// 158 mm, 21 Hz.
    Rear,
}

impl Biotact {
    /// From front to rear.
    pub const ALL: [Self; 3] = [Self::Front, Self::Middle, Self::Rear];

    /// Length (BIOTACT section II-C), and the hub with which the frequency is the measured one, m.
    const fn length_and_hub_m(self) -> [f64; 2] {
        match self {
            Self::Front => [0.080, 1.971e-3],
            Self::Middle => [0.112, 2.282e-3],
            Self::Rear => [0.158, 1.808e-3],
        }
    }
}

impl Shaft {
    /// A whisker of the BIOTACT sensor: taper ratio 8 to a tip near 0.25 mm
    /// (section II-C), hub fitted to the measured frequency.
    pub const fn biotact(whisker: Biotact) -> Self {
        let [length_m, hub_m] = whisker.length_and_hub_m();
        Self::printed(length_m, hub_m)
    }

    /// The whisker of the floor robot: ABS, 200 mm long, 2 mm thick (LEP10,
    /// section II-A), in a tube filled with polyurethane. It rings at 6.9 Hz in
    /// the air and at 35 Hz with its tip on the floor: the follicle's stiffness
    /// is such that the latter is in the middle of the measured 30 to 40 Hz
    /// (LEP12 section 5.1 and Fig. 9). A clamped one would have 44 Hz, a freely
    /// hinged one 28 Hz.
    pub const fn floor_robot() -> Self {
        Self {
            length_m: 0.2,
            hub_diameter_m: 2e-3,
            tip_diameter_m: 2e-3,
            youngs_pa: ABS[0],
            density_kg_m3: ABS[1],
            damping: 0.08,
            follicle: Follicle {
                rotation_n_m_rad: 0.03,
                axial_n_m: AXIAL_N_M,
            },
        }
    }

    /// The whisker of the XY table: tapered plastic in a rubber-filled follicle,
    /// about five times a rat's (POSE section II-A). A choice: that of the floor
    /// robot, but with a taper ratio of 4.
    pub const fn xy_table() -> Self {
        Self {
            tip_diameter_m: 0.5e-3,
            ..Self::floor_robot()
        }
    }

    /// A vibrissa of Psikharpax of an arc from 1 to 8 (PSIK table 1); other
    /// numbers count as the nearest.
    ///
    /// Choices: a hub of a hundredth of the length, as a rat's; taper ratio 8;
    /// the modulus of the printed whiskers; held by an elastomer skin, four
    /// times as stiff as the shaft, k L = 4 E I. So frequencies go as 1/L, from
    /// 10 Hz to 45 Hz.
    pub fn psikharpax(arc: usize) -> Self {
        const LENGTHS_MM: [f64; 8] = [250.0, 200.0, 150.0, 120.0, 100.0, 90.0, 70.0, 55.0];
        let at = arc.clamp(1, LENGTHS_MM.len()) - 1;
        let length_m = 1e-3 * LENGTHS_MM.get(at).copied().unwrap_or(55.0);
        let hub_m = length_m / 100.0;
        let mut shaft = Self::printed(length_m, hub_m);
        let rigidity = shaft.youngs_pa * PI * hub_m.powi(4) / 64.0;
        shaft.follicle.rotation_n_m_rad = 4.0 * rigidity / length_m;
        shaft
    }

    /// A printed whisker of taper ratio 8. The follicle turns the base by a
    /// quarter of what the front whisker bends.
    const fn printed(length_m: f64, hub_diameter_m: f64) -> Self {
        Self {
            length_m,
            hub_diameter_m,
            tip_diameter_m: hub_diameter_m / 8.0,
            youngs_pa: PRINTED[0],
            density_kg_m3: PRINTED[1],
            damping: 0.05,
            follicle: Follicle {
                rotation_n_m_rad: 0.2,
                axial_n_m: AXIAL_N_M,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::{Biotact, Shaft};
    use crate::Modes;

    fn first_hz(shaft: &Shaft) -> f64 {
        shaft.modes(1).unwrap().modes[0].omega_rad_s / TAU
    }

    /// Lowest frequency with the tip held: the first zero of the response of
    /// the tip, between the first two modes.
    fn pinned_hz(modes: &Modes) -> f64 {
        let response = |omega: f64| {
            let all = modes.modes.iter();
            let terms = all.map(|m| m.tip * m.tip / (m.omega_rad_s.powi(2) - omega * omega));
            modes.residual_tip_m_n + terms.sum::<f64>()
        };
        let (mut low, mut high) = (modes.modes[0].omega_rad_s, modes.modes[1].omega_rad_s);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            let is_below = response(middle) < 0.0;
            *(if is_below { &mut low } else { &mut high }) = middle;
        }
        low / TAU
    }

    /// With a hub of 2 mm they miss them as documented.
    #[test]
    fn whiskers_of_biotact_have_their_frequencies() {
        for (whisker, measured_hz, nominal_hz) in [
            (Biotact::Front, 86.0, 87.0),
            (Biotact::Middle, 50.0, 45.2),
            (Biotact::Rear, 21.0, 23.0),
        ] {
            let shaft = Shaft::biotact(whisker);
            assert_eq!(shaft.hub_diameter_m / shaft.tip_diameter_m, 8.0);
            let found = first_hz(&shaft) / measured_hz;
            assert!((found - 1.0).abs() < 0.005, "{whisker:?} {found}");
            let found = first_hz(&Shaft::printed(shaft.length_m, 2e-3));
            assert!((found - nominal_hz).abs() < 0.06, "{whisker:?} {found}");
        }
    }

    #[test]
    fn the_whisker_of_the_floor_robot_rings_on_the_floor_as_measured() {
        let modes = Shaft::floor_robot().modes(8).unwrap();
        let hz = pinned_hz(&modes);
        assert!((34.0..36.0).contains(&hz), "{hz}");
        assert!((first_hz(&Shaft::floor_robot()) - 6.94).abs() < 0.02);
        // Clamped and pinned: β = 3.9266; hinged and pinned: β = π.
        let mut shaft = Shaft::floor_robot();
        let unit = (2.3e9_f64 / 1050.0).sqrt() * 0.5e-3 / 0.04 / TAU;
        for (k, beta) in [(1e6, 3.926_602_3), (1e-6, core::f64::consts::PI)] {
            shaft.follicle.rotation_n_m_rad = k;
            let found = pinned_hz(&shaft.modes(12).unwrap());
            assert!((found / (unit * beta * beta) - 1.0).abs() < 1e-3, "{found}");
        }
    }

    #[test]
    fn vibrissae_of_psikharpax_ring_higher_the_shorter_they_are() {
        let hz = [1, 2, 3, 4, 5, 6, 7, 8].map(|arc| first_hz(&Shaft::psikharpax(arc)));
        assert!(hz.is_sorted() && hz[0] > 9.0 && hz[7] < 50.0, "{hz:?}");
        assert_eq!(Shaft::psikharpax(0), Shaft::psikharpax(1));
        assert_eq!(Shaft::psikharpax(99), Shaft::psikharpax(8));
        assert_eq!(Shaft::xy_table().check(), Ok(()));
    }
}
