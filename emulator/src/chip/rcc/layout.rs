//! RCC of each chip: STM32F103 of medium density (RM0008, chapter 7), STM32F446 (RM0390, chapter 6),
//! STM32G071 (RM0444, chapter 5).

use super::{Bus, CR, HSE_HZ, HSEON, PLLON, Rcc};

#[derive(Debug)]
pub(in crate::chip) struct Layout {
    /// Registers that keep what is written, and their values after a reset; CR first.
    pub(super) kept: &'static [(u32, u32)],
    /// In CR: switches of HSI, HSE and the PLL, as they are selected, and their ready flags.
    pub(super) switches: &'static [(u32, u32)],
    /// The register that selects the system clock, the mask of the selection, and how far
    /// above stands what is selected.
    pub(super) selection: (u32, u32, u32),
    pub(super) resets: &'static [(Bus, u32)],
    /// Registers of clock gates, and their values after a reset.
    pub(super) gates: &'static [(Bus, u32, u32)],
    /// The register of the causes of a reset, and the bit that clears them.
    pub(super) csr: (u32, u32),
    /// The flag of a brown-out, which the supply sets too as it comes, where there is one.
    pub(super) brown_out: Option<u32>,
    /// Where the clock security system tells of its interrupt, and is answered; nothing where
    /// it is not used.
    pub(super) security: Option<u32>,
    pub(super) hsi_hz: u64,
    /// In CR: a divider of HSI, which is not modelled.
    pub(super) hsi_divider: u32,
    /// Of the PLL, if it runs.
    pub(super) pll_hz: fn(&Rcc) -> Option<u64>,
    /// The core's highest clock, Hz, and what a higher one is called.
    pub(super) most: (u64, &'static str),
    /// Where the register that selects has what divides the core's clock.
    pub(super) ahb: u32,
    /// Likewise of both peripheral buses, with their highest clocks, Hz.
    pub(super) apb: [(u32, u64); 2],
}

/// On the STM32F1 and F4, with the switches there and their ready flags.
const HSION: u32 = 1 << 0;
const SWITCHES: [(u32, u32); 3] = [
    (HSION, HSION << 1),
    (HSEON, HSEON << 1),
    (PLLON, PLLON << 1),
];

pub(in crate::chip) static F1: Layout = {
    const HSI_HZ: u64 = 8_000_000;

    const CFGR: u32 = 0x04;

    /// In CFGR: the PLL's input is HSE, and that is halved.
    const PLLSRC: u32 = 1 << 16;
    const PLLXTPRE: u32 = 1 << 17;

    fn pll_hz(rcc: &Rcc) -> Option<u64> {
        let cfgr = rcc.kept(CFGR);
        let hse = cfgr & PLLSRC != 0;
        let runs = rcc.running() & if hse { HSEON } else { HSION } != 0;
        let input = match (hse, cfgr & PLLXTPRE != 0) {
            (true, false) => HSE_HZ,
            (true, true) => HSE_HZ / 2,
            (false, _) => HSI_HZ / 2,
        };
        // 2 to 16; the last code means 16, too.
        let times = u64::from((cfgr >> 18) & 15) + 2;
        runs.then(|| input * times.min(16))
    }

    Layout {
        kept: &[(CR, 0x83), (CFGR, 0)],
        switches: &SWITCHES,
        selection: (CFGR, 3, 2),
        resets: &[(Bus::Apb2, 0x0C), (Bus::Apb1, 0x10)],
        gates: &[
            (Bus::Ahb, 0x14, 0x14),
            (Bus::Apb2, 0x18, 0),
            (Bus::Apb1, 0x1C, 0),
        ],
        csr: (0x24, 1 << 24),
        brown_out: None,
        security: Some(0x08),
        hsi_hz: HSI_HZ,
        hsi_divider: 0,
        pll_hz,
        most: (72_000_000, "the core runs above 72 MHz"),
        ahb: 4,
        apb: [(8, 36_000_000), (11, 72_000_000)],
    }
};

pub(in crate::chip) static F4: Layout = {
    const HSI_HZ: u64 = 16_000_000;

    const PLLCFGR: u32 = 0x04;
    const CFGR: u32 = 0x08;

    fn pll_hz(rcc: &Rcc) -> Option<u64> {
        let field = |shift: u32, mask: u32| u64::from((rcc.kept(PLLCFGR) >> shift) & mask);
        let (m, n, p) = (field(0, 0x3F), field(6, 0x1FF), 2 * field(16, 3) + 2);
        let hse = field(22, 1) == 1;
        let runs = rcc.running() & if hse { HSEON } else { HSION } != 0;
        let input = if hse { HSE_HZ } else { HSI_HZ }.checked_div(m)?;
        let oscillator = input * n;
        let in_range = (950_000..=2_100_000).contains(&input)
            && (100_000_000..=432_000_000).contains(&oscillator);
        (runs && in_range).then(|| oscillator / p)
    }

    Layout {
        kept: &[(CR, 0x83), (PLLCFGR, 0x2400_3010), (CFGR, 0)],
        switches: &SWITCHES,
        selection: (CFGR, 3, 2),
        resets: &[(Bus::Ahb, 0x10), (Bus::Apb1, 0x20), (Bus::Apb2, 0x24)],
        gates: &[
            (Bus::Ahb, 0x30, 0),
            (Bus::Apb1, 0x40, 0),
            (Bus::Apb2, 0x44, 0),
        ],
        csr: (0x74, 1 << 24),
        brown_out: Some(1 << 25),
        security: Some(0x0C),
        hsi_hz: HSI_HZ,
        hsi_divider: 0,
        pll_hz,
        most: (180_000_000, "the core runs above 180 MHz"),
        ahb: 4,
        apb: [(10, 45_000_000), (13, 90_000_000)],
    }
};

pub(in crate::chip) static G0: Layout = {
    const HSI_HZ: u64 = 16_000_000;

    const CFGR: u32 = 0x08;
    const PLLCFGR: u32 = 0x0C;

    const HSION: u32 = 1 << 8;
    const HSIRDY: u32 = 1 << 10;
    const HSIDIV: u32 = 7 << 11;

    /// In PLLCFGR: the output towards the core is on.
    const PLLREN: u32 = 1 << 28;

    fn pll_hz(rcc: &Rcc) -> Option<u64> {
        let pllcfgr = rcc.kept(PLLCFGR);
        let field = |shift: u32, mask: u32| u64::from((pllcfgr >> shift) & mask);
        let (m, n, r) = (field(4, 7) + 1, field(8, 0x7F), field(29, 7) + 1);
        let (switch, source) = match field(0, 3) {
            2 => (HSION, HSI_HZ),
            3 => (HSEON, HSE_HZ),
            _ => return None,
        };
        let input = source / m;
        let oscillator = input * n;
        // At the supply's range 1, in which the chip is after a reset.
        let in_range = (2_660_000..=16_000_000).contains(&input)
            && (96_000_000..=344_000_000).contains(&oscillator)
            && (8..=86).contains(&n)
            && r >= 2;
        let runs = rcc.running() & switch != 0 && pllcfgr & PLLREN != 0;
        (runs && in_range).then(|| oscillator / r)
    }

    Layout {
        kept: &[(CR, 0x500), (CFGR, 0), (PLLCFGR, 0x1000)],
        switches: &[(HSION, HSIRDY), (HSEON, HSEON << 1), (PLLON, PLLON << 1)],
        selection: (CFGR, 7, 3),
        resets: &[
            (Bus::Ports, 0x24),
            (Bus::Ahb, 0x28),
            (Bus::Apb1, 0x2C),
            (Bus::Apb2, 0x30),
        ],
        gates: &[
            (Bus::Ports, 0x34, 0),
            (Bus::Ahb, 0x38, 0x100),
            (Bus::Apb1, 0x3C, 0),
            (Bus::Apb2, 0x40, 0),
        ],
        csr: (0x60, 1 << 23),
        brown_out: None,
        security: None,
        hsi_hz: HSI_HZ,
        hsi_divider: HSIDIV,
        pll_hz,
        most: (64_000_000, "the core runs above 64 MHz"),
        ahb: 8,
        // One peripheral bus, with two registers of gates.
        apb: [(12, 64_000_000); 2],
    }
};
