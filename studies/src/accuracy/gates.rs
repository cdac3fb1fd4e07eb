//! The gates: how exactly z decays, and of which order a step is while a gate
//! jumps.

use anyhow::{Context, Result};
use whisking::gate::Gate;
use whisking::{GateSettings, Integrator, Number, Settings, State};

use super::reference::{Case, GRID, PEAK_GAIN, Truth};
use super::schemes::{Format, INTEGRATORS, Pace, in_format, name};
use crate::page::{Page, short};

const FREQUENCY_HZ: f64 = 2.0;
/// Tick rates of the order, each twice the one before, Hz.
const TICKS_HZ: [f64; 6] = [250.0, 500.0, 1_000.0, 2_000.0, 4_000.0, 8_000.0];
/// σ_z, and τ_z in seconds: a quarter of a whisk (BIOTACT Fig. 7).
const RCP: GateSettings = GateSettings {
    gain: 0.7,
    tau_s: 0.25 / FREQUENCY_HZ,
};
/// π while there is contact.
const CONTACT: f64 = 0.8;
/// When contact begins and, where it does, ends; whisks. In between the side
/// protracts, and both times lie on every tick.
const BEGIN: f64 = 1.8;
const END: f64 = 2.2;
const WHISKS: usize = 4;
/// Both sides on their circle and in phase, so that all error is the muscles'.
const CASE: Case = Case {
    psi: [[1.0, 0.0]; 2],
    gain: 1.0,
};

/// The pace at a tick rate, and settings with RCP.
fn modulated(integrator: Integrator, tick_hz: f64) -> (Pace, Settings) {
    let pace = Pace::new(FREQUENCY_HZ, tick_hz);
    let settings = Settings {
        rcp: Some(RCP),
        ..pace.settings(integrator)
    };
    (pace, settings)
}

/// A step of contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Contact {
    /// Contact stays: z jumps and is constant afterwards.
    Held,
    /// Contact ends: z jumps, then decays.
    Released,
}

impl Contact {
    const ALL: [Self; 2] = [Self::Held, Self::Released];

    const fn name(self) -> &'static str {
        match self {
            Self::Held => "contact begins and stays",
            Self::Released => "contact begins and ends",
        }
    }

    /// π in the tick that begins at `whisks`.
    fn signal(self, whisks: f64) -> f64 {
        // Half a grid step of grace: a tick that begins at the edge is behind it.
        let now = whisks + 0.5 / GRID as f64;
        let touching = now >= BEGIN && (self == Self::Held || now < END);
        if touching { CONTACT } else { 0.0 }
    }

    /// z of continuous time, at `whisks` in a step that begins at `from`.
    fn z(self, from: f64, whisks: f64) -> f64 {
        let peak = RCP.gain * CONTACT;
        let now = from + 0.5 / GRID as f64;
        if now < BEGIN {
            0.0
        } else if self == Self::Held || now < END {
            peak
        } else {
            peak * libm::exp(-(whisks - END) / (RCP.tau_s * FREQUENCY_HZ))
        }
    }

    fn truth(self) -> Truth {
        let h = 1.0 / GRID as f64;
        Truth::gated(&CASE, WHISKS, |n| {
            let from = n as f64 * h;
            [0.0, 0.5, 1.0].map(|part| PEAK_GAIN * (1.0 - self.z(from, from + part * h)))
        })
    }

    /// Largest error of θ' in degrees.
    fn error<R: Number>(self, integrator: Integrator, tick_hz: f64, truth: &Truth) -> Result<f64> {
        let (pace, settings) = modulated(integrator, tick_hz);
        let config = settings.build::<R>()?;
        let start = settings.start(&CASE.psi, &[&[CASE.gain][..]; 2])?;
        let mut state = State::new(&start, 1);
        let stride = pace.stride()?;
        let mut worst = 0.0_f64;
        for n in 0..WHISKS * GRID / stride {
            let whisks = (n * stride) as f64 / GRID as f64;
            config.step(&mut state, &[R::from_f64(self.signal(whisks)); 2]);
            let expected = truth.theta((n + 1) * stride).unwrap_or([f64::NAN; 2]);
            for (found, expected) in state.theta().zip(expected) {
                worst = worst.max(100.0 * (found.to_f64() - expected).abs());
            }
        }
        Ok(worst)
    }
}

