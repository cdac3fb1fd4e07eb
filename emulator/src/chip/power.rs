//! The supply: the voltage detector of PWR (RM0390, chapter 5.2; RM0008, chapter 5.2; RM0444,
//! chapter 4.2), the level below which the chip is in reset, and the option bytes that set it.
//! Thresholds are the typical ones of the data sheets.

use super::ResetCause;
use super::fields::{Field, field};

pub(crate) const WELL_MV: u32 = 3_300;

#[derive(Debug)]
pub(super) struct Layout {
    /// The registers of PWR that can be read, and their values after a reset; the detector's
    /// control register first, of which only its own bits may change.
    registers: &'static [(u32, u32)],
    /// In it: the switch, and where the levels for a falling and a rising supply begin.
    switch: u32,
    levels: [u32; 2],
    /// The register and bit that says that the supply is low.
    status: (u32, u32),
    /// Thresholds by level as the supply falls and as it rises, mV. A level without one is
    /// not modelled.
    thresholds_mv: &'static [[u32; 2]],
    /// Below which the chip is in reset, always, mV.
    power_down_mv: u32,
    brown_out: Option<BrownOut>,
}

/// A level that option bytes set.
#[derive(Debug)]
struct BrownOut {
    /// The register of the flash interface that shows them, its value as it is delivered, and
    /// where the level begins in it.
    register: u32,
    factory: u32,
    shift: u32,
    /// By level, mV; the last is off.
    levels_mv: [u32; 3],
}

/// Of the STM32F446 (DS10693, reset and power control block; RM0390, chapter 3.8.1).
pub(super) static F4: Layout = Layout {
    registers: &[(0x00, 0xC000), (0x04, 0)],
    switch: 1 << 4,
    levels: [5, 5],
    status: (0x04, 1 << 2),
    thresholds_mv: &[
        [2_040, 2_140],
        [2_190, 2_300],
        [2_350, 2_450],
        [2_510, 2_600],
        [2_660, 2_760],
        [2_820, 2_930],
        [2_930, 3_030],
        [3_030, 3_140],
    ],
    power_down_mv: 1_680,
    brown_out: Some(BrownOut {
        register: 0x14,
        factory: 0x0FFF_AAED,
        shift: 2,
        levels_mv: [2_830, 2_500, 2_190],
    }),
};

/// Of the STM32F103 (DS5319, reset and power control block).
pub(super) static F1: Layout = Layout {
    registers: &[(0x00, 0), (0x04, 0)],
    switch: 1 << 4,
    levels: [5, 5],
    status: (0x04, 1 << 2),
    thresholds_mv: &[
        [2_080, 2_180],
        [2_180, 2_280],
        [2_280, 2_380],
        [2_380, 2_480],
        [2_480, 2_580],
        [2_580, 2_680],
        [2_680, 2_780],
        [2_780, 2_880],
    ],
    power_down_mv: 1_880,
    brown_out: None,
};

/// Of the STM32G071 (DS12232, reset and power control block). The last level is a pin's.
pub(super) static G0: Layout = Layout {
    registers: &[(0x04, 0), (0x14, 0)],
    switch: 1 << 0,
    levels: [1, 4],
    status: (0x14, 1 << 11),
    thresholds_mv: &[
        [2_050, 2_150],
        [2_200, 2_310],
        [2_360, 2_460],
        [2_520, 2_610],
        [2_640, 2_740],
        [2_810, 2_910],
        [2_900, 2_980],
    ],
    power_down_mv: 1_640,
    brown_out: None,
};

