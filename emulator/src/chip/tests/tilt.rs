//! Frames of a TMAG5170, byte by byte, as the driver clocks them.

use super::side::{LEFT, RIGHT, Registers, SIDES};
use super::{GPIOA, GPIOB, Rig, US, why};
use crate::chip::{Fault, Needs, Ps};

const NS: Ps = 1_000;
/// From the core's clock of 160 MHz that the rigs have, SPI1's and SPI2's to 5 MHz.
const FASTER: u32 = 4;
/// Eight bits at 5 MHz.
const BYTE: Ps = 1_600 * NS;

const ANSWERS: [u8; 4] = [0x12, 0x34, 0x56, 0x78];

/// A chip that has been up for 20 ms, with the SPI in this mode and data to the sensor driven by
/// push-pull or not.
fn rig(on: &Registers, mode: u32, is_joined: bool, faster: u32) -> Rig {
    let mut rig = on.rig(on.divider);
    rig.chip.lines[on.side].needs = Needs::TILT;
    rig.sensors[on.side].answers = ANSWERS.to_vec();
    on.set_up_spi(&mut rig, mode, on.divider - faster);
    if !is_joined {
        let port = if on.side == 0 { GPIOA } else { GPIOB };
        rig.write(port + 0x04, 0);
    }
    rig
}

fn select(on: &Registers, rig: &mut Rig) {
    rig.write(GPIOB + 0x18, 1 << (16 + on.select));
}

/// A frame with these times from /CS low to the clock and from that to /CS high.
fn frame(on: &Registers, rig: &mut Rig, [lead, lag]: [Ps; 2]) -> Result<[u8; 4], Fault> {
    let mut read = [0; 4];
    select(on, rig);
    rig.try_pass(lead)?;
    for (n, byte) in read.iter_mut().enumerate() {
        rig.write(on.spi + 0x0C, 0x80 + n as u32);
        rig.try_pass(BYTE)?;
        assert_eq!(rig.read(on.spi + 0x08) & 0x81, 1, "received, and not busy");
        *byte = rig.read(on.spi + 0x0C) as u8;
    }
    rig.try_pass(lag)?;
    on.raise_select(rig);
    rig.try_pass(0)?;
    Ok(read)
}

const WELL: [Ps; 2] = [45 * NS, 45 * NS];

#[test]
fn in_another_mode_or_on_joined_lines_it_is_silent() {
    for on in SIDES {
        for (mode, is_joined) in [(1, false), (2, false), (0, true)] {
            let mut rig = rig(&on, mode, is_joined, FASTER);
            assert_eq!(frame(&on, &mut rig, WELL), Ok([0xFF; 4]), "{mode}");
        }
    }
}

#[test]
fn what_the_sensor_does_not_bear_is_told() {
    for on in [LEFT, RIGHT] {
        let mut fast = rig(&on, 0, false, FASTER + 2);
        assert_eq!(why(frame(&on, &mut fast, WELL)), "the clock is too fast");

        let mut soon = rig(&on, 0, false, FASTER);
        let found = frame(&on, &mut soon, [44 * NS, 45 * NS]);
        assert_eq!(why(found), "a byte too soon after /SS low");

        let mut cut = rig(&on, 0, false, FASTER);
        assert!(frame(&on, &mut cut, [45 * NS, 44 * NS]).is_ok());
        cut.pass(US);
        let found = frame(&on, &mut cut, WELL);
        assert_eq!(why(found), "/SS high too soon after the last byte");

        for (high, is_borne) in [(99 * NS, false), (100 * NS, true)] {
            let mut close = rig(&on, 0, false, FASTER);
            assert!(frame(&on, &mut close, WELL).is_ok());
            close.pass(high);
            let found = frame(&on, &mut close, WELL);
            assert_eq!(found.is_ok(), is_borne, "{found:?}");
        }
    }
}
