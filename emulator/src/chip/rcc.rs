//! RCC: the clock tree, clock gates and peripheral resets, and why the chip
//! was reset. What differs between the chips is in [`layout`].
//!
//! Oscillators and the PLL are ready at once. Frequencies are worked out from
//! the registers, so a wrong divider makes a wrong time everywhere.

mod layout;

pub(super) use layout::{F1, F4, G0, Layout};

use super::fields::{Field, field};
use super::{Fault, Ps, ResetCause};

/// What the ST-LINK feeds into the HSE input, Hz.
const HSE_HZ: u64 = 8_000_000;

/// The control register, in which the oscillators have their switches.
const CR: u32 = 0x00;
/// In it, on every chip: the clock security system, HSE and the PLL are on.
const CSSON: u32 = 1 << 19;
const HSEON: u32 = 1 << 16;
const PLLON: u32 = 1 << 24;
/// In the register of clock interrupts: HSE has failed, and that is cleared.
const CSSF: u32 = 1 << 7;
const CSSC: u32 = 1 << 23;

/// In CSR, on every chip: what caused the reset.
const PINRSTF: u32 = 1 << 26;
const PORRSTF: u32 = 1 << 27;
const SFTRSTF: u32 = 1 << 28;
const IWDGRSTF: u32 = 1 << 29;

/// A register with gates, and one with resets, of peripherals: named for the bus or, with
/// several buses of one clock, for the register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bus {
    Ahb,
    Apb1,
    Apb2,
    /// The ports, where they have a bus of their own.
    Ports,
}

const BUSES: usize = 4;

/// Periods of the clocks that the core and, by their bus, peripherals and timers run by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Clocks {
    pub(super) core: Ps,
    buses: [Ps; BUSES],
    timers: [Ps; BUSES],
}

/// The period of a clock to the nearest picosecond: 8e-6 too long at 72 MHz, 64e-6 too short at 144.
const fn period(hz: u64) -> Ps {
    (1_000_000_000_000 + hz / 2) / hz
}

/// What timers count: twice the clock of their bus unless that is undivided.
const fn timer(core_hz: u64, divider: u64) -> Ps {
    period(if divider > 1 {
        core_hz * 2 / divider
    } else {
        core_hz
    })
}

impl Clocks {
    /// From the core's clock and what divides it for the buses. Each is rounded by itself, lest
    /// timers have the error of the core's.
    const fn new(core_hz: u64, apb1: u64, apb2: u64) -> Self {
        let core = period(core_hz);
        let [slow, fast] = [period(core_hz / apb1), period(core_hz / apb2)];
        Self {
            core,
            buses: [core, slow, fast, core],
            timers: [core, timer(core_hz, apb1), timer(core_hz, apb2), core],
        }
    }

    pub(super) const fn bus(&self, bus: Bus) -> Ps {
        self.buses[bus as usize]
    }

    pub(super) const fn timer(&self, bus: Bus) -> Ps {
        self.timers[bus as usize]
    }
}

/// What a bus is divided by, from the three bits of PPRE: it, 2, 4, 8 or 16.
const fn divider(bits: u32) -> u64 {
    match bits & 7 {
        bits @ 4..=7 => 2 << (bits - 4),
        _ => 1,
    }
}

/// Switches and ready flags of oscillators and PLL, in the order of [`Layout::switches`].
const SWITCH_NAMES: [[&str; 2]; 3] = [
    ["HSION", "HSIRDY"],
    ["HSEON", "HSERDY"],
    ["PLLON", "PLLRDY"],
];

impl Layout {
    /// The flags of a cause. Each reset pulls the pin low.
    fn flags(&self, cause: ResetCause) -> u32 {
        let brown_out = self.brown_out.unwrap_or(PORRSTF);
        PINRSTF
            | match cause {
                ResetCause::Power => PORRSTF | brown_out,
                ResetCause::Watchdog => IWDGRSTF,
                ResetCause::Pin => 0,
                ResetCause::Software => SFTRSTF,
                ResetCause::BrownOut => brown_out,
            }
    }

