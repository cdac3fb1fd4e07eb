//! The brown-out level of an STM32F446, which its option bytes hold: raised to where the chip is
//! reset before its supply falls below what its clock needs (RM0390, "Embedded flash memory
//! interface": "Programming user option bytes" and the registers FLASH_OPTKEYR, FLASH_SR,
//! FLASH_OPTCR). Registers and bits are those of stm32-metapac 21 for this chip, keys and addresses
//! those of ARM's flash algorithm for its option bytes (STM32F4xx_OPT).

use host_sim::Error;

/// Where option bytes are unlocked, by these two words; another word locks them until a reset.
const OPTION_KEY: u32 = 0x4002_3C08;
const KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];

/// The status, and its bit while the flash erases or programs.
const STATUS: u32 = 0x4002_3C0C;
const BUSY: u32 = 1 << 16;

/// The option bytes: after a reset as the flash holds them, once unlocked as they are to be.
pub(super) const OPTIONS: u32 = 0x4002_3C14;
const LOCK: u32 = 1 << 0;
const START: u32 = 1 << 1;
/// BOR_LEV: 0 is level 3, 2.75 V or more; 3, as delivered, is none.
const LEVEL: u32 = 3 << 2;
const PROTECTION_SHIFT: u32 = 8;
/// Read-out protection of level 0, none.
const UNPROTECTED: u32 = 0xAA;
/// SPRMOD: nWRP protects sectors from being read, and its bits mean the opposite.
const PROTECTS_READING: u32 = 1 << 31;

/// The registers of a chip whose core is halted.
pub(super) trait Words {
    fn read_word(&mut self, at: u32) -> Result<u32, Error>;
    fn write_word(&mut self, at: u32, word: u32) -> Result<(), Error>;
}

#[derive(Debug, PartialEq, Eq)]
pub(super) enum Level {
    WasHigh,
    /// It is high from the next reset on, which [loads](is_loaded) these option bytes.
    Raised(u32),
    /// It is low and stays so, for this reason.
    Kept(&'static str),
}

/// Raises it where it is low and the chip is not protected; the other option bytes stay as they
/// are. `in_time` says whether to wait on for the flash.
///
/// The flash erases and programs all option bytes by itself once it has begun: until then an
/// error leaves them as they were. A supply that is lost meanwhile may leave read-out
/// protection of level 1, from which ST's programmer frees a chip by erasing it; level 2, which is
/// for ever, has zeros where the byte that is programmed, 0xAA, has ones.
pub(super) fn raise(
    chip: &mut impl Words,
    mut in_time: impl FnMut() -> bool,
) -> Result<Level, Error> {
    let before = chip.read_word(OPTIONS)?;
    if before & LEVEL == 0 {
        return Ok(Level::WasHigh);
    }
    if before >> PROTECTION_SHIFT & 0xFF != UNPROTECTED {
        return Ok(Level::Kept("the chip is protected from being read (RDP)"));
    }
    if before & PROTECTS_READING != 0 {
        return Ok(Level::Kept(
            "sectors of its flash are protected from being read (SPRMOD)",
        ));
    }
    let mut wait = |chip: &mut _, otherwise: &str| {
        while Words::read_word(chip, STATUS)? & BUSY != 0 {
            if !in_time() {
                return Err(failed(otherwise));
            }
        }
        Ok(())
    };
    wait(chip, "the flash is busy; the option bytes are as they were")?;
    if before & LOCK != 0 {
        for key in KEYS {
            chip.write_word(OPTION_KEY, key)?;
        }
    }
    let wanted = before & !(LEVEL | LOCK | START);
    chip.write_word(OPTIONS, wanted)?;
    if chip.read_word(OPTIONS)? != wanted {
        // Unlocked they must not stay.
        chip.write_word(OPTIONS, before | LOCK)?;
        return Err(failed(
            "they stay locked; the option bytes are as they were",
        ));
    }
    chip.write_word(OPTIONS, wanted | START)?;
    wait(
        chip,
        "the flash is still busy with them: leave the supply on for a minute",
    )?;
    chip.write_word(OPTIONS, wanted | LOCK)?;
    Ok(Level::Raised(wanted))
}

/// Whether a chip that was reset has these option bytes from its flash.
pub(super) fn is_loaded(options: u32, wanted: u32) -> Result<(), Error> {
    if (options ^ wanted) & !(LOCK | START) == 0 {
        return Ok(());
    }
    Err(failed(&format!(
        "wrote {wanted:#010x}, and the chip has {options:#010x}"
    )))
}

fn failed(why: &str) -> Error {
    Error::Work(format!(
        "the program is flashed, but the brown-out level is not raised: {why}; flash again, or \
         with --keep-brown-out"
    ))
}

#[cfg(test)]
mod tests {
    use host_sim::Error;

    use super::{Level, Words, is_loaded, raise};

    /// An F446's option bytes as delivered (RM0390, FLASH_OPTCR: reset value), and with brown-out
    /// level 3.
    const DELIVERED: u32 = 0x0FFF_AAED;
    const RAISED: u32 = 0x0FFF_AAE1;

    /// The option bytes' part of the flash, written from RM0390: a wrong key locks it until a
    /// reset, the keys in order unlock it; locked or busy it takes nothing; the start bit programs
    /// all option bytes, in some time.
    struct Flash {
        stored: u32,
        options: u32,
        keys: Option<usize>,
        /// For how many looks it is still busy.
        busy: usize,
        takes: usize,
        writes: usize,
        /// How many accesses the probe still answers.
        answers: usize,
    }

