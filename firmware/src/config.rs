//! Everything that a module is made from: plain data, which a scene comes to.
//!
//! # Glossary
//!
//! - *part*: what a scene may leave out; `None` here.
//! - *shape*: which parts there are and how many whiskers, the tick rate, the driver: what a
//!   module is built from at its start, and what cannot change while it runs.
//! - *limit that protects*: what makes a fault of a motor or a sensor.
//!
//! A configuration is built from a scene (the crate `config`), written as [bytes](encode) with a
//! version and a sum, and read again by a board ([`decode`]), which [checks](Config::check) it
//! once. After that a tick cannot fail. Every image has the same layout; what an image was built
//! without is refused by its name ([`Part`]).

mod bytes;
mod check;
mod parts;
mod protects;
mod shape;

use core::ops::Range;

use mlx90333::Decoder;
use serde::{Deserialize, Serialize};
use tactile::{ClassList, Whisked};
use whisking::motor::Driver;
use whisking::{Real, Start, filter};

use crate::boards::REST_US;
use crate::perception::ClassifierConfig;
use crate::sensing::SensorLimits;
use crate::servo::ServoConfig;

pub(crate) use bytes::ERASED;
pub use bytes::{
    BoardCode, CONFIG_BYTES, ConfigBytes, HEADER_BYTES, Header, VERSION, decode, decode_into,
    encode,
};
pub use check::Field;
pub use parts::Part;
pub use protects::allowed;

/// Longest name of a scene, bytes.
pub const NAME_BYTES: usize = 64;

/// Longest text of the keys that differ from the scene's file, bytes.
pub const OVERRIDES_BYTES: usize = 192;

/// The constants of a module, in the number format of its tick.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Config<R: Real> {
    /// What it is called, how fast it ticks, and how many whiskers it has.
    pub head: HeadConfig,
    /// How its sensors are read.
    pub sensor: SensingConfig,
    /// H50 on x (BIOTACT eq. 9), where something needs contact signals.
    pub contact: Option<filter::Config<R>>,
    /// How it moves; `None`: its whiskers are passive.
    pub motion: Option<MotionConfig<R>>,
    /// What it makes of touches; `None`: nothing.
    pub classifier: Option<ClassifierConfig<R>>,
    /// Priors and thresholds of the classes of its model, in that one's order; empty: they are
    /// equally likely, and the rule's threshold holds for all.
    pub classes: ClassList,
    /// By what it can be talked to.
    pub links: Links,
}

/// What a module is called, how fast it ticks, and how many whiskers it has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct HeadConfig {
    /// The name of its scene.
    pub name: heapless::String<NAME_BYTES>,
    /// The keys that differ from the scene's file, `KEY=VALUE` with spaces between.
    pub overrides: heapless::String<OVERRIDES_BYTES>,
    /// Ticks a second, 200 to 20,000.
    pub tick_hz: u32,
    /// Sides, 1 (the left) or 2.
    pub sides: u8,
    /// Whiskers on each side, 1 to 12.
    pub whiskers_per_side: u8,
    /// The bus of a head of several boards; `None`: one board has all its whiskers.
    pub bus: Option<BusConfig>,
}

impl HeadConfig {
    /// How many whiskers there are.
    pub const fn whiskers(&self) -> usize {
        self.sides as usize * self.whiskers_per_side as usize
    }

    /// The whiskers of a board, counted from 0, left side first; none of a node that there is not.
    pub fn of_node(&self, number: u8) -> Range<usize> {
        if !Part::Bus.is_built() {
            return 0..self.whiskers();
        }
        let nodes = self.bus.map_or(1, |bus| bus.nodes);
        let each = self.whiskers().checked_div(nodes.into()).unwrap_or(0);
        let first = usize::from(number) * each;
        if number < nodes {
            first..first + each
        } else {
            0..0
        }
    }

    /// Whether a board carries whiskers of a side, 0: the left.
    pub fn carries(&self, number: u8, side: usize) -> bool {
        let own = self.of_node(number);
        let each = usize::from(self.whiskers_per_side);
        own.start < (side + 1) * each && own.end > side * each
    }
}

/// The bus of a head, and how many boards share its whiskers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct BusConfig {
    /// Boards, 2 to [`MAX_NODES`](can::MAX_NODES): each carries as many whiskers as any other,
    /// node 0 the first of the left side.
    pub nodes: u8,
    /// Bits a second, thousands: 125 to 1000.
    pub kbit_s: u16,
}

/// Which sensor whiskers have, and in which of its modes. Written as its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SensorKind {
    /// An MLX90333 in its fast mode.
    FastMlx90333,
    /// One in its slow mode, which is read at half the clock.
    SlowMlx90333,
    /// A TMAG5170.
    Tmag5170,
}

