//! The numbers and names of constants: the only place where they stand.
//!
//! A number never changes its meaning and is never used again.

/// Hands every row of the table, `number NAME: "name";`, to the macro `$then`, as a logger
/// wants texts as literals.
#[macro_export]
macro_rules! tunable_table {
    ($then:ident) => {
        $then! {
            1 FROZEN: "sensor: ticks of repeated words";
            2 STALE: "sensor: ticks of repeated words as evidence";
            3 JUMP: "sensor: largest change in a tick";
            4 CONTACT_MIN: "classifier: least contact";
            5 THRESHOLD: "classifier: threshold, as odds against";
            6 KP: "position control: kp";
            7 KD: "position control: kd";
            8 MIN: "position control: lowest setpoint";
            9 MAX: "position control: highest setpoint";
            10 DUTY_LIMIT: "position control: largest duty";
            11 SLEW: "position control: largest change of the duty";
            12 HARD: "guard: hard duty";
            13 UNMOVED: "guard: duty without motion";
            14 FOLLOWING: "guard: following error";
            15 SPEED: "guard: counts in a tick";
            16 TRAVEL_LOW: "guard: lowest count";
            17 TRAVEL_HIGH: "guard: highest count";
            18 HEAT: "guard: continuous duty, squared";
            19 APPROACH: "soft start: step a tick";
            20 HOMING_DUTY: "homing: duty";
            21 HOMING_STOP: "homing: count of the stop";
            22 RCP_GAIN: "RCP: gain";
            23 RCP_TICK: "RCP: decay in a tick";
            24 RCP_HALF: "RCP: decay in half a tick";
            25 RCP_SLOW: "RCP: whether it is slow";
            26 CIA_GAIN: "CIA: gain";
            27 CIA_TICK: "CIA: decay in a tick";
            28 CIA_HALF: "CIA: decay in half a tick";
            29 CIA_SLOW: "CIA: whether it is slow";
            30 NOISE: "oscillators: noise";
            31 EULER_RELAX: "oscillators (euler): pull to the circle";
            32 EULER_TURN: "oscillators (euler): turn in a tick";
            33 EULER_COUPLE: "oscillators (euler): coupling";
            34 EULER_SPRING: "muscles (euler): spring";
            35 EULER_DAMPING: "muscles (euler): damping";
            36 TURN_TICK: "oscillators: a tick, mean, 1st of 6";
            42 TURN_HALF: "oscillators: half a tick, mean, 1st of 6";
            48 TURN_BACK: "oscillators: half a tick back, mean, 1st of 6";
            54 DRIVE: "oscillators: drive, mean, 1st of 4";
            58 RELAX: "oscillators: pull to the circle";
            59 HALF_RELAX: "oscillators: half the pull";
            60 SLOW_LAG: "muscles: slow lag, 1st of 5";
            65 FAST_LAG: "muscles: fast lag, 1st of 5";
        }
    };
}

/// Above the largest number.
pub const TUNABLE_COUNT: usize = 70;

macro_rules! constants {
    ($($number:literal $constant:ident: $name:literal;)*) => {
        /// The number of each constant, or of the first of some.
        pub mod number {
            $(#[doc = $name]
            pub const $constant: u8 = $number;)*
        }

        const TABLE: &[(u8, &str)] = &[$(($number, $name)),*];
    };
}
tunable_table!(constants);

/// What a constant is, or the first of those that it belongs to; empty for 0.
pub fn tunable_name(number: u8) -> &'static str {
    let found = TABLE.iter().rev().find(|(first, _)| *first <= number);
    found.map_or("", |(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::{TABLE, TUNABLE_COUNT, tunable_name};

    #[test]
    fn numbers_rise_and_have_their_names() {
        assert!(TABLE.is_sorted_by(|(a, _), (b, _)| a < b));
        let last = TABLE.last().map(|(number, _)| usize::from(*number));
        assert_eq!(last.map(|last| last + 5), Some(TUNABLE_COUNT));
        assert_eq!(tunable_name(6), "position control: kp");
        assert_eq!(tunable_name(41), "oscillators: a tick, mean, 1st of 6");
        assert_eq!(tunable_name(0), "");
    }
}
