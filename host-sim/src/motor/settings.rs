//! What a motor is, in physical units.

use physics::BadSetting;

/// Motor, gear, whisker inertia and encoder.
///
/// The defaults describe a class, that of flat 13 mm brushless micro motors such as the Faulhaber
/// 1307 of BIOTACT (section II-C); they are rounded choices, not data-sheet figures. They give a
/// stall torque of 0.6 mN·m, a no-load speed of 22,000 turns a minute at the rotor and 11,900 °/s
/// at the whisker, and a mechanical time constant of 48 ms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorSettings {
    /// Supply voltage U, 0 to 100 V.
    pub supply_v: f64,
    /// Winding resistance R between two terminals, 1e-3 to 1e6 Ω.
    pub resistance_ohm: f64,
    /// Torque constant k, N·m/A, also the back-EMF constant in V·s/rad; 1e-6 to
    /// 10. Between two phases at its peak for a brushless motor.
    pub torque_nm_per_a: f64,
    /// Inertia of the rotor, 1e-12 to 1 kg·m².
    pub rotor_kg_m2: f64,
    /// Inertia of whisker and hub about the whisker's axis, 0 to 1 kg·m².
    pub whisker_kg_m2: f64,
    /// Viscous friction b at the rotor, 0 to 1 N·m·s.
    pub viscous_nm_s: f64,
    /// Coulomb friction τ_c of rotor and gear, at the rotor, 0 to 10 N·m.
    pub coulomb_nm: f64,
    /// Motor turns a whisker turn G, 1 to 1000.
    pub gear: f64,
    /// Encoder counts a motor turn, 4 to 65,536.
    pub counts_per_rev: u32,
    /// Whisker angle θ′ at which the motor starts and the encoder reads 0, ±360 degrees.
    pub rest_deg: f64,
    /// Whisker angles θ′ of the end stops, degrees; infinite where there are none. Rest lies
    /// between them.
    pub stops_deg: [f64; 2],
    /// Counts of a period of the PWM, which are the steps of the duty; 1 to 65,535.
    pub pwm_counts: u16,
}

/// Steps of the duty where no board says how many: a timer of 160 MHz at 20 kHz.
pub(crate) const PWM_COUNTS: u16 = 8000;

impl MotorSettings {
    /// The class described above.
    pub const DEFAULT: Self = Self {
        supply_v: 6.0,
        resistance_ohm: 25.0,
        torque_nm_per_a: 2.5e-3,
        rotor_kg_m2: 1e-8,
        // Chosen. A frustum of 112 mm, 2 mm to 0.25 mm thick (BIOTACT section II-C), at 1300 kg/m³
        // has 2.8e-7 about its base, and a gram of hub and magnet at 5 mm 0.3e-7.
        whisker_kg_m2: 2.5e-7,
        viscous_nm_s: 1e-9,
        // A twentieth of the stall torque.
        coulomb_nm: 3e-5,
        gear: 11.0,
        counts_per_rev: 512,
        rest_deg: whisking::REST_DEG,
        stops_deg: [f64::NEG_INFINITY, f64::INFINITY],
        pwm_counts: PWM_COUNTS,
    };

    /// Inertia seen by the rotor: J = J_rotor + J_whisker/G².
    pub(super) fn inertia_kg_m2(&self) -> f64 {
        self.rotor_kg_m2 + self.whisker_kg_m2 / (self.gear * self.gear)
    }

    /// The rotor's angle where the whisker's θ′ is `angle_deg`, rad; 0 at rest.
    pub(super) fn rotor_angle(&self, angle_deg: f64) -> f64 {
        (angle_deg - self.rest_deg).to_radians() * self.gear
    }

    /// Degrees of the whisker a count of the encoder.
    pub const fn degrees_per_count(&self) -> f64 {
        360.0 / (self.gear * self.counts_per_rev as f64)
    }

    pub(super) fn check(&self) -> Result<(), BadSetting> {
        let check = BadSetting::check;
        check("supply_v", self.supply_v, 0.0, 100.0)?;
        check("resistance_ohm", self.resistance_ohm, 1e-3, 1e6)?;
        check("torque_nm_per_a", self.torque_nm_per_a, 1e-6, 10.0)?;
        check("rotor_kg_m2", self.rotor_kg_m2, 1e-12, 1.0)?;
        check("whisker_kg_m2", self.whisker_kg_m2, 0.0, 1.0)?;
        check("viscous_nm_s", self.viscous_nm_s, 0.0, 1.0)?;
        check("coulomb_nm", self.coulomb_nm, 0.0, 10.0)?;
        check("gear", self.gear, 1.0, 1000.0)?;
        check("counts_per_rev", self.counts_per_rev.into(), 4.0, 65_536.0)?;
        check("rest_deg", self.rest_deg, -360.0, 360.0)?;
        let [lowest, highest] = self.stops_deg;
        check("stops_deg", self.rest_deg, lowest, highest)?;
        check("pwm_counts", self.pwm_counts.into(), 1.0, 65_535.0).map(drop)
    }
}
