//! The whole loop against expectations on the wire: every byte on the bus,
//! every pin and duty value, worked out by hand from the settings below.

use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Set};
use embedded_hal_mock::eh1::pwm::{Mock as Pwm, Transaction as Pulse};
use embedded_hal_mock::eh1::spi::{Mock as Spi, Transaction as Transfer};
use firmware::{
    AngleInput, Clock, CodeClassifier, Config, Event, Hardware, Module, MotionConfig, Place,
    Polled, Retry, SensorFault, ServoConfig, WhiskerParts,
};
use mlx90333::{Decoder, FrameError, Mlx90333};
use whisking::motor::HBridge;
use whisking::{GateSettings, Integrator, Settings, pd};

use crate::command::{self, PD};

/// A frame at rest: alpha and beta 0x8000, no error; 0x80 + 0x80 = 0x100.
const REST: [u8; 8] = [0xFF, 0x00, 0x80, 0x00, 0x80, 0x00, 0x00, 0x00];
/// Alpha 0xC000: code 12288, x = 4096/8191; 0xC0 + 0x80 = 0x140.
const BENT: [u8; 8] = [0xFF, 0x00, 0xC0, 0x00, 0x80, 0x00, 0x00, 0x40];
/// No sensor answers.
const EMPTY: [u8; 8] = [0xFF; 8];
/// The sum byte of [`REST`] with one bit wrong.
const TORN: [u8; 8] = [0xFF, 0x00, 0x80, 0x00, 0x80, 0x00, 0x00, 0x10];

struct Encoder(std::vec::IntoIter<i32>);

impl AngleInput for Encoder {
    fn counts(&mut self) -> i32 {
        self.0.next().expect("one reading a tick")
    }
}

struct Microseconds(u32);

impl Clock for Microseconds {
    fn now(&mut self) -> u32 {
        // A tick of 40 µs, one every 500 µs.
        self.0 += if self.0.is_multiple_of(500) { 40 } else { 460 };
        self.0
    }
}

struct Tick {
    frame: [u8; 8],
    counts: i32,
    pulses: Vec<Pulse>,
    direction: Option<State>,
}

fn tick(frame: [u8; 8], counts: i32, duty: u16) -> Tick {
    let mut tick = off(frame, counts);
    tick.pulses = vec![Pulse::max_duty_cycle(1000), Pulse::set_duty_cycle(duty)];
    tick
}

fn turn(frame: [u8; 8], counts: i32, direction: State, duty: u16) -> Tick {
    let mut tick = tick(frame, counts, duty);
    tick.pulses.insert(0, Pulse::set_duty_cycle(0));
    tick.direction = Some(direction);
    tick
}

fn off(frame: [u8; 8], counts: i32) -> Tick {
    Tick {
        frame,
        counts,
        pulses: vec![Pulse::set_duty_cycle(0)],
        direction: None,
    }
}

const SETTINGS: Settings = Settings {
    tick_hz: 2000.0,
    frequency_hz: 2.0,
    integrator: Integrator::Euler,
    coupling: true,
    noise: 0.0,
    rcp: Some(GateSettings {
        gain: 0.7,
        tau_s: 0.125,
    }),
    cia: None,
};

/// Ten counts a degree, 0.05 of duty a degree, at most 0.5, at most 0.2 a tick.
fn config() -> Config<f32> {
    let pd = pd::Settings {
        kp: 0.05,
        limit: 0.5,
        slew_per_s: 400.0,
        max_deg: 160.0,
        ..PD
    };
    let retry = Retry {
        rest: 10,
        window: 0,
    };
    let (_, mut config) = command::module::<f32>();
    config.head.whiskers_per_side = 1;
    config.sensor.limits.recover = 2;
    config.motion = config.motion.map(|motion| MotionConfig {
        whisking: SETTINGS.build().unwrap(),
        start: SETTINGS.start(&[[1.0, 0.0]], &[&[0.0]]).unwrap(),
        servo: ServoConfig {
            pd: pd.build(2000.0).unwrap(),
            retry,
            ..motion.servo
        },
        ..motion
    });
    config
}

struct Wires;

impl Hardware for Wires {
    type Source = Polled<Spi<u8>>;
    type Motor = HBridge<Pwm, Pin>;
    type Angle = Encoder;
    type Classifier = CodeClassifier;
    type Clock = Microseconds;
}

/// The ticks as the wires must see them. The gain is 0, so that the setpoint is
/// the rest position throughout.
fn script() -> [Tick; 11] {
    [
        turn(REST, -40, State::High, 200),
        tick(REST, -80, 400),
        tick(REST, -200, 500),
        tick(REST, 20, 300),
        tick(BENT, 20, 100),
        turn(REST, 20, State::Low, 100),
        tick(EMPTY, 20, 100),
        off(EMPTY, 20),
        off(TORN, 20),
        off(REST, 20),
        turn(REST, 20, State::Low, 100),
    ]
}

#[test]
fn bytes_pins_and_duties_are_those_worked_out_by_hand() {
    let ticks = script();
    let transfer = |tick: &Tick| {
        [
            Transfer::transaction_start(),
            Transfer::transfer_in_place(vec![0xFF; 8], tick.frame.to_vec()),
            Transfer::transaction_end(),
        ]
    };
    let spi: Vec<_> = ticks.iter().flat_map(transfer).collect();
    // The bridge and then the module begin by switching off.
    let mut pulses = vec![Pulse::set_duty_cycle(0), Pulse::set_duty_cycle(0)];
    pulses.extend(ticks.iter().flat_map(|tick| tick.pulses.clone()));
    let directions = ticks.iter().filter_map(|tick| tick.direction);
    let sets: Vec<_> = directions.map(Set::set).collect();
    let mut counts = vec![0];
    counts.extend(ticks.iter().map(|tick| tick.counts));
    let (mut spi, mut pwm, mut pin) = (Spi::new(&spi), Pwm::new(&pulses), Pin::new(&sets));

    let config = config();
    let encoder = Encoder(counts.into_iter());
    let whisker = WhiskerParts {
        source: Polled::new(Mlx90333::new(spi.clone(), Decoder::new())),
        motor: Some((HBridge::new(pwm.clone(), pin.clone()), encoder)),
    };
    let clock = (Microseconds(40), 500);
    let mut module = Module::<f32, Wires>::new(&config, [whisker], None, clock);
    module.arm(true);

    let mut events = Vec::new();
    for n in 0..ticks.len() {
        module.tick(&config, &mut |event| events.push((n, event)));
        if n == 4 {
            // First value of H50's impulse response, by scipy.signal.butter(3, 50, fs=2000).
            let contact = 4.165_461_390_757_6e-4 * 4096.0 / 8191.0;
            assert!((f64::from(module.contact()[0]) - contact).abs() < 1e-9);
            let z = module.motion().unwrap().state().sides[0].z.value;
            assert!((f64::from(z) - 0.7 * contact).abs() < 1e-9);
        }
    }

    spi.done();
    pwm.done();
    pin.done();
    let place = Place::new(0, 0);
    let lost = SensorFault::Frame(FrameError::NoSensor);
    let lost = Event::SensorLost(place, lost);
    assert_eq!(events, [(7, lost), (10, Event::SensorBack(place))]);
    assert_eq!(module.timing_mut().take_worst(), 40);
    assert_eq!(module.timing_mut().missed(), 0);
}
