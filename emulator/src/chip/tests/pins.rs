//! What reaches motors and comes from encoders, pin by pin.

use super::{GPIOA, GPIOC, Rig, TIM1};

const TIM3: u32 = 0x4000_0400;
const SMCR: u32 = 0x08;
const CNT: u32 = 0x24;

/// MODER of port A after a reset: the debugger's pins.
const DEBUGGER: u32 = 0xA800_0000;

/// A chip whose TIM1 makes PWM on all channels, 8,000 counts long.
fn rig() -> Rig {
    let mut rig = Rig::clocked();
    rig.write(TIM1 + 0x2C, 7_999);
    rig.write(TIM1 + 0x18, 6 << 4 | 6 << 12);
    rig.write(TIM1 + 0x1C, 6 << 4);
    rig.write(TIM1 + 0x20, 0x111);
    rig.write(TIM1, 1);
    rig.write(TIM1 + 0x44, 1 << 15);
    rig
}

#[test]
fn motor_pins_carry_the_duty_only_while_everything_says_so() {
    let mut rig = rig();
    let (ccr1, bdtr) = (TIM1 + 0x34, TIM1 + 0x44);
    let mut carries = |writes: &[(u32, u32)], on: u32, why: &str| {
        for &(address, value) in writes {
            rig.write(address, value);
        }
        assert_eq!(rig.chip.motor_duties()[0], (on, 8_000), "{why}");
    };
    let (moder, afrh) = (GPIOA, GPIOA + 0x24);
    carries(&[(ccr1, 2_000)], 0, "the pin is an input");
    carries(&[(moder, DEBUGGER | 2 << 16)], 0, "function 0 is no timer");
    carries(&[(afrh, 1)], 2_000, "");
    carries(&[(ccr1, 9_000)], 8_000, "always on");
    carries(&[(bdtr, 0)], 0, "no main output");
    let output = (moder, DEBUGGER | 1 << 16);
    carries(&[(bdtr, 1 << 15), output], 0, "a plain output, low");
}

fn connect_encoders(rig: &mut Rig) {
    rig.write(GPIOA, DEBUGGER | 0b1010);
    rig.write(GPIOA + 0x20, 0x11);
    rig.write(GPIOC, 0b1010 << 12);
    rig.write(GPIOC + 0x20, 0x2200_0000);
}

fn start_encoder(rig: &mut Rig, timer: u32) {
    rig.write(timer + SMCR, 3);
    rig.write(timer, 1);
}

#[test]
fn an_encoder_is_not_heard_through_pins_that_are_not_its_timers() {
    for (why, address, value) in [
        ("an input", GPIOC, 0b0010 << 12),
        ("TIM8's function", GPIOC + 0x20, 0x2300_0000),
    ] {
        let mut rig = Rig::clocked();
        connect_encoders(&mut rig);
        start_encoder(&mut rig, TIM3);
        rig.write(address, value);
        rig.chip.set_encoder(1, 7);
        assert_eq!(rig.read(TIM3 + CNT), 0, "{why}");
        connect_encoders(&mut rig);
        rig.chip.set_encoder(1, 9);
        assert_eq!(rig.read(TIM3 + CNT), 2, "from where it is connected on");
    }
}
