//! How a board's module starts.

use firmware::{MotionConfig, Part, WhiskerParts};
use static_cell::StaticCell;

use super::encoder::Encoder;
use super::motors::{Motor, MotorStart};
use super::scene::Pace;
use super::sensor::{self, FramePace};
use super::types::{Inner, Number, Settings};
use super::{pace, perception, pwm};
use crate::here::{self, Counter, SIDES};

static INNER: StaticCell<Inner> = StaticCell::new();

/// Once the clocks are as its sensors need them; whiskers are at rest now. It can be made once.
#[inline(never)]
pub(crate) fn start(
    settings: &Settings,
    node: u8,
    pace: &Pace,
    counter: Counter,
) -> Option<&'static mut Inner> {
    // Of a head it has some of the whiskers, each on a side of its own.
    let sides = settings.head.of_node(node).len() as u8;
    here::clock_sensors(sides);
    let clocks = pace::clocks();
    let frames = FramePace {
        slot: pace.slot_counts,
        lag: clocks.lag_rounds(settings.sensor.kind.is_slow()),
    };
    let motion = settings.motion.as_ref().filter(|_| Part::Motion.is_built());
    let motor = motion.map(|motion| start_motors(motion, sides));
    let parts = SIDES.iter().take(sides.into()).map(|side| WhiskerParts {
        source: sensor::start(&side.sensor, frames),
        motor: motor
            .and_then(|motor| Some((Motor::start(side, &motor)?, Encoder::start(&side.encoder)))),
    });
    let period = clocks.tick_counts(pace.tick);
    let inner = INNER.try_init_with(|| Inner::empty((counter, period)))?;
    inner.build(settings, node, parts, perception::start(settings, node));
    Some(inner)
}

/// Has each sensor be read by its driver, once its start-up is over, and says what was found. A
/// TMAG5170 is read so in every tick.
#[cfg(feature = "mlx90333")]
pub(crate) fn test_sensors(inner: &mut Inner, settings: &Settings, pace: &Pace) {
    let sensing = settings.sensor;
    let (slot, tick_us) = (pace.slot_counts, pace::period_us());
    let pacing = pace::clocks().pacing(slot, tick_us, sensing.rest_us);
    for whisker in inner.whiskers_mut() {
        let (place, source) = (whisker.place(), whisker.sensor_mut().source_mut());
        let found = sensor::self_test(source, sensing.decoder, pacing);
        super::log::self_test(place, &found);
    }
}

fn start_motors(motion: &MotionConfig<Number>, sides: u8) -> MotorStart {
    let pwm_counts = pace::clocks().pwm_counts();
    here::clock_motors(sides);
    pwm::start(pwm_counts);
    MotorStart {
        driver: motion.driver,
        stall: motion.servo.guards.stall,
        pwm_counts,
    }
}
