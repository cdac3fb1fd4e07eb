//! Modules of one side and of two, with any number of whiskers.

use crate::settings::plain;
use proptest::prelude::*;
use whisking::{Fix, GateSettings, Integrator, MAX_WHISKERS, Number, Parameter, Settings, State};

fn settings(integrator: Integrator, coupling: bool) -> Settings {
    let gate = |gain| Some(GateSettings { gain, tau_s: 0.1 });
    Settings {
        coupling,
        rcp: gate(0.7),
        cia: gate(0.5),
        ..plain(integrator, 1_000.0, 8.0)
    }
}

/// θ of every whisker after each tick, with contact of this strength every now and then.
fn run<R: Number>(
    settings: &Settings,
    psi: &[[f64; 2]],
    gains: &[&[f64]],
    contact: &[f64],
) -> Vec<Vec<f64>> {
    let config = settings.build::<R>().unwrap();
    let start = settings.start::<R>(psi, gains).unwrap();
    let mut state = State::new(&start, 1);
    let contact: Vec<R> = contact.iter().copied().map(R::from_f64).collect();
    let ticks = (0..300).map(|tick| {
        let touches = tick % 100 < 20;
        config.step(&mut state, if touches { &contact } else { &[] });
        state.theta().map(R::to_f64).collect()
    });
    ticks.collect()
}

#[test]
fn a_number_of_sides_or_whiskers_that_does_not_fit_is_refused() {
    let settings = settings(Integrator::Exact, true);
    let many = [1.0; MAX_WHISKERS + 1];
    let size = |psi: &[[f64; 2]], gains: &[&[f64]]| {
        let error = settings.start::<f64>(psi, gains).err();
        error.map(|error| error.parameter)
    };
    let psi = [[1.0, 0.0]; 3];
    assert_eq!(size(&[], &[]), Some(Parameter::Size));
    assert_eq!(size(&psi, &[&[1.0][..]; 3]), Some(Parameter::Size));
    assert_eq!(size(&psi[..2], &[&[1.0]]), Some(Parameter::Size));
    assert_eq!(size(&psi[..1], &[&[1.0], &[1.0]]), Some(Parameter::Size));
    assert_eq!(size(&psi[..1], &[&many]), Some(Parameter::Size));
    let one_more = size(&psi[..2], &[&many[..13], &many[..12]]);
    assert_eq!(one_more, Some(Parameter::Size));
    assert_eq!(size(&psi[..2], &[&many[..12], &many[..12]]), None);
    assert_eq!(size(&psi[..1], &[&[]]), None);
}

#[test]
fn a_contact_that_is_missing_is_zero_and_one_of_no_side_is_ignored() {
    let settings = settings(Integrator::Exact, true);
    let psi = [[1.0, 0.0], [0.6, 0.5]];
    let gains: &[&[f64]] = &[&[1.0], &[0.7]];
    let of = |contact: &[f64]| run::<f64>(&settings, &psi, gains, contact);
    assert_eq!(of(&[0.5]), of(&[0.5, 0.0]));
    assert_eq!(of(&[0.5, 0.2]), of(&[0.5, 0.2, 9.0]));
    assert_ne!(of(&[0.5]), of(&[0.0, 0.5]));
}

fn any_psi() -> impl Strategy<Value = [f64; 2]> {
    [-1.5..1.5, -1.5..1.5]
}

proptest! {
    /// Sides that are not coupled are two modules of one side each; to rounding, because the
    /// exact integrator keeps sum and difference. What CIA lifts is that of both.
    #[test]
    fn sides_without_coupling_are_two_modules(
        left in any_psi(),
        right in any_psi(),
        gains in [0.0..2.0, 0.0..2.0],
        contact in 0.0..1.0,
    ) {
        for integrator in [Integrator::Euler, Integrator::Exact] {
            let settings = settings(integrator, false);
            let gains = gains.each_ref().map(core::slice::from_ref);
            let both = run::<f64>(&settings, &[left, right], &gains, &[contact; 2]);
            for (side, psi) in [left, right].into_iter().enumerate() {
                let one = run::<f64>(&settings, &[psi], &gains[side..=side], &[contact]);
                for (both, one) in both.iter().zip(one) {
                    let error = (both[side] - one[0]).abs();
                    prop_assert!(error < 1e-9, "{integrator:?}, {side}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn a_whisker_moves_as_it_does_alone(
        psi in any_psi(),
        gains in proptest::collection::vec(0.0..2.0, 1..=MAX_WHISKERS),
        contact in 0.0..1.0,
    ) {
        let settings = settings(Integrator::Exact, true);
        let all = run::<Fix>(&settings, &[psi], &[&gains], &[contact]);
        for (n, gain) in gains.iter().enumerate() {
            let alone = run::<Fix>(&settings, &[psi], &[&[*gain]], &[contact]);
            prop_assert!(all.iter().zip(alone).all(|(all, alone)| all[n] == alone[0]));
        }
    }
}
