//! `[sensor]`: which sensor a whisker has, and what its readings cannot do.

use mlx90333::{ByteOrder, Mode, SumRule};

use crate::choice::choice;
use crate::key::{integer, number, positive, word};
use crate::keys::keys;

choice! {
    /// What a whisker's sensor is.
    pub enum SensorModel {
        /// Melexis MLX90333: two angles of a magnet's field.
        Mlx90333 = "mlx90333",
        /// Texas Instruments TMAG5170: three fields, of which the module computes the tilt.
        Tmag5170 = "tmag5170",
    }
}

choice! {
    /// How fast a sensor computes, which is set in its EEPROM, and is read.
    pub enum SensorMode {
        /// A value every 350 us, read at up to 320 kHz.
        Fast = "fast",
        /// A value every 1.5 ms, read at up to 240 kHz.
        Slow = "slow",
    }
}

choice! { for Mode { AlphaBeta = "alpha-beta", Xyz = "xyz" } }

choice! {
    for SumRule {
        SumB1B6 = "b1-b6",
        SumB0B6 = "b0-b6",
        ComplementB1B6 = "not-b1-b6",
        ComplementB0B6 = "not-b0-b6",
        Ignore = "ignored",
    }
}

choice! { for ByteOrder { Little = "low-first", Big = "high-first" } }

keys! {
    /// Which sensor a whisker has, and what its readings cannot do.
    #[derive(Copy)]
    pub struct SensorSection {
        /// The sensor's own mode. In the slow one a board reads at half its clock, 125 to 141 kHz,
        /// with 50 us between bytes, and a tick takes at least 1.03 ms; take 500 Hz, as values are
        /// computed no faster. Not confirmed on a part.
        mode: SensorMode = word().default("\"fast\""),

        /// What the words of a frame of the MLX90333 are. With `"xyz"` x and y are the first two,
        /// and the sensor cannot report its own faults.
        words: Mode = word().default("\"alpha-beta\""),

        /// How the last byte of a frame follows from the others, which is not certain for a real
        /// part: with another than its own every frame is fault 21.
        sum_rule: SumRule = word().default("\"b1-b6\""),

        /// Which byte of a word comes first. One driver in five has the high one first.
        byte_order: ByteOrder = word().default("\"low-first\""),

        /// Least time for which the sensor is deselected between two frames. A board refuses ticks
        /// that [leave less](boards.md#the-rest-of-a-sensor).
        rest_us: u16 = integer(50..=4_000).unit("us").default("50"),

        /// Longest time for which both words may repeat to the bit without a fault. Nothing is
        /// decided by a reading that has repeated for 7.5 ms.
        frozen_s: f64 = number(0.02..=30.0).unit("s").default("0.25"),

        /// Fastest change of a deflection, in full scales; a frame beyond it is a bad one.
        jump_per_s: f64 = positive(1e6).unit("1/s").default("1500.0"),

        /// Which sensor it is. The TMAG5170 has no `mode`, and needs a board's program that was
        /// built for it.
        model: SensorModel = word().default("\"mlx90333\""),

        /// How long a silence is, many whisks and at most 65,534 ticks, after which the module sets
        /// the sensor's zero to the mean of its codes, if that differs by at least eight. A reading
        /// is the difference from the zero.
        zero_after_s: Option<f64> = number(0.5..=30.0).unit("s")
            .optional("the zero is at mid-scale"),

        /// Contact signal that ends a silence: above what whisking in free air gives.
        zero_calm: f64 = number(0.0001..=1.0).default("0.05"),

        /// How far from mid-scale the zero may be found; beyond it the last zero stays.
        zero_most: u16 = integer(1..=8_191).unit("codes").default("160"),

        /// Least codes by which a whisk of 30 degrees or more moves x in the air (`whisker
        /// calibrate` shows it). Where x moves by less for 2 s, the magnet or the whisker is gone:
        /// a limit, and no contact is reported; once it has moved by that much after a start. 0: not
        /// checked.
        swing_codes: Option<u16> = integer(0..=8_191).unit("codes")
            .optional("50 from 1.25 Hz on; below, where noise moves it as far, 0"),

        /// Time constant with which the module learns in the air what whisking alone makes x read
        /// at each phase, and takes it out of the contact signal, so that a long shaft does not
        /// suppress its own protraction. Touches and decisions rest on readings as they are. Needs
        /// `[whisking]`, and `[classifier]`, by whose touches learning stops.
        self_motion_s: Option<f64> = number(0.5..=30.0).unit("s")
            .optional("it counts as contact"),
    }
}