    impl Flash {
        fn of(stored: u32) -> Self {
            Self {
                stored,
                options: stored | 1,
                keys: Some(0),
                busy: 0,
                takes: 3,
                writes: 0,
                answers: usize::MAX,
            }
        }

        fn answer(&mut self) -> Result<(), Error> {
            let left = self.answers.checked_sub(1);
            self.answers = left.ok_or_else(|| Error::Work("unplugged".to_owned()))?;
            Ok(())
        }

        /// What the next reset loads, once it is done with what it has begun.
        fn reset(&mut self) -> u32 {
            *self = Self::of(self.stored);
            self.options
        }
    }

    impl Words for Flash {
        fn read_word(&mut self, at: u32) -> Result<u32, Error> {
            self.answer()?;
            match at {
                0x4002_3C0C => {
                    let is_busy = self.busy > 0;
                    self.busy = self.busy.saturating_sub(1);
                    Ok(u32::from(is_busy) << 16)
                }
                0x4002_3C14 => Ok(self.options),
                _ => panic!("{at:#x} is read"),
            }
        }

        fn write_word(&mut self, at: u32, word: u32) -> Result<(), Error> {
            self.answer()?;
            self.writes += 1;
            assert_eq!(self.busy, 0, "written while busy");
            match (at, self.keys, word) {
                (0x4002_3C08, Some(0), 0x0819_2A3B) => self.keys = Some(1),
                (0x4002_3C08, Some(1), 0x4C5D_6E7F) => {
                    self.keys = Some(0);
                    self.options &= !1;
                }
                (0x4002_3C08, ..) => {
                    self.keys = None;
                    self.options |= 1;
                }
                (0x4002_3C14, ..) if self.options & 1 != 0 => {}
                (0x4002_3C14, ..) => {
                    self.options = word & !2;
                    if word & 2 != 0 {
                        self.stored = word & !3 | self.stored & 3;
                        self.busy = self.takes;
                    }
                }
                _ => panic!("{at:#x} is written"),
            }
            Ok(())
        }
    }

    #[test]
    fn the_level_is_raised_and_every_other_bit_stays() {
        for others in [0, 1 << 5, 0xE0, 1 << 16, 0x5A << 16] {
            for level in 1..4 {
                let stored = (DELIVERED ^ others) & !0xC | level << 2;
                let mut flash = Flash::of(stored);
                let Ok(Level::Raised(wanted)) = raise(&mut flash, || true) else {
                    panic!("{stored:#x} stays");
                };
                assert_eq!(flash.options & 1, 1, "it is locked again");
                let loaded = flash.reset();
                assert_eq!(loaded, RAISED ^ others, "{stored:#x}");
                assert!(is_loaded(loaded, wanted).is_ok());
                assert!(is_loaded(stored, wanted).is_err());
                assert_eq!(raise(&mut flash, || true).unwrap(), Level::WasHigh);
                assert_eq!(flash.writes, 0, "it is written once");
            }
        }
    }

    #[test]
    fn a_chip_that_is_protected_keeps_its_option_bytes() {
        for (stored, by) in [
            (DELIVERED & !0xFF00 | 0x5500, "RDP"),
            (DELIVERED & !0xFF00 | 0xCC00, "RDP"),
            (DELIVERED | 1 << 31, "SPRMOD"),
        ] {
            let mut flash = Flash::of(stored);
            let Ok(Level::Kept(why)) = raise(&mut flash, || true) else {
                panic!("{stored:#x} is written");
            };
            assert!(why.contains(by), "{why}");
            assert_eq!(flash.writes, 0);
        }
    }

    #[test]
    fn a_flash_that_is_busy_or_stays_locked_keeps_its_option_bytes() {
        let mut busy = Flash::of(DELIVERED);
        busy.busy = usize::MAX;
        let mut looks = 0..5;
        let refusal = raise(&mut busy, || looks.next().is_some()).unwrap_err();
        assert!(refusal.to_string().contains("as they were"), "{refusal}");
        assert_eq!(busy.writes, 0);

        // Whoever gave it a wrong key before.
        let mut locked = Flash::of(DELIVERED);
        locked.keys = None;
        let refusal = raise(&mut locked, || true).unwrap_err();
        assert!(refusal.to_string().contains("stay locked"), "{refusal}");
        assert_eq!(locked.reset(), DELIVERED);
    }

    #[test]
    fn a_flash_that_does_not_end_is_an_error_and_left_alone() {
        let mut flash = Flash::of(DELIVERED);
        flash.takes = usize::MAX;
        let refusal = raise(&mut flash, || false).unwrap_err();
        assert!(refusal.to_string().contains("leave the supply"));
        // Two keys, the bytes, the start.
        assert_eq!(flash.writes, 4);
    }

    #[test]
    fn a_probe_that_is_lost_leaves_the_old_bytes_or_the_new() {
        let mut ends = Vec::new();
        for answers in 0.. {
            let mut flash = Flash::of(DELIVERED);
            flash.answers = answers;
            let done = raise(&mut flash, || true);
            ends.push(flash.reset());
            if done.is_ok() {
                break;
            }
        }
        let new = ends.iter().position(|end| *end == RAISED).unwrap();
        assert!(ends[..new].iter().all(|end| *end == DELIVERED));
        assert!(ends[new..].iter().all(|end| *end == RAISED));
        assert!(
            new >= 7,
            "options, status, two keys, bytes, compared, start"
        );
    }
}
