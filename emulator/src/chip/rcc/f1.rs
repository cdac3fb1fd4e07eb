//! RCC of the STM32F103 of medium density (RM0008, chapter 7).

use super::{Bus, CR, HSE_HZ, HSEON, HSION, Layout, Rcc, SWITCHES};

const HSI_HZ: u64 = 8_000_000;

const CFGR: u32 = 0x04;

/// In CFGR: the PLL's input is HSE, and that is halved.
const PLLSRC: u32 = 1 << 16;
const PLLXTPRE: u32 = 1 << 17;

pub(in crate::chip) static LAYOUT: Layout = Layout {
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
};

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
