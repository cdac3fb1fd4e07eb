//! Peripherals against their reference manual, as a driver sees them.

mod bus;
mod frame;
mod pins;
mod power;
mod serial;
mod side;
mod tilt;
mod time;

use std::iter;

use super::models::F446;
use super::{Chip, CoreKind, Fault, Model, Ps, ResetCause, SensorEnd};
use crate::memory::{Memories, RAM};

const RCC: u32 = 0x4002_3800;
/// On the STM32F103 and the STM32G071.
const SMALL_RCC: u32 = 0x4002_1000;
const FLASH: u32 = 0x4002_3C00;
/// On the same two.
const SMALL_FLASH: u32 = 0x4002_2000;
const TIM1: u32 = 0x4001_0000;
const TIM6: u32 = 0x4000_1000;
const GPIOA: u32 = 0x4002_0000;
const GPIOB: u32 = 0x4002_0400;
const GPIOC: u32 = 0x4002_0800;

const MS: Ps = 1_000_000_000;
const US: Ps = 1_000_000;

/// A sensor that answers with given bytes, and keeps those that it receives.
#[derive(Default)]
struct Script {
    answers: Vec<u8>,
    heard: Vec<u8>,
    latched: usize,
    polled: usize,
    released: usize,
}

impl SensorEnd for Script {
    fn latch(&mut self, _: Ps, is_polled: bool) {
        self.polled += usize::from(is_polled);
        self.latched += 1;
    }

    fn exchange(&mut self, sent: u8) -> u8 {
        self.heard.push(sent);
        let answer = self.answers.get(self.heard.len() - 1);
        answer.copied().unwrap_or(0xFF)
    }

    fn release(&mut self) {
        self.released += 1;
    }
}

/// What a sensor does not bear.
fn why<T: std::fmt::Debug>(fault: Result<T, Fault>) -> &'static str {
    match fault {
        Err(Fault::Wires { what, .. }) => what,
        other => panic!("{other:?}"),
    }
}

struct Rig {
    chip: Chip,
    memories: Memories,
    sensors: [Script; 2],
    now: Ps,
}

impl Rig {
    fn new() -> Self {
        Self::of(&F446)
    }

    fn of(model: &'static Model) -> Self {
        Self {
            chip: Chip::new(model).unwrap(),
            memories: Memories::flashed(iter::empty(), 0, 64).unwrap(),
            sensors: Default::default(),
            now: 0,
        }
    }

    /// A chip with every peripheral's clock on.
    fn clocked() -> Self {
        let mut rig = Self::new();
        for gates in [0x30, 0x40, 0x44] {
            rig.write(RCC + gates, u32::MAX);
        }
        rig
    }

    /// Bytes of RAM, from so many on.
    fn ram<const N: usize>(&self, from: u32) -> [u8; N] {
        self.memories.bytes(RAM + from).unwrap()
    }

    fn write(&mut self, address: u32, value: u32) {
        self.try_write(address, value).unwrap();
    }

    fn try_write(&mut self, address: u32, value: u32) -> Result<(), Fault> {
        self.chip.now = self.now;
        self.chip.write(address, value, u32::MAX)
    }

    fn read(&mut self, address: u32) -> u32 {
        self.chip.now = self.now;
        self.chip.read(address, u32::MAX).unwrap()
    }

    fn try_pass(&mut self, time: Ps) -> Result<Option<ResetCause>, Fault> {
        self.now += time;
        let sides = usize::from(self.chip.model.facts.max_sides);
        let sensors = &mut self.sensors[..sides];
        self.chip.advance(self.now, &self.memories, sensors)
    }

    fn pass(&mut self, time: Ps) {
        assert_eq!(self.try_pass(time), Ok(None));
    }

