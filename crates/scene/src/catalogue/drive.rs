//! Catalogue: what moves the whiskers (oscillators, gates, motor).

use super::{defaulted, required};
use crate::spec::{Key, Kind, Presence, Range, Section};
use crate::types::{Driver, Integrator, Numbers};

pub(super) static WHISKING: Section = Section {
    name: "whisking",
    presence: Presence::Optional {
        without: "the whiskers are passive: no oscillator, muscle, motor or position control",
        needs: None,
    },
    meaning: "Active whisking: oscillators, their coupling, and muscle (BIOTACT section III).",
    keys: &[
        required(
            "frequency_hz",
            Kind::Number(Range::closed(0.05, 25.0)),
            "Hz",
            "Whisk frequency f_W.",
        ),
        required(
            "integrator",
            Kind::Word(Integrator::NAMES),
            "",
            "`exact` keeps to the limit cycle; `euler` is the papers' forward Euler, step for step. \
             Below 18.7 ticks a whisk its muscles swing up, and the scene is refused.",
        ),
        required(
            "coupling",
            Kind::Bool,
            "",
            "Whether the sides' oscillators are coupled (eq. 4).",
        ),
        required(
            "noise",
            Kind::Number(Range::closed(0.0, 1.0)),
            "",
            "Standard deviation σ_η of the oscillator noise.",
        ),
        required(
            "gain",
            Kind::PerWhisker(Range::closed(0.0, 2.0)),
            "",
            "Nominal gain g_nominal of the muscle drive.",
        ),
        required(
            "start",
            Kind::PairPerSide(Range::closed(-1.5, 1.5)),
            "",
            "Oscillator state ψ = [ψ₁, ψ₂] of each side at the start.",
        ),
        defaulted(
            "numbers",
            Kind::Word(Numbers::NAMES),
            "",
            "\"auto\"",
            "Number format of the tick. `auto` in a simulation: `f64` for `euler`, whose point is \
             to be the papers', `f32` for `exact`; `auto` on a board: `f32` with an FPU, else \
             `fixed`. No board has `f64`, and only one with an FPU `f32`.",
        ),
    ],
};

const TAU: Kind = Kind::Number(Range::closed(1e-6, 1e5));
const CONTACT_GAIN: Kind = Kind::Number(Range::closed(0.0, 100.0));

pub(super) static RCP: Section = Section {
    name: "rcp",
    presence: Presence::Optional {
        without: "contact does not gate the drive (no rapid cessation of protraction)",
        needs: Some("whisking"),
    },
    meaning: "Rapid cessation of protraction: contact takes drive from its own side (BIOTACT eq. 10).",
    keys: &[
        required("gain", CONTACT_GAIN, "", "Gain σ_z on the contact signal."),
        required("tau_s", TAU, "s", "Time constant τ_z of the recovery."),
    ],
};

pub(super) static CIA: Section = Section {
    name: "cia",
    presence: Presence::Optional {
        without: "contact on one side leaves the other alone (no contact-induced asymmetry)",
        needs: Some("whisking"),
    },
    meaning: "Contact-induced asymmetry: contact lends drive to the other side (BIOTACT eqs 12 and 13).",
    keys: &[
        required(
            "gain",
            CONTACT_GAIN,
            "",
            "Gain σ_g on the other side's gate.",
        ),
        required("tau_s", TAU, "s", "Time constant τ_g of the recovery."),
    ],
};

const SETPOINT: Kind = Kind::Number(Range::closed(-360.0, 360.0));

const fn control(
    name: &'static str,
    high: f64,
    unit: &'static str,
    default: &'static str,
    meaning: &'static str,
) -> Key {
    defaulted(
        name,
        Kind::Number(Range::closed(0.0, high)),
        unit,
        default,
        meaning,
    )
}

pub(super) static MOTOR: Section = Section {
    name: "motor",
    presence: Presence::Optional {
        without: "where there is `[whisking]`, the defaults below hold",
        needs: Some("whisking"),
    },
    meaning: "Motor, gear, encoder and position control.",
    keys: &[
        defaulted(
            "driver",
            Kind::Word(Driver::NAMES),
            "",
            "\"h-bridge\"",
            "Power stage: one H-bridge (brushed motor) or six-step commutation (brushless motor).",
        ),
        control(
            "kp",
            10.0,
            "duty per degree",
            "0.05",
            "Proportional gain of the position control.",
        ),
        control(
            "kd",
            1.0,
            "duty per degree/s",
            "0.0004",
            "Derivative gain of the position control.",
        ),
        control(
            "duty_limit",
            1.0,
            "",
            "1.0",
            "Largest magnitude of the duty.",
        ),
        defaulted(
            "slew_per_s",
            Kind::Number(Range::positive(1e5)),
            "duty per second",
            "400.0",
            "Fastest change of the duty.",
        ),
        defaulted(
            "min_deg",
            SETPOINT,
            "degrees",
            "30.0",
            "Lower limit of the setpoint; below `max_deg`.",
        ),
        defaulted(
            "max_deg",
            SETPOINT,
            "degrees",
            "160.0",
            "Upper limit of the setpoint; above `min_deg`.",
        ),
        defaulted(
            "gear",
            Kind::Number(Range::closed(1.0, 1000.0)),
            "motor revolutions per whisker revolution",
            "11.0",
            "Gear ratio.",
        ),
        defaulted(
            "counts_per_rev",
            Kind::Integer {
                low: 4,
                high: 65_536,
            },
            "counts",
            "512",
            "Encoder counts per motor revolution.",
        ),
    ],
};
