//! RCC: the clock tree, clock gates and peripheral resets, and why the chip
//! was reset (RM0390, chapter 6).
//!
//! Oscillators and the PLL are ready at once. Frequencies are worked out from
//! the registers, so a wrong divider makes a wrong time everywhere.

use super::fault::Fault;
use super::reset::ResetCause;
use super::time::Ps;

/// The internal oscillator, Hz.
const HSI_HZ: u64 = 16_000_000;
/// What the ST-LINK feeds into the HSE input, Hz.
const HSE_HZ: u64 = 8_000_000;

const CR: u32 = 0x00;
const PLLCFGR: u32 = 0x04;
const CFGR: u32 = 0x08;
const AHB1RSTR: u32 = 0x10;
const APB1RSTR: u32 = 0x20;
const APB2RSTR: u32 = 0x24;
const AHB1ENR: u32 = 0x30;
const APB1ENR: u32 = 0x40;
const APB2ENR: u32 = 0x44;
const CSR: u32 = 0x74;

const HSION: u32 = 1 << 0;
const HSEON: u32 = 1 << 16;
const PLLON: u32 = 1 << 24;
/// Each ready flag stands one above its switch.
const SWITCHES: u32 = HSION | HSEON | PLLON;

/// Flags of CSR: what caused the reset.
const RMVF: u32 = 1 << 24;
const BORRSTF: u32 = 1 << 25;
const PINRSTF: u32 = 1 << 26;
const PORRSTF: u32 = 1 << 27;
const SFTRSTF: u32 = 1 << 28;
const IWDGRSTF: u32 = 1 << 29;

impl ResetCause {
    const fn flags(self) -> u32 {
        match self {
            Self::Power => BORRSTF | PINRSTF | PORRSTF,
            Self::Pin => PINRSTF,
            Self::Watchdog => PINRSTF | IWDGRSTF,
            Self::Software => PINRSTF | SFTRSTF,
        }
    }
}

/// A bus with gates and resets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bus {
    Ahb1,
    Apb1,
    Apb2,
}

/// Periods of the clocks that peripherals run by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Clocks {
    pub(super) core: Ps,
    pub(super) apb1_timer: Ps,
    pub(super) apb2_timer: Ps,
    pub(super) apb1: Ps,
    pub(super) apb2: Ps,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Rcc {
    cr: u32,
    pllcfgr: u32,
    cfgr: u32,
    resets: [u32; 3],
    gates: [u32; 3],
    csr: u32,
    /// Bits of reset registers that have just been set.
    pulsed: [u32; 3],
}

impl Rcc {
    pub(super) fn new() -> Self {
        Self {
            cr: 0x83,
            pllcfgr: 0x2400_3010,
            csr: ResetCause::Power.flags(),
            ..Self::default()
        }
    }

    /// As after a reset; the flags that tell why outlive it.
    pub(super) fn reset(&mut self, cause: ResetCause) {
        *self = Self {
            csr: self.csr | cause.flags(),
            ..Self::new()
        };
    }

    pub(super) fn is_clocked(&self, bus: Bus, bit: u32) -> bool {
        self.gates[bus as usize] & (1 << bit) != 0
    }

    /// Whether a peripheral is, or since the last call was, held in reset.
    pub(super) fn take_reset(&mut self, bus: Bus, bit: u32) -> bool {
        let mask = 1 << bit;
        let pulsed = self.pulsed[bus as usize] & mask != 0;
        self.pulsed[bus as usize] &= !mask;
        pulsed || self.resets[bus as usize] & mask != 0
    }

    /// Whether some peripheral has been reset since the last [`Self::take_reset`].
    pub(super) fn has_pulsed(&self) -> bool {
        self.pulsed != [0; 3]
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        Some(match offset {
            CR => self.cr | (self.cr & SWITCHES) << 1,
            PLLCFGR => self.pllcfgr,
            // The switch of the system clock has happened.
            CFGR => self.cfgr & !0xC | (self.cfgr & 3) << 2,
            AHB1RSTR => self.resets[0],
            APB1RSTR => self.resets[1],
            APB2RSTR => self.resets[2],
            AHB1ENR => self.gates[0],
            APB1ENR => self.gates[1],
            APB2ENR => self.gates[2],
            CSR => self.csr,
            _ => return None,
        })
    }

    /// Whether the register is modelled.
    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        match offset {
            CR => self.cr = value & !(SWITCHES << 1),
            PLLCFGR => self.pllcfgr = value,
            CFGR => self.cfgr = value,
            AHB1RSTR => self.set_resets(0, value),
            APB1RSTR => self.set_resets(1, value),
            APB2RSTR => self.set_resets(2, value),
            AHB1ENR => self.gates[0] = value,
            APB1ENR => self.gates[1] = value,
            APB2ENR => self.gates[2] = value,
            CSR if value & RMVF != 0 => self.csr = 0,
            CSR => {}
            _ => return false,
        }
        true
    }

    fn set_resets(&mut self, bus: usize, value: u32) {
        self.resets[bus] = value;
        self.pulsed[bus] |= value;
    }

    /// The clocks that the registers make.
    ///
    /// # Errors
    /// [`Fault::Clock`] if the system clock is switched to one that does not
    /// run or is out of the chip's range.
    pub(super) fn clocks(&self) -> Result<Clocks, Fault> {
        let running = |switch: u32| (self.cr & switch != 0).then_some(());
        let core_hz = match self.cfgr & 3 {
            0 => running(HSION).map(|()| HSI_HZ),
            1 => running(HSEON).map(|()| HSE_HZ),
            2 => running(PLLON).and_then(|()| self.pll_hz()),
            _ => None,
        };
        let core_hz = core_hz.ok_or(Fault::Clock("the system clock does not run"))?;
        if self.cfgr & 0xF0 != 0 {
            return Err(Fault::Clock("an AHB divider is not modelled"));
        }
        if core_hz > 180_000_000 {
            return Err(Fault::Clock("the core runs above 180 MHz"));
        }
        let divider = |shift: u32| match (self.cfgr >> shift) & 7 {
            bits @ 4..=7 => 2 << (bits - 4),
            _ => 1,
        };
        let (apb1, apb2) = (divider(10), divider(13));
        if core_hz / apb1 > 45_000_000 || core_hz / apb2 > 90_000_000 {
            return Err(Fault::Clock("a peripheral bus runs too fast"));
        }
        let period = |hz: u64| 1_000_000_000_000 / hz;
        // A timer runs at twice its bus unless that is undivided.
        let timer = |divider: u64| period(core_hz / divider * if divider > 1 { 2 } else { 1 });
        Ok(Clocks {
            core: period(core_hz),
            apb1_timer: timer(apb1),
            apb2_timer: timer(apb2),
            apb1: period(core_hz / apb1),
            apb2: period(core_hz / apb2),
        })
    }

    fn pll_hz(&self) -> Option<u64> {
        let field = |shift: u32, mask: u32| u64::from((self.pllcfgr >> shift) & mask);
        let (m, n, p) = (field(0, 0x3F), field(6, 0x1FF), 2 * field(16, 3) + 2);
        let hse = field(22, 1) == 1;
        let running = self.cr & if hse { HSEON } else { HSION } != 0;
        let input = if hse { HSE_HZ } else { HSI_HZ }.checked_div(m)?;
        let oscillator = input * n;
        let in_range = (950_000..=2_100_000).contains(&input)
            && (100_000_000..=432_000_000).contains(&oscillator);
        (running && in_range).then(|| oscillator / p)
    }
}
