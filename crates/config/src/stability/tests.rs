//! What forward Euler can carry: the limits stand where the product itself, run
//! on either side of them, starts to misbehave.

use firmware::Config;
use scene::Scene;
use whisking::oscillator::Psi;
use whisking::{Integrator, Settings, State};

use crate::{Instability, Mismatch, RunsOn, Target, Unstable, build, cautions, check};

fn scene(frequency_hz: f64, tick_hz: u32, integrator: &str, tau_s: [f64; 2]) -> Scene {
    let [rcp, cia] = tau_s;
    crate::tests::scene(&[
        &format!("whisking.frequency_hz={frequency_hz:?}"),
        &format!("tick_hz={tick_hz}"),
        &format!("whisking.integrator={integrator}"),
        &format!("rcp.tau_s={rcp:?}"),
        "cia.gain=0.5",
        &format!("cia.tau_s={cia:?}"),
        "motor.kp=0.005",
        "motor.kd=0.0001",
    ])
}

/// The only caution about a scene that is taken.
fn caution(scene: &Scene) -> Instability {
    assert_eq!(check(scene), Ok(()));
    let found = cautions(scene).expect("a caution");
    let [one] = *found.as_slice() else {
        panic!("{found:?}");
    };
    one
}

fn is_clean(scene: &Scene) -> bool {
    check(scene).is_ok() && cautions(scene).is_none()
}

fn built(scene: &Scene) -> Result<Config<f64>, Mismatch> {
    build(scene, Target::of(RunsOn::Board))
}

/// The product with forward Euler, both sides alike, and a whisker each.
struct Running {
    config: whisking::Config<f64>,
    state: State<f64>,
}

impl Running {
    /// `cycles` is f_W T.
    fn new(cycles: f64, gain: f64, start: Psi<f64>) -> Self {
        let tick_hz = f64::min(25.0 / cycles, 20_000.0);
        let settings = Settings {
            tick_hz,
            frequency_hz: cycles * tick_hz,
            integrator: Integrator::Euler,
            coupling: true,
            noise: 0.0,
            rcp: None,
            cia: None,
        };
        let start = settings.start(&[start; 2], &[[gain].as_slice(); 2]);
        Self {
            config: settings.build().unwrap(),
            state: State::new(&start.unwrap(), 1),
        }
    }

    fn tick(&mut self) -> (Psi<f64>, f64) {
        self.config.step(&mut self.state, &[0.0; 2]);
        let psi = self.config.oscillators.psi(&self.state.oscillators)[0];
        (psi, self.state.whiskers[0].muscle.theta)
    }
}

#[test]
fn what_the_papers_and_the_scenes_use_is_allowed() {
    for (frequency_hz, tick_hz) in [(2.0, 2_000), (8.0, 4_000), (10.0, 2_000), (0.05, 200)] {
        let tick_s = 1.0 / f64::from(tick_hz);
        let scene = scene(frequency_hz, tick_hz, "euler", [0.125, tick_s]);
        assert!(is_clean(&scene), "{frequency_hz} Hz at {tick_hz}");
        assert!(built(&scene).unwrap().motion.is_some());
    }
}

#[test]
fn the_exact_integrator_carries_everything() {
    for frequency_hz in [0.05, 2.0, 25.0] {
        for tick_hz in [200, 2_000, 20_000] {
            let scene = scene(frequency_hz, tick_hz, "exact", [1e-6, 1e5]);
            assert!(is_clean(&scene), "{frequency_hz} Hz at {tick_hz}");
        }
    }
}

/// A circle of 1.5 lies at f_W T = 0.0084375: 25 Hz at 2962.96 ticks a second, 16.875 Hz at 2000.
#[test]
fn the_circle_may_touch_the_limit_of_psi_but_not_lie_beyond() {
    assert!(is_clean(&scene(25.0, 2_963, "euler", [1.0; 2])));
    assert!(is_clean(&scene(16.87, 2_000, "euler", [1.0; 2])));
    let found = caution(&scene(25.0, 2_962, "euler", [1.0; 2]));
    let Instability::Oscillators { radius, tick_hz } = found else {
        panic!("{found:?}");
    };
    let radius = radius.expect("a circle");
    assert!(1.5 < radius && radius < 1.501, "{radius}");
    assert_eq!(tick_hz, 2_963.0);
    let found = caution(&scene(16.88, 2_000, "euler", [1.0; 2]));
    assert!(matches!(
        found,
        Instability::Oscillators {
            tick_hz: 2_001.0,
            ..
        }
    ));
}

/// The radius on which the product circles, and whether it meets the limit.
fn circle(cycles: f64) -> (f64, bool) {
    let mut running = Running::new(cycles, 1.0, [1.0, 0.0]);
    let mut mean = 0.0;
    let mut limited = false;
    for n in 0..40_000 {
        let (psi, _) = running.tick();
        if n >= 20_000 {
            mean += psi[0].hypot(psi[1]) / 20_000.0;
            limited |= psi.iter().any(|x| x.abs() >= 1.5);
        }
    }
    (mean, limited)
}

