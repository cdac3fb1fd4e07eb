//! What a board cannot do.

use core::fmt;

use whisking::Real;

use super::timing::serial_most;
use super::{BoardFacts, Clocks, InHead, RECEIVED_BYTES, TICK_MIN_HZ};
use crate::{BusConfig, Config, ConfigError, Driver, Field, Part};

/// What a scene needs of a board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needs {
    /// Ticks a second.
    pub tick_hz: u32,
    /// Sensors are read at half the clock.
    pub is_slow: bool,
    /// Least time for which a sensor is deselected between two frames, µs.
    pub rest_us: u16,
    /// Sides.
    pub sides: u8,
    /// Whiskers on each.
    pub whiskers_per_side: u8,
    /// The motors' power stage, if there are motors.
    pub driver: Option<Driver>,
    /// Bits a second of the serial port, if there is one.
    pub serial_baud: Option<u32>,
    /// The bus of a head, whose whiskers its boards share.
    pub bus: Option<BusConfig>,
    /// Whether it decides what its whiskers touch.
    pub decides: bool,
}

impl Needs {
    /// Of a configuration.
    pub fn of<R: Real>(config: &Config<R>) -> Self {
        Self {
            tick_hz: config.head.tick_hz,
            is_slow: config.sensor.kind.is_slow(),
            rest_us: config.sensor.rest_us,
            sides: config.head.sides,
            whiskers_per_side: config.head.whiskers_per_side,
            driver: config.motion.as_ref().map(|motion| motion.driver),
            serial_baud: config.links.serial_baud,
            bus: config.head.bus.filter(|_| Part::Bus.is_built()),
            decides: config.classifier.is_some(),
        }
    }

    /// Whiskers of one board, of which each hangs on a side of its own.
    fn sides_of_board(&self) -> u8 {
        let all = self.sides.saturating_mul(self.whiskers_per_side);
        let each = |bus: BusConfig| all.checked_div(bus.nodes).unwrap_or(0);
        self.bus.map_or(self.sides, each)
    }
}

/// Why a board does not take a scene, and what it does take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misfit {
    /// It has so many sides at most.
    Sides(u8),
    /// It has one whisker a side.
    Whiskers,
    /// Its program has no bus.
    NoBus,
    /// Its RAM has no room for a bus and a classifier.
    DecidesInHead,
    /// So many whiskers at most are on a board of a head.
    Share(u8),
    /// This clock of the bus, Hz, is no multiple of its bits.
    BusOfClock(u32),
    /// One brushless motor takes every output of the PWM's timer.
    TwoBrushless,
    /// A sensor frame has to fit into a tick.
    TickHz {
        /// The highest rate at which it does, Hz; the lowest is [`TICK_MIN_HZ`].
        most: u32,
        /// How long it takes, µs.
        frame_us: u32,
        /// For how long the sensor is deselected after it, µs.
        rest_us: u16,
    },
    /// This clock of the serial port, Hz, is no multiple of its baud.
    BaudOfClock(u32),
    /// More bytes come in two ticks than there is room for, at more than this baud.
    BaudOfTicks(u32),
}

impl Misfit {
    /// As a board says it.
    pub const fn error(self) -> ConfigError {
        match self {
            Self::Sides(_) => ConfigError::Room(Field::Sides),
            Self::Whiskers | Self::Share(_) => ConfigError::Room(Field::Whiskers),
            Self::NoBus | Self::DecidesInHead => ConfigError::Room(Field::Bus),
            Self::BusOfClock(_) => ConfigError::Range(Field::Bus),
            Self::TwoBrushless => ConfigError::Room(Field::Driver),
            Self::TickHz { .. } => ConfigError::Range(Field::TickHz),
            Self::BaudOfClock(_) | Self::BaudOfTicks(_) => ConfigError::Range(Field::SerialBaud),
        }
    }
}

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Sides(1) => f.write_str("\"left\", because it carries one whisker"),
            Self::Sides(_) => f.write_str("\"left\" or \"both\""),
            Self::Whiskers => f.write_str("1, because it carries one whisker a side"),
            Self::NoBus => f.write_str("no such key, because its chip or its program has no CAN"),
            Self::Share(most) => write!(f, "as many as make {most} whiskers a board or fewer"),
            Self::DecidesInHead => {
                f.write_str("no such key beside [classifier], because its RAM has no room for both")
            }
            Self::BusOfClock(can_hz) => write!(
                f,
                "125 to 1000, of which {can_hz} Hz are a multiple by 8 to 18 and a whole number"
            ),
            Self::TwoBrushless => f.write_str(
                "\"h-bridge\" on two sides, because one brushless motor takes every output of \
                 the PWM's timer",
            ),
            Self::TickHz {
                most,
                frame_us,
                rest_us,
            } => write!(
                f,
                "{TICK_MIN_HZ} to {most}, because a sensor frame takes {frame_us} us and its rest \
                 {rest_us} us"
            ),
            Self::BaudOfClock(serial_hz) => write!(
                f,
                "up to {}, where {serial_hz} Hz are a multiple of it to within 1.5 %",
                serial_hz / 16
            ),
            Self::BaudOfTicks(most) => write!(
                f,
                "up to {most}, which brings less than {RECEIVED_BYTES} bytes in two ticks"
            ),
        }
    }
}