/// Relative error of z after four time constants of free decay from one at
/// 2 kHz.
fn decay(integrator: Integrator, format: Format) -> Result<f64> {
    fn of<R: Number>(integrator: Integrator) -> Result<f64> {
        let (pace, settings) = modulated(integrator, 2_000.0);
        let rcp = settings.build::<R>()?.rcp;
        let rcp = rcp.context("RCP is missing")?;
        let mut z = Gate::new(R::ONE);
        for _ in 0..(4.0 * RCP.tau_s * pace.tick_hz) as usize {
            rcp.step(&mut z, R::ZERO);
        }
        Ok((z.value.to_f64() / libm::exp(-4.0) - 1.0).abs())
    }
    in_format!(format, of(integrator))
}

/// Error of the decay, and order of convergence across a step of contact.
pub(super) fn section(page: &mut Page) -> Result<()> {
    page.heading(2, "Gates");
    page.say(
        "Decay of z (τ_z = T_W/4, 2 Hz, 0.5 ms) after four time constants, against exp(−4): \
         relative error.",
    );
    let mut rows = Vec::new();
    for integrator in INTEGRATORS {
        let mut row = vec![name(integrator).to_owned()];
        for format in Format::ALL {
            row.push(short(decay(integrator, format)?));
        }
        rows.push(row);
    }
    page.table("integrator | f64 | f32 | fixed", rows);

    page.heading(3, "Order across a jump");
    page.say(format_args!(
        "Contact of {CONTACT} (σ_z = {}) steps on at {BEGIN} whisks, and in one of the runs off \
         at {END}. Largest error of θ' in degrees in f64 against the continuous equations; the \
         order is log₂ of the ratio to the tick twice as long. A gate is held for a tick, as \
         the papers have it, so a z that moves limits any integrator to first order; its jump \
         alone does not.",
        RCP.gain
    ));
    let mut rows = Vec::new();
    for contact in Contact::ALL {
        let truth = contact.truth();
        for integrator in INTEGRATORS {
            let mut row = vec![format!("{}, {}", name(integrator), contact.name())];
            let mut longer = None;
            for tick_hz in TICKS_HZ {
                let error = contact.error::<f64>(integrator, tick_hz, &truth)?;
                row.push(match longer {
                    None => short(error),
                    Some(longer) => format!("{} ({:.1})", short(error), libm::log2(longer / error)),
                });
                longer = Some(error);
            }
            rows.push(row);
        }
    }
    page.table(
        "run | 4 ms | 2 ms | 1 ms | 0.5 ms | 0.25 ms | 0.125 ms",
        rows,
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Contact, decay};
    use crate::accuracy::schemes::Format;
    use whisking::Integrator::{Euler, Exact};

    #[test]
    fn euler_is_of_first_order_and_a_jump_keeps_the_exact_integrator_above_second() {
        let truth = Contact::Held.truth();
        let order = |integrator| {
            let error = |hz| Contact::Held.error::<f64>(integrator, hz, &truth).unwrap();
            (error(1_000.0) / error(2_000.0)).log2()
        };
        let (euler, exact) = (order(Euler), order(Exact));
        assert!((euler - 1.0).abs() < 0.2, "{euler}");
        assert!(exact > 2.5, "{exact}");
    }

    /// (1 − T/τ)^(4 τ/T) is exp(−4) (1 − 2 T/τ) to first order: T/τ = 1/250.
    #[test]
    fn the_papers_decay_is_as_far_off_as_its_series_says() {
        let found = decay(Euler, Format::F64).unwrap();
        assert!((found / (2.0 / 250.0) - 1.0).abs() < 0.01, "{found}");
        for format in Format::ALL {
            // In fixed point what is left, 0.018, has steps of 2e-7 of itself.
            assert!(decay(Exact, format).unwrap() < 5e-6);
        }
    }
}
