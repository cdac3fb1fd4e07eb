//! The supply and what watches it; a clock that stops.

use super::{RCC, Rig, SMALL_RCC};
use crate::chip::models::{F103, F446, G071};
use crate::chip::{Fault, Model, ResetCause};

const PWR: u32 = 0x4000_7000;
const LINE: u32 = 1 << 16;

fn interrupts(rig: &Rig) -> bool {
    let mut lines = rig.chip.interrupts();
    lines.any(|(irq, up)| irq == 1 && up)
}

fn supply(rig: &mut Rig, mv: u32) {
    assert_eq!(rig.chip.set_supply(mv), Ok(None), "{mv} mV");
}

/// A chip whose detector is on, as the board's program sets it up: its registers of control
/// and state, the bit that says low, and the interrupt line's pending register.
fn watched(model: &'static Model) -> (Rig, [u32; 4]) {
    let mut rig = Rig::of(model);
    let (gate, control, on, status, low) = match model.program {
        "nucleo_f446re" => (RCC + 0x40, PWR, 0xC000 | 6 << 5 | 1 << 4, PWR + 4, 1 << 2),
        "nucleo_f103rb" => (SMALL_RCC + 0x1C, PWR, 7 << 5 | 1 << 4, PWR + 4, 1 << 2),
        _ => (
            SMALL_RCC + 0x3C,
            PWR + 4,
            6 << 4 | 6 << 1 | 1,
            PWR + 0x14,
            1 << 11,
        ),
    };
    let [exti, mask, rising, pending] = match model.program {
        "nucleo_f446re" => [0x4001_3C00, 0x00, 0x08, 0x14],
        "nucleo_f103rb" => [0x4001_0400, 0x00, 0x08, 0x14],
        _ => [0x4002_1800, 0x80, 0x00, 0x0C],
    };
    rig.write(gate, 1 << 28);
    rig.write(control, on);
    let after_reset = rig.read(exti + mask);
    rig.write(exti + mask, after_reset | LINE);
    rig.write(exti + rising, LINE);
    (rig, [control, status, low, exti + pending])
}

#[test]
fn the_detector_interrupts_once_as_the_supply_falls() {
    for model in [&F446, &F103, &G071] {
        let (mut rig, [_, status, low, pending]) = watched(model);
        assert!(!interrupts(&rig) && rig.read(status) & low == 0);
        supply(&mut rig, 2_750);
        assert!(interrupts(&rig), "{}", model.program);
        assert_eq!(rig.read(status) & low, low);
        rig.write(pending, LINE);
        assert!(!interrupts(&rig), "an edge, no level");
        supply(&mut rig, 2_850);
        assert_eq!(rig.read(status) & low, low, "hysteresis");
        supply(&mut rig, 3_300);
        assert!(!interrupts(&rig) && rig.read(status) & low == 0);
        supply(&mut rig, 2_750);
        assert!(interrupts(&rig));
    }
}

#[test]
fn a_detector_that_is_off_or_masked_says_nothing() {
    let (mut rig, [control, ..]) = watched(&F446);
    rig.write(control, 0xC000);
    supply(&mut rig, 2_000);
    assert!(!interrupts(&rig));
    let (mut rig, [.., pending]) = watched(&F446);
    rig.write(0x4001_3C00, 0);
    supply(&mut rig, 2_000);
    assert!(!interrupts(&rig));
    rig.write(0x4001_3C00, LINE);
    assert!(interrupts(&rig), "the edge was kept");
    assert_eq!(rig.read(pending), LINE);
}

#[test]
fn the_flash_keeps_up_with_the_clock_as_the_supply_says() {
    for (model, bears) in [(&F446, 2_700), (&F103, 2_000), (&G071, 1_700)] {
        let mut rig = Rig::of(model);
        rig.run_fast();
        supply(&mut rig, bears);
        let fault = rig.chip.set_supply(bears - 50);
        let held = fault == Ok(Some(ResetCause::Power));
        assert!(held || matches!(fault, Err(Fault::Clock(_))), "{fault:?}");
    }
    // The F446 on its own 16 MHz bears 1.8 V.
    let mut rig = Rig::new();
    supply(&mut rig, 1_800);
    // And one wait state too few is reported, and not taken.
    let mut rig = Rig::new();
    rig.run_fast();
    assert!(rig.try_write(super::FLASH, 0x704).is_err());
    assert_eq!(rig.read(super::FLASH), 0x705);
}

#[test]
fn the_reset_is_that_of_the_level_in_the_option_bytes() {
    let mut rig = Rig::new();
    assert_eq!(rig.read(super::FLASH + 0x14) >> 2 & 3, 3, "off");
    assert_eq!(rig.chip.set_supply(1_600), Ok(Some(ResetCause::Power)));
    assert!(rig.chip.set_brown_out());
    assert_eq!(rig.read(super::FLASH + 0x14) >> 2 & 3, 0, "level 3");
    assert_eq!(rig.chip.set_supply(2_800), Ok(Some(ResetCause::BrownOut)));
    rig.write(RCC + 0x74, 1 << 24);
    rig.chip.reset(ResetCause::BrownOut).unwrap();
    assert_eq!(rig.read(RCC + 0x74) >> 25, 0b11, "BOR and pin alone");
    assert!(!Rig::of(&F103).chip.set_brown_out());
}

#[test]
fn a_clock_that_stops_raises_the_nmi_where_it_is_watched() {
    for (model, rcc, flag) in [(&F446, RCC, 0x0C), (&F103, SMALL_RCC, 0x08)] {
        let mut rig = Rig::of(model);
        rig.run_fast();
        let slow = Rig::of(model).chip.cycle();
        let mut unwatched = Rig::of(model);
        unwatched.run_fast();
        let stopped = unwatched.chip.stop_clock(true);
        assert!(stopped.is_err(), "the core stands still");

        let control = rig.read(rcc);
        rig.write(rcc, control | 1 << 19);
        assert!(!rig.chip.has_nmi());
        assert_eq!(rig.chip.stop_clock(true), Ok(true));
        assert!(rig.chip.has_nmi());
        assert_eq!(rig.read(rcc + flag), 1 << 7);
        assert_eq!(rig.chip.cycle(), slow, "on the internal oscillator");
        rig.write(rcc, 1 << 16 | 1);
        assert_eq!(rig.read(rcc) & 1 << 17, 0, "HSE does not come");
        rig.chip.stop_clock(false).unwrap();
        assert_eq!(rig.read(rcc) & 1 << 17, 1 << 17);
        rig.write(rcc + flag, 1 << 23);
        assert!(!rig.chip.has_nmi());
    }
    let mut rig = Rig::of(&G071);
    rig.run_fast();
    assert_eq!(rig.chip.stop_clock(true), Ok(false), "it has its own");
    assert!(!rig.chip.has_nmi());
}