impl BoardFacts {
    /// Its clocks, of sensors in their slow mode or not.
    pub const fn clocks_of(&self, is_slow: bool) -> Clocks {
        if is_slow {
            self.clocks.halved()
        } else {
            self.clocks
        }
    }

    /// Whether it can do what a scene needs.
    ///
    /// # Errors
    /// The first thing that it cannot.
    pub fn fits(&self, needs: &Needs) -> Result<(), Misfit> {
        let sides = needs.sides_of_board();
        let has_room = sides <= self.max_sides;
        if needs.bus.is_some() {
            let is_full = needs.decides && self.in_head != InHead::Tuned;
            refuse(self.in_head == InHead::Never, Misfit::NoBus)?;
            refuse(is_full, Misfit::DecidesInHead)?;
            refuse(!has_room, Misfit::Share(self.max_sides))?;
        } else {
            refuse(!has_room, Misfit::Sides(self.max_sides))?;
            refuse(needs.whiskers_per_side != 1, Misfit::Whiskers)?;
        }
        let is_brushless = needs.driver == Some(Driver::SixStep);
        refuse(sides > 1 && is_brushless, Misfit::TwoBrushless)?;
        let clocks = self.clocks_of(needs.is_slow);
        let most = clocks.tick_max_hz(needs.rest_us);
        let too_fast = Misfit::TickHz {
            most,
            frame_us: clocks.frame_least_ns() / 1_000,
            rest_us: needs.rest_us,
        };
        refuse(!(TICK_MIN_HZ..=most).contains(&needs.tick_hz), too_fast)?;
        let hz = clocks.serial_hz;
        let is_uneven = |bus: BusConfig| clocks.can_timing(bus.kbit_s).is_none();
        refuse(needs.bus.is_some_and(is_uneven), Misfit::BusOfClock(hz))?;
        let Some(baud) = needs.serial_baud else {
            return Ok(());
        };
        let divider = clocks.serial_divider(baud);
        refuse(divider.is_none(), Misfit::BaudOfClock(hz))?;
        let most = serial_most(needs.tick_hz);
        refuse(baud > most, Misfit::BaudOfTicks(most))
    }
}

fn refuse(is_misfit: bool, misfit: Misfit) -> Result<(), Misfit> {
    if is_misfit { Err(misfit) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::{Misfit, Needs};
    use crate::boards::{NUCLEO_F103RB, NUCLEO_F446RE, NUCLEO_G071RB, REST_US};
    use crate::{BusConfig, Config, ConfigError, Driver, Field};

    fn still() -> Needs {
        Needs::of(&Config::<f32>::still())
    }

    #[test]
    fn what_a_board_cannot_do_is_refused_by_what_it_can() {
        let both = Needs {
            sides: 2,
            ..still()
        };
        let array = Needs {
            whiskers_per_side: 2,
            ..still()
        };
        let brushless = Needs {
            driver: Some(Driver::SixStep),
            ..both
        };
        let head = |nodes, kbit_s| Needs {
            whiskers_per_side: 12,
            bus: Some(BusConfig { nodes, kbit_s }),
            ..both
        };
        let decides = Needs {
            decides: true,
            ..head(24, 1_000)
        };
        let can_hz = NUCLEO_F446RE.clocks.serial_hz;
        for (board, needs, misfit) in [
            (NUCLEO_F446RE, both, None),
            (NUCLEO_G071RB, both, Some(Misfit::Sides(1))),
            (NUCLEO_F446RE, array, Some(Misfit::Whiskers)),
            (NUCLEO_F446RE, brushless, Some(Misfit::TwoBrushless)),
            (NUCLEO_F446RE, head(12, 1_000), None),
            (NUCLEO_F446RE, head(8, 500), Some(Misfit::Share(2))),
            (
                NUCLEO_F446RE,
                head(24, 999),
                Some(Misfit::BusOfClock(can_hz)),
            ),
            (NUCLEO_G071RB, head(24, 1_000), Some(Misfit::NoBus)),
            (NUCLEO_F103RB, head(24, 1_000), None),
            (NUCLEO_F103RB, head(12, 1_000), Some(Misfit::Share(1))),
            (NUCLEO_F446RE, decides, None),
            (NUCLEO_F103RB, decides, Some(Misfit::DecidesInHead)),
        ] {
            assert_eq!(board.fits(&needs).err(), misfit, "{}", board.name);
        }
        let most = |is_slow| NUCLEO_F446RE.clocks_of(is_slow).tick_max_hz(REST_US);
        let too_fast = [false, true].map(|is_slow| (most(is_slow) + 1, is_slow));
        for (tick_hz, is_slow) in [(199, false), (0, false)].into_iter().chain(too_fast) {
            let fast = Needs {
                tick_hz,
                is_slow,
                ..still()
            };
            let found = NUCLEO_F446RE.fits(&fast).unwrap_err();
            assert_eq!(found.error(), ConfigError::Range(Field::TickHz));
        }
        for (baud, tick_hz) in [(3_000_000, 2_000), (921_600, 200), (0, 2_000)] {
            let quick = Needs {
                serial_baud: Some(baud),
                tick_hz,
                ..still()
            };
            let found = NUCLEO_F446RE.fits(&quick).unwrap_err();
            assert_eq!(found.error(), ConfigError::Range(Field::SerialBaud));
        }
    }
}
