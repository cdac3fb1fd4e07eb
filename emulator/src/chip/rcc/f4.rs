//! RCC of the STM32F446 (RM0390, chapter 6).

use super::{
    BUS_TOO_FAST, Bus, CR, Clocks, HSE_HZ, HSEON, Layout, PLLON, Rcc, ahb_divider, core_hz, divider,
};
use crate::chip::fault::Fault;

const HSI_HZ: u64 = 16_000_000;

const PLLCFGR: u32 = 0x04;
const CFGR: u32 = 0x08;

const HSION: u32 = 1 << 0;

/// Flags of CSR: what caused the reset.
const RMVF: u32 = 1 << 24;
const BORRSTF: u32 = 1 << 25;
const PINRSTF: u32 = 1 << 26;
const PORRSTF: u32 = 1 << 27;
const SFTRSTF: u32 = 1 << 28;
const IWDGRSTF: u32 = 1 << 29;

pub(in crate::chip) static LAYOUT: Layout = Layout {
    kept: &[(CR, 0x83), (PLLCFGR, 0x2400_3010), (CFGR, 0)],
    switches: &[
        (HSION, HSION << 1),
        (HSEON, HSEON << 1),
        (PLLON, PLLON << 1),
    ],
    selection: (CFGR, 3, 2),
    resets: &[(Bus::Ahb, 0x10), (Bus::Apb1, 0x20), (Bus::Apb2, 0x24)],
    gates: &[
        (Bus::Ahb, 0x30, 0),
        (Bus::Apb1, 0x40, 0),
        (Bus::Apb2, 0x44, 0),
    ],
    csr: (0x74, RMVF),
    causes: [
        BORRSTF | PINRSTF | PORRSTF,
        PINRSTF | IWDGRSTF,
        PINRSTF,
        PINRSTF | SFTRSTF,
        PINRSTF | BORRSTF,
    ],
    security: Some(0x0C),
    clocks,
};

fn clocks(rcc: &Rcc) -> Result<Clocks, Fault> {
    let cfgr = rcc.kept(CFGR);
    let system_hz = core_hz(rcc, cfgr & 3, [HSION, HSEON, PLLON], HSI_HZ, pll_hz)?;
    let core_hz = system_hz / ahb_divider(cfgr >> 4)?;
    if core_hz > 180_000_000 {
        return Err(Fault::Clock("the core runs above 180 MHz"));
    }
    let (apb1, apb2) = (divider(cfgr >> 10), divider(cfgr >> 13));
    if core_hz / apb1 > 45_000_000 || core_hz / apb2 > 90_000_000 {
        return Err(BUS_TOO_FAST);
    }
    Ok(Clocks::new(core_hz, apb1, apb2))
}

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
