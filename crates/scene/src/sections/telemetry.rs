//! `[telemetry]`: what a module reports to a PC in every tick, and what the PC may ask for.

use crate::key::{integer, yes_or_no};
use crate::keys::keys;

keys! {
    /// What a module reports to a PC in every tick, and what the PC may ask for.
    #[derive(Copy)]
    pub struct TelemetrySection {
        /// A board has records of every tick for a probe, and carries out its commands.
        rtt: bool = yes_or_no().default("true"),

        /// Speed of [the serial port](protocol.md#the-serial-port). The ST-LINK's default is
        /// 115200. Needs `rtt`.
        serial_baud: Option<u32> = integer(9_600..=2_000_000)
            .unit("baud")
            .optional("no serial port"),

        /// On a board PB8 is high while a whisker touches something, and PB9 for 10 ms after each
        /// decision. Needs `[classifier]`.
        pins: bool = yes_or_no().default("false"),
    }
}
