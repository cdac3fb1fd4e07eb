//! Timers and the watchdog.

use super::{MS, RCC, Rig, US};
use crate::chip::ResetCause;
use crate::chip::wiring::ByteSignal;

const TIM2: u32 = 0x4000_0000;
const TIM7: u32 = 0x4000_1400;
const IWDG: u32 = 0x4000_3000;
const CR1: u32 = 0x00;
const DIER: u32 = 0x0C;
const SR: u32 = 0x10;
const EGR: u32 = 0x14;
const CNT: u32 = 0x24;
const PSC: u32 = 0x28;
const ARR: u32 = 0x2C;
const CCR1: u32 = 0x34;

fn ticks(rig: &Rig) -> bool {
    rig.chip.interrupts().next().is_some_and(|(_, up)| up)
}

#[test]
fn the_tick_interrupts_every_half_millisecond_until_acknowledged() {
    let mut rig = Rig::clocked();
    rig.run_fast();
    rig.write(TIM7 + PSC, 0);
    rig.write(TIM7 + ARR, 39_999);
    rig.write(TIM7 + CR1, 1 << 2);
    rig.write(TIM7 + EGR, 1);
    assert_eq!(rig.read(TIM7 + SR), 0, "URS: that update is no tick");
    rig.write(TIM7 + DIER, 1);
    rig.write(TIM7 + CR1, 1 << 2 | 1);
    assert_eq!(rig.chip.next_event(), Some(500 * US));
    rig.pass(500 * US - 1);
    assert!(!ticks(&rig));
    rig.pass(1);
    assert!(ticks(&rig));
    rig.pass(100 * US);
    assert!(ticks(&rig), "a level");
    assert_eq!(rig.chip.tick_began(), 500 * US);
    rig.write(TIM7 + SR, 0);
    assert!(!ticks(&rig));
    assert_eq!(rig.read(TIM7 + CNT), 8_000, "100 us at 80 MHz");
    rig.pass(400 * US);
    assert!(ticks(&rig), "without drift");
}

fn start_watchdog(rig: &mut Rig) {
    for key in [0xCCCC, 0x5555] {
        rig.write(IWDG, key);
    }
    rig.write(IWDG + 0x04, 0);
    rig.write(IWDG + 0x08, 159);
    rig.write(IWDG, 0xAAAA);
}

/// Its settings are kept without the key.
#[test]
fn the_watchdog_bites_20_ms_after_it_was_fed() {
    let mut rig = Rig::new();
    start_watchdog(&mut rig);
    rig.write(IWDG + 0x08, 0xFFF);
    assert_eq!(rig.read(IWDG + 0x0C), 3, "settings on their way");
    rig.pass(157 * US);
    assert_eq!(rig.read(IWDG + 0x0C), 0);
    rig.pass(15 * MS);
    rig.write(IWDG, 0xAAAA);
    rig.pass(20 * MS - 1);
    assert_eq!(rig.try_pass(1), Ok(Some(ResetCause::Watchdog)));
}

#[test]
fn the_cause_of_a_reset_is_kept_until_it_is_cleared() {
    let mut rig = Rig::new();
    let cause = |rig: &mut Rig| rig.read(RCC + 0x74) >> 25;
    assert_eq!(cause(&mut rig), 0b111, "power: POR, pin, BOR");
    rig.write(RCC + 0x74, 1 << 24);
    assert_eq!(cause(&mut rig), 0);
    rig.chip.reset(ResetCause::Watchdog).unwrap();
    assert_eq!(cause(&mut rig), 0b1_0010, "IWDG, pin");
    rig.chip.reset(ResetCause::Software).unwrap();
    assert_eq!(cause(&mut rig), 0b1_1010, "and software");
    assert_eq!(rig.chip.cycle(), 62_500, "back on 16 MHz");
    assert_eq!(rig.chip.watchdog.bites(), None);
}

#[test]
fn a_match_of_a_channel_asks_for_a_byte_once_a_period() {
    let count = US / 80;
    let mut rig = Rig::clocked();
    rig.run_fast();
    rig.write(TIM2 + ARR, 99);
    rig.write(TIM2 + CCR1, 99);
    rig.write(TIM2 + DIER, 1 << 9);
    rig.write(TIM2 + CR1, 1);
    let asks = |rig: &Rig| rig.chip.timers[0].requests(ByteSignal::Compare);
    rig.pass(99 * count - 1);
    assert!(!asks(&rig));
    rig.pass(1);
    assert!(asks(&rig), "as the last count begins");
    rig.chip.timers[0].serve(ByteSignal::Compare);
    rig.pass(100 * count - 1);
    assert!(!asks(&rig), "once a period");
    rig.pass(1);
    assert!(asks(&rig));
    rig.write(TIM2 + DIER, 0);
    assert!(!asks(&rig), "withdrawn");
    let written = rig.try_write(TIM7 + DIER, 1 << 9);
    assert!(written.is_err(), "it has no channel");
}
