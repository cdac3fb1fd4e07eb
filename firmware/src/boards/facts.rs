//! The boards.

use super::{Clocks, FlashMap, Region, Slot};
use crate::BoardCode;
#[cfg(doc)]
use crate::Part;

/// What a board's program can do on the bus of a head.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InHead {
    /// Nothing: its chip has no CAN.
    Never,
    /// It whisks, feels and moves; its RAM has no room for a classifier, nor to take another
    /// configuration while it runs ([`Part::Set`]).
    Untuned,
    /// All.
    Tuned,
}

/// A board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoardFacts {
    /// What messages call it.
    pub name: &'static str,
    /// Its number in a configuration.
    pub code: BoardCode,
    /// With the core's clock as it is; [halved](Clocks::halved) for slow sensors.
    pub clocks: Clocks,
    /// The same where it runs by the chip's oscillator, as no clock comes from outside.
    pub clocks_internal: Clocks,
    /// Whether its core computes f32 by itself.
    pub has_fpu: bool,
    /// Most classes of a model.
    pub max_classes: usize,
    /// In how many poses a model with a second opinion was trained at most, of one whisker that
    /// decides: each makes the tick of a decision longer. By `cargo xtask emulate --deadlines`
    /// that of the NUCLEO-G071RB takes 24,000 of 32,000 cycles with one, of the NUCLEO-F103RB
    /// 26,000 of 36,000 with four, and 56,000 of 72,000 with twelve of the NUCLEO-F446RE.
    pub max_poses: usize,
    /// Whether a program whose model is deployed has room for what a second opinion keeps, beside
    /// the links. One with such a model linked has.
    pub awaits_opinion: bool,
    /// Most sides, of one whisker each.
    pub max_sides: u8,
    /// Whether it can be one of a head.
    pub in_head: InHead,
    /// What lies where in its flash.
    pub flash: FlashMap,
}

/// Every board.
pub const ALL: [BoardFacts; 3] = [NUCLEO_F446RE, NUCLEO_F103RB, NUCLEO_G071RB];

impl BoardFacts {
    /// The board of a number.
    pub fn of(code: BoardCode) -> Option<&'static Self> {
        ALL.iter().find(|board| board.code == code)
    }

    /// [`Self::max_poses`] where so many of its whiskers decide, which may be in the same tick.
    pub const fn poses_of_each(&self, deciding: usize) -> usize {
        self.max_poses / if deciding == 0 { 1 } else { deciding }
    }
}

const KIB: u32 = 1024;

/// Timers count at twice the clock of their bus.
const F446_CLOCKS: Clocks = Clocks {
    core_hz: 144_000_000,
    spi_hz: 72_000_000 / 256,
    byte_timer_hz: 72_000_000,
    tick_timer_hz: 72_000_000,
    counter_hz: 72_000_000,
    pwm_hz: 144_000_000,
    serial_hz: 36_000_000,
    watchdog_hz: [17_000, 32_000, 47_000],
}
.checked();

/// STM32F446RE, Cortex-M4F at 144 MHz. Halved, its SPI clock is just under the limit of a sensor in
/// its slow mode, and the supply needs no over-drive, as at the chip's 180 MHz it would.
pub const NUCLEO_F446RE: BoardFacts = BoardFacts {
    name: "NUCLEO-F446RE",
    code: BoardCode::NucleoF446re,
    clocks: F446_CLOCKS,
    clocks_internal: F446_CLOCKS,
    has_fpu: true,
    // Two tables of 24 by 24 bins then take 36 KiB of the 124 KiB for a model.
    max_classes: 16,
    max_poses: 12,
    awaits_opinion: true,
    max_sides: 2,
    in_head: InHead::Tuned,
    // Sectors 0 to 5, 6, 7 (RM0390, flash module organization).
    flash: FlashMap {
        program: Region::new(0x0800_0000, 256 * KIB),
        slots: [
            Slot::sector(Region::new(0x0804_0000, 128 * KIB)),
            Slot::sector(Region::new(0x0806_0000, 128 * KIB)),
        ],
    },
};

/// Of both chips with 128 KiB: pages of 1 or 2 KiB.
const SMALL_FLASH: FlashMap = FlashMap {
    program: Region::new(0x0800_0000, 104 * KIB),
    slots: [
        Slot::pages(Region::new(0x0801_A000, 2 * KIB), SMALL_MODEL),
        Slot::pages(Region::new(0x0801_A800, 2 * KIB), SMALL_MODEL),
    ],
};
const SMALL_MODEL: Region = Region::new(0x0801_B000, 20 * KIB);

/// Two tables of 24 by 24 bins then take 13.5 KiB of the 20 KiB for a model.
const SMALL_CLASSES: usize = 6;

