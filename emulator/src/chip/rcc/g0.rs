//! RCC of the STM32G071 (RM0444, chapter 5).

use super::{Bus, CR, HSE_HZ, HSEON, Layout, PLLON, Rcc};

const HSI_HZ: u64 = 16_000_000;

const CFGR: u32 = 0x08;
const PLLCFGR: u32 = 0x0C;

const HSION: u32 = 1 << 8;
const HSIRDY: u32 = 1 << 10;
/// A divider of the internal oscillator.
const HSIDIV: u32 = 7 << 11;

/// In PLLCFGR: the output towards the core is on.
const PLLREN: u32 = 1 << 28;

pub(in crate::chip) static LAYOUT: Layout = Layout {
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
};

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