    pub(super) fn gate(&self, bus: Bus) -> Option<u32> {
        let mut gates = self.gates.iter();
        gates.find(|gate| gate.0 == bus).map(|gate| gate.1)
    }

    pub(super) fn reset(&self, bus: Bus) -> Option<u32> {
        let mut resets = self.resets.iter();
        resets.find(|reset| reset.0 == bus).map(|reset| reset.1)
    }

    pub(super) fn fields(&self) -> Vec<Field> {
        let (cfgr, mask, above) = self.selection;
        let (csr, clear) = self.csr;
        let switches = self.switches.iter().zip(SWITCH_NAMES);
        let switches = switches.flat_map(|((on, ready), [switch, flag])| {
            [field("CR", CR, switch, *on), field("CR", CR, flag, *ready)]
        });
        switches
            .chain([
                field("CFGR", cfgr, "SW", mask),
                field("CFGR", cfgr, "SWS", mask << above),
                field("CSR", csr, "RMVF", clear),
                field("CSR", csr, "PINRSTF", PINRSTF),
                field("CSR", csr, "IWDGRSTF", IWDGRSTF),
                field("CSR", csr, "SFTRSTF", SFTRSTF),
            ])
            .collect()
    }
}

#[derive(Debug, Clone)]
pub(super) struct Rcc {
    layout: &'static Layout,
    kept: Vec<u32>,
    resets: [u32; BUSES],
    gates: [u32; BUSES],
    csr: u32,
    /// There is nothing on the HSE input.
    stopped: bool,
    /// The clock security system has found that out.
    pub(super) has_failed: bool,
}

impl Rcc {
    pub(super) fn new(layout: &'static Layout) -> Self {
        let mut gates = [0; BUSES];
        for (bus, _, value) in layout.gates {
            gates[*bus as usize] = *value;
        }
        Self {
            layout,
            kept: layout.kept.iter().map(|(_, value)| *value).collect(),
            resets: [0; BUSES],
            gates,
            csr: layout.flags(ResetCause::Power),
            stopped: false,
            has_failed: false,
        }
    }

    /// The clock on the HSE input stops, or is there again; whether the chip takes it. Where
    /// it is watched HSE and what runs by it are switched off, and the core goes on with the
    /// internal oscillator (RM0390, chapter 6.2.7; RM0008, chapter 7.2.7).
    pub(super) fn stop_outside(&mut self, stopped: bool) -> bool {
        self.stopped = stopped;
        let taken = self.kept[0] & HSEON != 0;
        if stopped && taken && self.kept[0] & CSSON != 0 {
            self.kept[0] &= !(HSEON | CSSON | PLLON);
            let (selection, mask, _) = self.layout.selection;
            if let Some(place) = self.place(selection) {
                self.kept[place] &= !mask;
            }
            self.has_failed = true;
        }
        taken
    }

    /// As after a reset; the flags that tell why outlive it.
    pub(super) fn reset(&mut self, cause: ResetCause) {
        let flags = self.layout.flags(cause);
        let is_first = cause == ResetCause::Power;
        *self = Self {
            csr: if is_first { flags } else { self.csr | flags },
            stopped: self.stopped,
            ..Self::new(self.layout)
        };
    }

    pub(super) fn is_clocked(&self, bus: Bus, bit: u32) -> bool {
        self.gates[bus as usize] & (1 << bit) != 0
    }

    pub(super) fn is_in_reset(&self, bus: Bus, bit: u32) -> bool {
        self.resets[bus as usize] & (1 << bit) != 0
    }

    fn place(&self, offset: u32) -> Option<usize> {
        self.layout.kept.iter().position(|(at, _)| *at == offset)
    }

    fn kept(&self, offset: u32) -> u32 {
        self.place(offset).map_or(0, |place| self.kept[place])
    }