#[test]
fn the_product_circles_where_the_closed_form_says() {
    for (frequency_hz, radius) in [(2.0, 1.041_101), (10.0, 1.246_014), (15.0, 1.420_965)] {
        let (found, limited) = circle(frequency_hz / 2_000.0);
        assert!((found - radius).abs() < 1e-5, "{frequency_hz}: {found}");
        assert!(!limited, "{frequency_hz}");
    }
    // Half a per cent on either side of the limit, 0.0084375.
    assert!(!circle(0.008_395).1);
    assert!(circle(0.008_479).1);
    // Just beyond, the closed form still gives the radius that is refused.
    let found = caution(&scene(20.0, 2_000, "euler", [1.0; 2]));
    let Instability::Oscillators { radius, .. } = found else {
        panic!("{found:?}");
    };
    assert!((radius.expect("a circle") - 1.653_37).abs() < 1e-4);
}

/// Whether the muscles swing up: with so small a gain θ stays below 2e-6 if not.
fn swings(cycles: f64) -> bool {
    let mut running = Running::new(cycles, 1e-6, [1.0, 0.0]);
    (0..20_000).any(|_| running.tick().1.abs() > 1e-2)
}

/// The faster pole meets −1 at f_W T = 2/(10 (2 + √3)) = 0.053590: 25 Hz at 466.5 ticks a second.
#[test]
fn muscles_swing_up_beyond_their_pole() {
    let cycles = 0.2 / (2.0 + 3.0_f64.sqrt());
    let muscles = |tick_hz| {
        let Err(Mismatch::Unstable(found)) = check(&scene(25.0, tick_hz, "euler", [1.0; 2])) else {
            return None;
        };
        found.as_slice().iter().find_map(|entry| match *entry {
            Instability::Muscles { factor, tick_hz } => Some((factor, tick_hz)),
            _ => None,
        })
    };
    assert_eq!(muscles(467), None);
    let (factor, tick_hz) = muscles(466).unwrap();
    assert!((-1.003..-1.0).contains(&factor), "{factor}");
    assert_eq!(tick_hz, 467.0);
    // The product on either side, one per cent away.
    assert!(!swings(0.99 * cycles));
    assert!(swings(1.01 * cycles));
}

/// After one tick without contact 1 − T/τ is left of a gate (eq. 10).
#[test]
fn a_gate_may_last_a_tick_but_not_less() {
    // 2004.008 ticks a second are as many as 4.99e-4 s; a million are too many.
    for (tau_s, least) in [(4.99e-4, Some(2_005.0)), (1e-6, None)] {
        for (section, tau_s) in [("rcp", [tau_s, 5.0e-4]), ("cia", [5.0e-4, tau_s])] {
            let found = caution(&scene(2.0, 2_000, "euler", tau_s));
            let Instability::Gate {
                section: named,
                tick_hz,
                ..
            } = found
            else {
                panic!("{found:?}");
            };
            assert_eq!((named, tick_hz), (section, least));
        }
    }
    assert!(is_clean(&scene(2.0, 2_000, "euler", [5.0e-4; 2])));
}

#[test]
fn what_is_suggested_is_the_least() {
    let mut suggested = 0;
    for frequency_hz in [1.7, 3.3, 8.0, 12.5, 17.0, 25.0] {
        for tick_hz in [200, 333, 500, 1_000] {
            for tau_s in [1.0, 9e-4, 3e-4] {
                let at = |tick_hz| scene(frequency_hz, tick_hz, "euler", [tau_s, 1.0]);
                let refused = match check(&at(tick_hz)) {
                    Err(Mismatch::Unstable(found)) => Some(found),
                    _ => None,
                };
                let found: Vec<Unstable> =
                    refused.into_iter().chain(cautions(&at(tick_hz))).collect();
                let entries = found.iter().flat_map(Unstable::as_slice);
                let least = entries.map(|entry| match *entry {
                    Instability::Oscillators { tick_hz, .. }
                    | Instability::Muscles { tick_hz, .. } => tick_hz,
                    Instability::Gate { tick_hz, .. } => tick_hz.unwrap(),
                });
                let Some(least) = least.reduce(f64::max) else {
                    continue;
                };
                let least = least as u32;
                let are_clean = [least, least - 1].map(|tick_hz| is_clean(&at(tick_hz)));
                assert_eq!(are_clean, [true, false], "{frequency_hz} {tick_hz} {tau_s}");
                suggested += 1;
            }
        }
    }
    assert!(suggested > 40, "{suggested}");
}

#[test]
fn a_refusal_and_a_caution_say_what_was_found_and_what_is_better() {
    let scene = scene(25.0, 400, "euler", [1e-6, 1e-3]);
    let refused = built(&scene).unwrap_err();
    assert_eq!(Err(refused.clone()), check(&scene));
    let found = "whisking.integrator: found \"euler\" at 25 Hz with tick_hz = 400: ";
    let or = "allowed: integrator = \"exact\", or \"euler\" with";
    let grows = "a tick multiplies the muscles' fast mode by -1.33, so it grows";
    let expected = format!("{found}{grows}; {or} tick_hz at least 467");
    assert_eq!(refused.to_string(), expected);
    let or = "better: integrator = \"exact\", or \"euler\" with";
    let caution = cautions(&scene).unwrap().to_string();
    let expected = [
        "its oscillators have no circle to settle on, and the limit is 1.5; OR tick_hz at least 2963",
        "rcp.tau_s = 0.000001 is shorter than a tick, and a decay overshoots; OR rcp.tau_s at least \
         a tick",
        "cia.tau_s = 0.001 is shorter than a tick, and a decay overshoots; OR cia.tau_s at least a \
         tick or tick_hz at least 1000",
    ];
    let expected = expected.map(|says| format!("{found}{}", says.replace("OR", or)));
    assert_eq!(caution.lines().collect::<Vec<_>>(), expected);
}
