//! Which scene the board runs: that of the newest valid slot, or none.

use firmware::boards::{CanTiming, Clocks, Misfit, Needs, TickPeriod};
use firmware::{ConfigError, Field, Header, Links, Part, decode_into};
use static_cell::StaticCell;

use super::slots::{self, SLOTS};
use super::types::Settings;
use crate::here::{FACTS, SIDES};

const BAUD_WITHOUT_SCENE: u32 = 115_200;

#[derive(Clone, Copy)]
pub(crate) struct Pace {
    pub(crate) tick: TickPeriod,
    /// Counts of the byte timers from the start of a byte to that of the next.
    pub(crate) slot_counts: u16,
    pub(crate) bus: Option<CanTiming>,
}

impl Pace {
    /// `None`: the rate of the scene is none of theirs.
    pub(crate) fn of(clocks: &Clocks, settings: &Settings) -> Option<Self> {
        let tick_hz = settings.head.tick_hz;
        Some(Self {
            tick: clocks.tick(tick_hz)?,
            slot_counts: clocks.slot_counts(tick_hz, settings.sensor.rest_us)?,
            bus: match settings.head.bus.filter(|_| Part::Bus.is_built()) {
                Some(bus) => Some(clocks.can_timing(bus.kbit_s)?),
                None => None,
            },
        })
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Deployed {
    pub(crate) slot: usize,
    /// The CRC of the model that it was deployed with; 0: none.
    pub(crate) model: u32,
    pub(crate) bytes: &'static [u8],
    pub(crate) crc: u32,
}

pub(crate) struct Scene {
    pub(crate) settings: &'static mut Settings,
    /// Where it lies; `None`: there is none, and nothing moves.
    pub(crate) deployed: Option<Deployed>,
    /// Why a slot before it does not count.
    pub(crate) refused: [Option<ConfigError>; 2],
}

static SETTINGS: StaticCell<Settings> = StaticCell::new();

/// It can be done once.
#[inline(never)]
pub(crate) fn find() -> Option<Scene> {
    let settings = SETTINGS.try_init_with(Settings::still)?;
    let mut scene = Scene {
        settings,
        deployed: None,
        refused: [None; 2],
    };
    for slot in slots::newest_first() {
        let refused = match read(slot, scene.settings) {
            Ok(deployed) => {
                scene.deployed = Some(deployed);
                return Some(scene);
            }
            Err(error) => error,
        };
        if let Some(place) = scene.refused.get_mut(slot) {
            *place = Some(refused);
        }
    }
    if Part::TAKES_CONFIGURATIONS {
        still(scene.settings);
    } else {
        // Nor is there a link by which another could come.
        *scene.settings = Settings::still();
    }
    Some(scene)
}

#[cold]
#[inline(never)]
fn still(settings: &mut Settings) {
    *settings = Settings::still();
    settings.links = Links {
        has_rtt: Part::Rtt.is_built(),
        serial_baud: Part::Serial.is_built().then_some(BAUD_WITHOUT_SCENE),
        has_pins: false,
    };
}

fn read(slot: usize, settings: &mut Settings) -> Result<Deployed, ConfigError> {
    let place = SLOTS.get(slot).ok_or(ConfigError::Absent)?;
    let header = slots::header(place).ok_or_else(|| slots::no_header(place))?;
    let bytes = slots::config(place);
    decode_into(settings, bytes, FACTS.code)?;
    fits(settings)?;
    let crc = Header::of(bytes)?.crc;
    Ok(Deployed {
        slot,
        model: header.model,
        bytes,
        crc,
    })
}

fn fits(settings: &Settings) -> Result<(), ConfigError> {
    if !Part::TAKES_CONFIGURATIONS {
        return Ok(());
    }
    FACTS.fits(&Needs::of(settings)).map_err(Misfit::error)?;
    // As many as any board of a head, the first.
    if settings.head.of_node(0).len() > SIDES.len() {
        return Err(ConfigError::Room(Field::Sides));
    }
    let clocks = FACTS.clocks_of(settings.sensor.kind.is_slow());
    let pace = Pace::of(&clocks, settings);
    pace.map(drop).ok_or(ConfigError::Range(Field::TickHz))
}
