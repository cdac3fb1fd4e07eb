//! `[telemetry]`: what a module reports to a PC in every tick, and what the PC may ask for.

use crate::key::{integer, yes_or_no};
use crate::keys::keys;

keys! {
    /// What a module reports to a PC in every tick, and what the PC may ask for.
    #[derive(Copy)]
    pub struct TelemetrySection {
        /// A board has records of every tick for a probe, and carries out its commands. Left
        /// out, that takes no time and no memory; a simulation has nothing to leave out.
        rtt: bool = yes_or_no().default("true"),

        /// A board tells of touches, decisions, faults and its health as lines of text on
        /// the ST-LINK's serial port, PA2 and PA3, and takes commands there: bits a second,
        /// which the board's clock must divide to within 1.5 %. The ST-LINK's default is
        /// 115200. Needs `rtt`, whose records it can carry.
        serial_baud: Option<u32> = integer(9_600..=2_000_000)
            .unit("baud")
            .optional("no serial port"),

        /// On a board PB8 is high while a whisker touches something, and PB9 for 10 ms after
        /// each decision. Needs `[classifier]`, which tells of both.
        pins: bool = yes_or_no().default("false"),
    }
}
