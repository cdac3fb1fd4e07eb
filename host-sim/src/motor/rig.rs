//! For tests: one whisker's loop of pattern generator, position control, real
//! driver and simulated motor.

use firmware::AngleInput;
use whisking::motor::{HBridge, MotorDriver};
use whisking::{GateSettings, Integrator, Settings, State, filter, pd};

use super::{MotorSettings, SimEncoder, SimMotor, SimPin, SimPwm};

/// The defaults of a scene's motor section.
pub(crate) const PD: pd::Settings = pd::Settings {
    kp: 0.05,
    kd: 0.0004,
    limit: 1.0,
    slew_per_s: 400.0,
    min_deg: 30.0,
    max_deg: 160.0,
    degrees_per_count: MotorSettings::DEFAULT.degrees_per_count(),
};

/// A whisk of 2 Hz, as in all of BIOTACT.
pub(crate) fn whisking(tick_hz: f64, rcp_gain: Option<f64>) -> Settings {
    Settings {
        tick_hz,
        frequency_hz: 2.0,
        integrator: Integrator::Exact,
        coupling: false,
        noise: 0.0,
        rcp: rcp_gain.map(|gain| GateSettings { gain, tau_s: 0.125 }),
        cia: None,
    }
}

/// One whisker's loop.
pub(crate) struct Rig {
    whisking: whisking::Config<f64>,
    state: State<f64>,
    h50: filter::Config<f64>,
    smoothed: filter::State<f64>,
    pd: pd::Config<f64>,
    servo: pd::State<f64>,
    driver: HBridge<SimPwm, SimPin>,
    encoder: SimEncoder,
    counts: i32,
    pub(crate) motor: SimMotor,
    tick_s: f64,
}

impl Rig {
    pub(crate) fn new(settings: &Settings, pd: &pd::Settings, gain: f64) -> Self {
        let start = settings.start(&[[1.0, 0.0]], &[&[gain]]).unwrap();
        let (motor, pins) = SimMotor::brushed(MotorSettings::DEFAULT).unwrap();
        Self {
            whisking: settings.build().unwrap(),
            state: State::new(&start, 1),
            h50: filter::Config::new(filter::CORNER_HZ, settings.tick_hz).unwrap(),
            smoothed: filter::State::default(),
            pd: pd.build(settings.tick_hz).unwrap(),
            servo: pd::State::default(),
            driver: HBridge::new(pins.pwm, pins.dir),
            encoder: pins.encoder,
            counts: 0,
            motor,
            tick_s: 1.0 / settings.tick_hz,
        }
    }

    /// One tick with deflection `x`; the setpoint θ′ in degrees.
    pub(crate) fn tick(&mut self, x: f64) -> f64 {
        let contact = self.h50.process(&mut self.smoothed, x).abs();
        self.whisking.step(&mut self.state, &[contact]);
        let setpoint = self.state.theta().next().unwrap_or_default();
        let counts = self.encoder.counts();
        let moved = counts - std::mem::replace(&mut self.counts, counts);
        let duty = self.pd.step(&mut self.servo, setpoint, counts, moved);
        self.driver.drive(duty).unwrap();
        self.motor.advance(self.tick_s);
        whisking::degrees(setpoint)
    }
}