impl SensorKind {
    /// Whether it computes slowly, and is read at half the clock.
    pub const fn is_slow(self) -> bool {
        matches!(self, Self::SlowMlx90333)
    }

    /// What an image must have to read it.
    pub const fn part(self) -> Part {
        match self {
            Self::FastMlx90333 | Self::SlowMlx90333 => Part::Mlx90333,
            Self::Tmag5170 => Part::Tmag5170,
        }
    }
}

/// How sensors are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SensingConfig {
    /// Which they are.
    pub kind: SensorKind,
    /// Least time for which an MLX90333 is deselected between two frames, µs.
    pub rest_us: u16,
    /// How frames of an MLX90333 are read.
    pub decoder: Decoder,
    /// By how much a tick learns what whisking alone makes them read, which is no contact, 2⁻¹⁶
    /// ([`SelfMotion::rate`](tactile::SelfMotion::rate)); `None`: that is contact.
    pub self_motion: Option<u16>,
    /// What is tolerated of them.
    pub limits: SensorLimits,
}

/// How whiskers move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct MotionConfig<R: Real> {
    /// Oscillators, muscles and gates.
    pub whisking: whisking::Config<R>,
    /// Where they start.
    pub start: Start<R>,
    /// Source of the oscillators' noise.
    pub seed: u64,
    /// Position control, and what is done about faults of a motor.
    pub servo: ServoConfig<R>,
    /// The motors' power stage.
    pub driver: Driver,
    /// A fault of any whisker switches every motor off until it is gone; otherwise its own.
    pub stops_all: bool,
    /// Motors are armed when the program starts, unless a fault made it start.
    pub arms_at_start: bool,
}

/// By what a module can be talked to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Links {
    /// A probe reads records and writes requests in RAM.
    pub has_rtt: bool,
    /// Bits a second of the serial port; `None`: there is none.
    pub serial_baud: Option<u32>,
    /// Two pins show contact and decisions.
    pub has_pins: bool,
}

impl<R: Real> Config<R> {
    /// How it whisks; nothing is known of passive whiskers.
    pub fn whisked(&self) -> Whisked {
        let Some(motion) = self.motion.as_ref().filter(|_| Part::Motion.is_built()) else {
            return Whisked::default();
        };
        let cycles = i64::from(motion.whisking.oscillators.cycles_q24());
        let frequency = (cycles * 1000 * i64::from(self.head.tick_hz)) >> 24;
        Whisked {
            // At most an eighth of the rate of ticks.
            frequency_mhz: Some(frequency as u32),
            has_rcp: Some(motion.whisking.rcp.is_some()),
        }
    }

    /// One passive whisker that feels nothing and tells nothing: the smallest configuration.
    pub const fn still() -> Self {
        Self {
            head: HeadConfig {
                name: heapless::String::new(),
                overrides: heapless::String::new(),
                tick_hz: 2000,
                sides: 1,
                whiskers_per_side: 1,
                bus: None,
            },
            sensor: SensingConfig {
                kind: SensorKind::FastMlx90333,
                rest_us: REST_US,
                decoder: Decoder::new(),
                self_motion: None,
                limits: SensorLimits::ANY,
            },
            contact: None,
            motion: None,
            classifier: None,
            classes: ClassList::new(),
            links: Links {
                has_rtt: false,
                serial_baud: None,
                has_pins: false,
            },
        }
    }
}

/// Why a configuration is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ConfigError {
    /// There is none: its place is erased, or writing it was interrupted.
    #[error("there is none: none was deployed, or writing it was interrupted")]
    Absent,
    /// Something else lies there.
    #[error("what lies there is no configuration")]
    Strange,
    /// Its layout has another version.
    #[error("its layout has version {0}, this program reads {VERSION}")]
    Version(u16),
    /// It was made for another board.
    #[error("it was made for another board ({0})")]
    Board(u8),
    /// It has another number format.
    #[error("it has another number format ({0}) than this program")]
    Format(u8),
    /// It is longer than its place.
    #[error("it is longer than its place")]
    TooLong,
    /// Its sum is another.
    #[error("it is damaged: its checksum does not match")]
    Damaged,
    /// A part cannot be read.
    #[error("{0}: it cannot be read")]
    Unreadable(Part),
    /// A part is there that this image was built without.
    #[error("{0}: this image was built without it")]
    NotBuilt(Part),
    /// A value is out of its range.
    #[error("{0}: out of range")]
    Range(Field),
    /// The board has less than it asks for.
    #[error("{0}: more than this board has")]
    Room(Field),
    /// It changes what only a start can change.
    #[error("{0}: cannot change while the module runs; deploy the scene")]
    Shape(Field),
    /// It changes a limit that protects, and a motor is armed.
    #[error("{0}: changes only while no motor is armed")]
    Armed(Field),
}
