//! Configurations go over a wire and come back as they were.

use crate::settings::plain;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;
use whisking::motor::{
    Duty, GuardConfig, GuardSettings, HomingConfig, HomingSettings, SixStepConfig,
};
use whisking::{Config, Fix, GateSettings, Integrator, Real, Settings, Start, filter, pd};

fn again<T: Serialize + DeserializeOwned + PartialEq + Debug>(sent: &T) {
    let bytes = postcard::to_allocvec(sent).unwrap();
    assert_eq!(&postcard::from_bytes::<T>(&bytes).unwrap(), sent);
    // Not a byte may be missing.
    let short = postcard::from_bytes::<T>(&bytes[..bytes.len() - 1]);
    assert!(short.is_err(), "{sent:?}");
}

/// With every part, and with none.
fn settings(integrator: Integrator) -> [Settings; 2] {
    let least = plain(integrator, 2_000.0, 8.0);
    let gate = |gain| Some(GateSettings { gain, tau_s: 0.1 });
    let full = Settings {
        coupling: true,
        noise: 0.01,
        rcp: gate(0.7),
        cia: gate(0.5),
        ..least
    };
    [least, full]
}

fn check<R: Real>() {
    for integrator in [Integrator::Euler, Integrator::Exact] {
        again(&integrator);
        for settings in settings(integrator) {
            again::<Config<R>>(&settings.build().unwrap());
            let gains: &[&[f64]] = &[&[1.0, 0.3, 2.0], &[0.7]];
            for sides in 1..=2 {
                let psi = &[[1.0, -0.2], [0.3, 0.9]][..sides];
                again::<Start<R>>(&settings.start(psi, &gains[..sides]).unwrap());
            }
        }
    }
    again(&filter::Config::<R>::new(50.0, 2_000.0).unwrap());
    let pd = pd::Settings {
        kp: 0.05,
        kd: 1e-3,
        limit: 0.8,
        slew_per_s: 400.0,
        min_deg: 30.0,
        max_deg: 150.0,
        degrees_per_count: 0.01,
    };
    again::<pd::Config<R>>(&pd.build(2_000.0).unwrap());
    again::<GuardConfig<R>>(&GuardSettings::NONE.build(2_000.0));
}

#[test]
fn configurations_come_back_in_every_format() {
    check::<f32>();
    check::<f64>();
    check::<Fix>();
    let homing = HomingSettings {
        degrees_per_count: 0.01,
        duty: 0.2,
        stop_deg: 20.0,
        max_deg: 160.0,
        far_stop_deg: Some(185.0),
        every_s: 30.0,
        calm: 0.05,
    };
    again::<HomingConfig>(&homing.build(2_000.0));
    again(&SixStepConfig::DEFAULT);
}

#[test]
fn a_duty_is_none_that_there_is_not() {
    for q15 in [-32_767, -1, 0, 1, 32_767] {
        again(&Duty::from_q15(q15));
    }
    let bytes = postcard::to_allocvec(&i16::MIN).unwrap();
    assert!(postcard::from_bytes::<Duty>(&bytes).is_err());
}