pub(super) fn fields(layout: &Layout) -> Vec<Field> {
    let control = layout.registers[0].0;
    let (register, status) = match control {
        0 => ("CR", "CSR"),
        _ => ("CR2", "SR2"),
    };
    let levels = match layout.levels {
        [falling, rising] if falling == rising => vec![("PLS", falling)],
        [falling, rising] => vec![("PVDFT", falling), ("PVDRT", rising)],
    };
    let levels = levels.into_iter();
    let levels = levels.map(|(name, shift)| field(register, control, name, 7 << shift));
    let (at, flag) = layout.status;
    levels
        .chain([
            field(register, control, "PVDE", layout.switch),
            field(status, at, "PVDO", flag),
        ])
        .collect()
}

/// The bits of the flash interface that show the brown-out level.
pub(super) fn options(layout: &Layout) -> Option<Field> {
    let brown_out = layout.brown_out.as_ref()?;
    let bits = 3 << brown_out.shift;
    Some(field("OPTCR", brown_out.register, "BOR_LEV", bits))
}

#[derive(Debug)]
pub(super) struct Power {
    layout: &'static Layout,
    pub(super) supply_mv: u32,
    control: u32,
    /// It is below the detector's threshold.
    low: bool,
    options: u32,
}

impl Power {
    pub(super) fn new(layout: &'static Layout) -> Self {
        let brown_out = layout.brown_out.as_ref();
        Self {
            layout,
            supply_mv: WELL_MV,
            control: layout.registers[0].1,
            low: false,
            options: brown_out.map_or(0, |brown_out| brown_out.factory),
        }
    }

    /// As after a reset; supply and option bytes outlive it.
    pub(super) fn reset(&mut self) {
        self.control = self.layout.registers[0].1;
        self.low = false;
    }

    /// The threshold for a falling supply, and for a rising one, mV.
    fn thresholds_mv(&self, control: u32) -> Option<[u32; 2]> {
        let layout = self.layout;
        let level = |shift: u32| layout.thresholds_mv.get((control >> shift) as usize & 7);
        let [falling, rising] = layout.levels.map(level);
        Some([falling?[0], rising?[1]])
    }

    /// Follows the supply; whether it has just become low.
    pub(super) fn compare(&mut self) -> bool {
        let was_low = self.low;
        let on = self.control & self.layout.switch != 0;
        let thresholds = self.thresholds_mv(self.control).filter(|_| on);
        self.low = thresholds.is_some_and(|[falling, rising]| {
            self.supply_mv < falling || was_low && self.supply_mv < rising
        });
        self.low && !was_low
    }

    pub(super) fn holds_in_reset(&self) -> Option<ResetCause> {
        if self.supply_mv < self.layout.power_down_mv {
            return Some(ResetCause::Power);
        }
        let brown_out = self.layout.brown_out.as_ref()?;
        let level = (self.options >> brown_out.shift) as usize & 3;
        let level_mv = brown_out.levels_mv.get(level)?;
        (self.supply_mv < *level_mv).then_some(ResetCause::BrownOut)
    }

    /// To the highest level, which is 0; whether there is any.
    pub(super) const fn set_brown_out(&mut self) -> bool {
        let Some(BrownOut { shift, .. }) = self.layout.brown_out else {
            return false;
        };
        self.options &= !(3 << shift);
        true
    }

    /// The option bytes, if the register of the flash interface shows them.
    pub(super) fn options(&self, offset: u32) -> Option<u32> {
        let brown_out = self.layout.brown_out.as_ref()?;
        (offset == brown_out.register).then_some(self.options)
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        let (at, flag) = self.layout.status;
        let registers = self.layout.registers.iter().enumerate();
        let (n, _) = registers.clone().find(|(_, (found, _))| *found == offset)?;
        let value = if n == 0 { self.control } else { 0 };
        Some(value | if offset == at && self.low { flag } else { 0 })
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let layout = self.layout;
        let (control, after_reset) = layout.registers[0];
        let levels = layout.levels.iter();
        let own = levels.fold(layout.switch, |bits, shift| bits | 7 << shift);
        let known = offset == control
            && value & !own == after_reset & !own
            && self.thresholds_mv(value).is_some();
        if known {
            self.control = value;
        }
        known
    }
}