    /// The clocks of the board, as its program sets them up.
    fn run_fast(&mut self) {
        match self.chip.model.core {
            // 8 MHz from outside to 160 MHz, buses at 40 and 80.
            CoreKind::M4F => {
                self.write(RCC, 0x0005_0083);
                self.write(RCC + 0x04, 4 | 160 << 6 | 1 << 22);
                self.write(RCC, 0x0105_0083);
                self.write(FLASH, 0x705);
                self.write(RCC + 0x08, 2 | 5 << 10 | 4 << 13);
            }
            // 8 MHz from outside to 72 MHz, buses at 36 and 72.
            CoreKind::M3 => {
                self.write(SMALL_RCC, 0x0005_0083);
                self.write(SMALL_RCC + 0x04, 1 << 16 | 7 << 18 | 4 << 8);
                self.write(SMALL_RCC, 0x0105_0083);
                self.write(SMALL_FLASH, 0x32);
                self.write(SMALL_RCC + 0x04, 1 << 16 | 7 << 18 | 4 << 8 | 2);
            }
            // 16 MHz from inside to 64 MHz.
            CoreKind::M0Plus => {
                self.write(SMALL_RCC + 0x0C, 2 | 8 << 8 | 1 << 28 | 1 << 29);
                self.write(SMALL_RCC, 0x0100_0500);
                self.write(SMALL_FLASH, 0x0004_0602);
                self.write(SMALL_RCC + 0x08, 2);
            }
        }
    }
}

#[test]
fn the_clock_tree_is_worked_out_from_its_registers() {
    let mut rig = Rig::new();
    assert_eq!(rig.chip.cycle(), 62_500, "16 MHz after reset");
    rig.run_fast();
    assert_eq!(rig.chip.cycle(), 6_250, "160 MHz");
    assert_eq!(rig.read(RCC + 0x08) & 0xC, 0x8, "the PLL drives the core");
}

#[test]
fn a_clock_that_does_not_run_or_is_too_fast_is_refused() {
    for (case, pll, cfgr) in [
        ("a PLL that is off", None, 2),
        ("200 MHz", Some(200), 2 | 5 << 10 | 4 << 13),
        ("APB1 at 160 MHz", Some(160), 2 | 4 << 13),
    ] {
        let mut rig = Rig::new();
        if let Some(times) = pll {
            rig.write(RCC, 0x0105_0083);
            rig.write(RCC + 0x04, 4 | times << 6 | 1 << 22);
        }
        let fault = rig.try_write(RCC + 0x08, cfgr);
        assert!(matches!(fault, Err(Fault::Clock(_))), "{case}: {fault:?}");
    }
}

#[test]
fn what_is_not_modelled_is_told_and_not_guessed() {
    fn is_reported<T: std::fmt::Debug>(result: &Result<T, Fault>) {
        let is_unmodelled = matches!(result, Err(Fault::Unmodelled { .. }));
        assert!(is_unmodelled, "{result:?}");
    }
    let mut rig = Rig::clocked();
    // The RTC, the ADC, a register that TIM1 has not, one-pulse mode.
    for address in [0x4000_2800, 0x4001_2000, TIM1 + 0x50] {
        is_reported(&rig.chip.read(address, u32::MAX));
        is_reported(&rig.try_write(address, 0));
    }
    is_reported(&rig.try_write(TIM1, 1 << 3));
    // TIM6 has no channels.
    is_reported(&rig.try_write(TIM6 + 0x34, 0));
}

#[test]
fn a_peripheral_without_its_clock_is_deaf_and_reads_zero() {
    let mut rig = Rig::new();
    rig.write(GPIOA + 0x14, 0xFFFF);
    assert_eq!(rig.read(GPIOA), 0);
    rig.write(RCC + 0x30, 1);
    let modes = rig.read(GPIOA);
    assert_eq!(modes, 0xA800_0000, "the debugger's pins after reset");
    assert_eq!(rig.read(GPIOA + 0x14), 0);
}

#[test]
fn half_words_of_a_port_leave_the_other_half() {
    let mut rig = Rig::clocked();
    rig.write(GPIOA + 0x14, 0x00FF);
    rig.chip.write(GPIOA, 0x0001_0000, 0xFFFF_0000).unwrap();
    assert_eq!(rig.read(GPIOA), 0x0001_0000, "upper half of MODER alone");
    rig.write(GPIOA + 0x18, 0x000F_0F00);
    assert_eq!(rig.read(GPIOA + 0x14), 0x0FF0);
}

#[test]
fn a_peripheral_reset_puts_its_registers_back() {
    let mut rig = Rig::clocked();
    rig.write(TIM1 + 0x2C, 7_999);
    rig.write(GPIOA + 0x14, 1);
    rig.write(RCC + 0x24, 1);
    rig.write(RCC + 0x24, 0);
    assert_eq!(rig.read(TIM1 + 0x2C), 0xFFFF);
    assert_eq!(rig.read(GPIOA + 0x14), 1, "another is left alone");
}