    /// The switches of oscillators and PLLs, of what can run.
    fn running(&self) -> u32 {
        self.kept[0] & if self.stopped { !HSEON } else { u32::MAX }
    }

    fn ready(&self) -> u32 {
        let running = self.running();
        let switches = self.layout.switches.iter();
        let on = switches.filter(|(switch, _)| running & switch != 0);
        on.fold(0, |flags, (_, ready)| flags | ready)
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        let layout = self.layout;
        if offset == layout.csr.0 {
            return Some(self.csr);
        }
        if let Some((bus, _)) = layout.resets.iter().find(|(_, at)| *at == offset) {
            return Some(self.resets[*bus as usize]);
        }
        if let Some((bus, ..)) = layout.gates.iter().find(|(_, at, _)| *at == offset) {
            return Some(self.gates[*bus as usize]);
        }
        if layout.security == Some(offset) {
            return Some(if self.has_failed { CSSF } else { 0 });
        }
        let value = self.kept[self.place(offset)?];
        let (selection, mask, above) = layout.selection;
        Some(match offset {
            CR => value | self.ready(),
            // The switch of the system clock has happened.
            _ if offset == selection => value & !(mask << above) | (value & mask) << above,
            _ => value,
        })
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let layout = self.layout;
        if offset == layout.csr.0 {
            if value & layout.csr.1 != 0 {
                self.csr = 0;
            }
        } else if let Some((bus, _)) = layout.resets.iter().find(|(_, at)| *at == offset) {
            self.resets[*bus as usize] = value;
        } else if let Some((bus, ..)) = layout.gates.iter().find(|(_, at, _)| *at == offset) {
            self.gates[*bus as usize] = value;
        } else if layout.security == Some(offset) {
            self.has_failed &= value & CSSC == 0;
            return value & !CSSC == 0;
        } else if let Some(place) = self.place(offset) {
            let switches = layout.switches.iter();
            let ready = switches.fold(0, |all, (_, ready)| all | ready);
            self.kept[place] = if offset == CR { value & !ready } else { value };
        } else {
            return false;
        }
        true
    }

    pub(super) fn clocks(&self) -> Result<Clocks, Fault> {
        let layout = self.layout;
        if self.kept[0] & layout.hsi_divider != 0 {
            return Err(Fault::Clock("a divider of HSI is not modelled"));
        }
        let (register, mask, _) = layout.selection;
        let cfgr = self.kept(register);
        let selected = cfgr & mask;
        let (switch, _) = layout.switches.get(selected as usize).ok_or(STOPPED)?;
        if self.running() & switch == 0 {
            return Err(STOPPED);
        }
        let system_hz = match selected {
            0 => Some(layout.hsi_hz),
            1 => Some(HSE_HZ),
            _ => (layout.pll_hz)(self),
        };
        let core_hz = system_hz.ok_or(STOPPED)? / ahb_divider(cfgr >> layout.ahb)?;
        let (most_hz, too_fast) = layout.most;
        if core_hz > most_hz {
            return Err(Fault::Clock(too_fast));
        }
        let [apb1, apb2] = layout.apb.map(|(at, _)| divider(cfgr >> at));
        let [(_, most1_hz), (_, most2_hz)] = layout.apb;
        if core_hz / apb1 > most1_hz || core_hz / apb2 > most2_hz {
            return Err(Fault::Clock("a peripheral bus runs too fast"));
        }
        Ok(Clocks::new(core_hz, apb1, apb2))
    }
}

const STOPPED: Fault = Fault::Clock("the system clock does not run");

/// What divides the clock of the core, by the four bits of its setting.
fn ahb_divider(bits: u32) -> Result<u64, Fault> {
    match bits & 0xF {
        0..=7 => Ok(1),
        8 => Ok(2),
        _ => Err(Fault::Clock("an AHB divider above 2 is not modelled")),
    }
}
