//! RCC of the STM32F446 (RM0390, chapter 6).

use super::{Bus, CR, HSE_HZ, HSEON, HSION, Layout, Rcc, SWITCHES};

const HSI_HZ: u64 = 16_000_000;

const PLLCFGR: u32 = 0x04;
const CFGR: u32 = 0x08;

pub(in crate::chip) static LAYOUT: Layout = Layout {
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
};

fn pll_hz(rcc: &Rcc) -> Option<u64> {
    let field = |shift: u32, mask: u32| u64::from((rcc.kept(PLLCFGR) >> shift) & mask);
    let (m, n, p) = (field(0, 0x3F), field(6, 0x1FF), 2 * field(16, 3) + 2);
    let hse = field(22, 1) == 1;
    let runs = rcc.running() & if hse { HSEON } else { HSION } != 0;
    let input = if hse { HSE_HZ } else { HSI_HZ }.checked_div(m)?;
    let oscillator = input * n;
    let in_range =
        (950_000..=2_100_000).contains(&input) && (100_000_000..=432_000_000).contains(&oscillator);
    (runs && in_range).then(|| oscillator / p)
}