/// APB1 is half of the core's clock, and timers on it count at twice that; APB2 is not divided.
const F103_CLOCKS: Clocks = f103(72_000_000);

const fn f103(core_hz: u32) -> Clocks {
    Clocks {
        serial_hz: core_hz / 2,
        ..Clocks::undivided(core_hz, [30_000, 40_000, 60_000])
    }
    .checked()
}

/// The most that its PLL makes of its own 8 MHz.
const F103_INTERNAL: Clocks = f103(64_000_000);

/// STM32F103RB, Cortex-M3 at 72 MHz.
pub const NUCLEO_F103RB: BoardFacts = BoardFacts {
    name: "NUCLEO-F103RB",
    code: BoardCode::NucleoF103rb,
    clocks: F103_CLOCKS,
    clocks_internal: F103_INTERNAL,
    has_fpu: false,
    max_classes: SMALL_CLASSES,
    max_poses: 4,
    awaits_opinion: false,
    max_sides: 1,
    in_head: InHead::Untuned,
    flash: SMALL_FLASH,
};

const G071_CLOCKS: Clocks = Clocks::undivided(64_000_000, [29_500, 32_000, 34_000]).checked();

/// STM32G071RB, Cortex-M0+ at 64 MHz. No bus is divided.
pub const NUCLEO_G071RB: BoardFacts = BoardFacts {
    name: "NUCLEO-G071RB",
    code: BoardCode::NucleoG071rb,
    clocks: G071_CLOCKS,
    clocks_internal: G071_CLOCKS,
    has_fpu: false,
    max_classes: SMALL_CLASSES,
    max_poses: 1,
    awaits_opinion: true,
    max_sides: 1,
    in_head: InHead::Never,
    flash: SMALL_FLASH,
};

#[cfg(test)]
mod tests {
    use super::{ALL, BoardFacts, NUCLEO_F103RB, NUCLEO_F446RE, NUCLEO_G071RB};
    use crate::CONFIG_BYTES;
    use crate::boards::flash::MODEL_OFFSET;

    #[test]
    fn slots_have_room_and_nothing_overlaps() {
        for board in ALL {
            let [a, b] = board.flash.slots;
            assert_eq!(board.flash.program.end(), a.erased.start);
            assert_eq!(a.erased.end(), b.erased.start);
            for slot in [a, b] {
                assert!(slot.erased.contains(slot.head));
                // Two whiskers at most, see `CONFIG_BYTES` of a board.
                assert!(slot.config().bytes >= 1536 && CONFIG_BYTES >= 1536);
                assert!(
                    slot.model.start.is_multiple_of(8) && slot.config().start.is_multiple_of(8)
                );
                assert!(slot.has_model() || slot.model.start == b.erased.end());
            }
            assert_eq!(a.has_model(), a.model != b.model);
        }
    }

    /// The number of a line `NAME = NUMBER;`, or the two of `NAME : ORIGIN = .., LENGTH = ..`.
    fn numbers(map: &str, name: &str) -> Vec<u32> {
        let number = |text: &str| {
            let text = text.trim().trim_end_matches([';', ',']);
            let (digits, factor) = match text.strip_suffix('K') {
                Some(digits) => (digits, 1024),
                None => (text, 1),
            };
            let found = match digits.strip_prefix("0x") {
                Some(digits) => u32::from_str_radix(digits, 16),
                None => digits.parse(),
            };
            found.ok().map(|found| found * factor)
        };
        let line = map.lines().find(|line| line.trim_start().starts_with(name));
        let line = line.unwrap_or_else(|| panic!("no {name}"));
        let values = line.split('=').skip(1);
        let values = values.filter_map(|value| number(value.split([',', ';']).next()?));
        values.collect()
    }

    #[test]
    fn the_linker_knows_the_same_flash() {
        let maps: [(BoardFacts, &str); 3] = [
            (NUCLEO_F446RE, include_str!("../board/nucleo_f446re.x")),
            (NUCLEO_F103RB, include_str!("../board/nucleo_f103rb.x")),
            (NUCLEO_G071RB, include_str!("../board/nucleo_g071rb.x")),
        ];
        for (board, map) in maps {
            let [a, b] = board.flash.slots;
            let offset = if a.has_model() { MODEL_OFFSET } else { 0 };
            let mut regions = vec![
                ("FLASH", board.flash.program),
                ("SLOT_A", a.erased),
                ("SLOT_B", b.erased),
            ];
            if !a.has_model() {
                regions.push(("MODEL", a.model));
            }
            for (name, region) in regions {
                assert_eq!(numbers(map, name), [region.start, region.bytes], "{name}");
            }
            assert_eq!(numbers(map, "_model_offset"), [offset], "{}", board.name);
            assert_eq!(numbers(map, "_model_classes"), [board.max_classes as u32]);
        }
    }
}
