//! A sensor frame by SPI, pacing timer and DMA.

use super::{GPIOA, MS, RAM, Rig, US};
use crate::chip::{FRAME_IRQ, Fault, Ps};

const GPIOB: u32 = 0x4002_0400;
const SPI1: u32 = 0x4001_3000;
const TIM8: u32 = 0x4001_0400;
const DMA2: u32 = 0x4002_6400;
const COLLECTOR: u32 = DMA2 + 0x10;
const FEEDER: u32 = DMA2 + 0x28;

const ANSWERS: [u8; 8] = [0xFF, 1, 2, 3, 4, 5, 6, 7];
/// From the start of a byte to that of the next.
const SLOT: Ps = 50 * US;
/// Eight bits at 312.5 kHz.
const BYTE: Ps = 25_600_000;

/// A chip that has been up for 20 ms, its pins and SPI set up as the driver does.
fn rig(divider: u32) -> Rig {
    let mut rig = Rig::clocked();
    rig.run_fast();
    rig.sensor.answers = ANSWERS.to_vec();
    rig.pass(20 * MS);
    rig.write(GPIOB + 0x18, 1 << 6);
    rig.write(GPIOB, 0x280 | 1 << 12);
    rig.write(GPIOA, 0xA800_0000 | 2 << 10 | 2 << 12 | 2 << 14);
    rig.write(GPIOA + 0x20, 0x5550_0000);
    rig.write(GPIOA + 0x04, 1 << 7);
    rig.write(SPI1 + 4, 1);
    rig.write(SPI1, 1 | 1 << 2 | divider << 3 | 1 << 6 | 3 << 8);
    rig
}

/// Begins a frame of eight bytes, one in each `slot`.
fn begin(rig: &mut Rig, slot: Ps) {
    rig.write(TIM8 + 0x2C, (slot / 6_250 - 1) as u32);
    rig.write(COLLECTOR + 0x08, SPI1 + 0x0C);
    rig.write(COLLECTOR + 0x0C, RAM + 8);
    rig.write(COLLECTOR + 0x04, 8);
    rig.write(COLLECTOR, 3 << 25 | 3 << 16 | 1 << 10 | 1 << 4 | 1);
    rig.ram.0.borrow_mut()[0] = 0xFF;
    rig.write(FEEDER + 0x08, SPI1 + 0x0C);
    rig.write(FEEDER + 0x0C, RAM);
    rig.write(FEEDER + 0x04, 8);
    rig.write(FEEDER, 7 << 25 | 1 << 6 | 1);
    rig.write(GPIOB + 0x18, 1 << 22);
    rig.write(TIM8 + 0x0C, 1 << 8);
    rig.write(TIM8, 1);
}

fn is_done(rig: &Rig) -> bool {
    rig.chip.interrupts().contains(&(FRAME_IRQ, true))
}

#[test]
fn eight_bytes_reach_memory_without_the_core() {
    let mut rig = rig(7);
    begin(&mut rig, SLOT);
    rig.pass(SLOT - 1);
    assert_eq!(
        rig.sensor.latched, 0,
        "the sensor latches with the first clock"
    );
    rig.pass(1);
    assert_eq!(rig.sensor.latched, 1);
    rig.pass(7 * SLOT + BYTE - 1);
    assert!(!is_done(&rig));
    rig.pass(1);
    assert!(is_done(&rig));
    assert_eq!(rig.sensor.heard, [0xFF; 8]);
    assert_eq!(rig.ram.0.borrow()[8..16], ANSWERS);
    assert_eq!(rig.sensor.latched, 1, "once a frame");
    assert_eq!(rig.read(DMA2) & 0x820, 0x820, "TCIF of both streams");
    assert_eq!(
        rig.read(COLLECTOR) & 1,
        0,
        "the stream has switched itself off"
    );
    rig.write(DMA2 + 8, 0x20);
    assert!(!is_done(&rig));
    assert_eq!(rig.read(DMA2) & 0x820, 0x800);
}

#[test]
fn a_byte_that_nobody_fetches_is_overrun_by_the_next() {
    let mut rig = rig(7);
    begin(&mut rig, SLOT);
    rig.write(SPI1 + 4, 0);
    rig.pass(SLOT + BYTE);
    assert_eq!(rig.read(SPI1 + 8), 3, "RXNE and TXE");
    rig.pass(SLOT);
    assert_eq!(rig.read(SPI1 + 8) & 0x40, 0x40, "OVR");
    assert_eq!(
        rig.read(SPI1 + 0x0C),
        0xFF,
        "the first stays, the second is lost"
    );
    let _ = rig.read(SPI1 + 8);
    assert_eq!(rig.read(SPI1 + 8) & 0x41, 0, "DR, then SR: cleared");
}

#[test]
fn bytes_that_come_too_close_or_too_fast_are_told() {
    let mut close = rig(7);
    begin(&mut close, 30 * US);
    let fault = close.try_pass(MS);
    assert!(matches!(fault, Err(Fault::Wires(_))), "{fault:?}");
    let mut fast = rig(6);
    begin(&mut fast, SLOT);
    let fault = fast.try_pass(MS);
    assert!(matches!(fault, Err(Fault::Wires(_))), "625 kHz: {fault:?}");
}

#[test]
fn a_sensor_that_is_not_selected_or_misspoken_to_is_silent() {
    let mut unselected = rig(7);
    begin(&mut unselected, SLOT);
    unselected.write(GPIOB + 0x18, 1 << 6);
    unselected.pass(MS);
    assert!(is_done(&unselected));
    assert_eq!(unselected.ram.0.borrow()[8..16], [0xFF; 8]);
    assert_eq!(unselected.sensor.latched, 0);

    let mut wrong_mode = rig(7);
    wrong_mode.write(SPI1, 3 | 1 << 2 | 7 << 3 | 1 << 6 | 3 << 8);
    begin(&mut wrong_mode, SLOT);
    wrong_mode.pass(MS);
    assert_eq!(wrong_mode.ram.0.borrow()[8..16], [0xFF; 8]);

    // A line that is driven high against the sensor's open drain.
    let mut push_pull = rig(7);
    push_pull.write(GPIOA + 0x04, 0);
    begin(&mut push_pull, SLOT);
    push_pull.pass(MS);
    assert_eq!(push_pull.ram.0.borrow()[8..16], [0xFF; 8]);
}
