//! When a whisker touches: from the sensor's codes alone, in integers.
//!
//! Glossary:
//!
//! - *deflection*: |x − rest| + |y − rest|, with a rest that follows the codes slowly;
//! - *change*: the same of x\[n\] − x\[n−4\] and y;
//! - *curvature*: the same of x\[n\] − 2 x\[n−2\] + x\[n−4\] and y;
//! - *level* of each of the three: its median in the air;
//! - *contact*: one of them stands out from its level, or did in the last samples;
//! - *touch*: contacts with less than a gap between them.
//!
//! A free whisker that is moved bends by its own inertia, many times further than the
//! sensor's noise: at 8 Hz an elastic one deflects by 2000 codes. So each sign is
//! compared with what the whisker itself has shown in the air, which no scene can know.
//! The three see different contacts: a soft landing changes the deflection, an elastic
//! one rings, which curvature shows at once, and a press that does not move only
//! deflects.
//!
//! # Error
//!
//! In the air the signs reach 9.8, 8.0 and 5.8 times their medians at most (two minutes
//! each of both plants at 2 and 8 Hz); contact begins at 13, 11 and 8 times. These
//! factors, [`FAR`] and the rates were chosen after seeing that.
//!
//! Ten other runs of 40 s and four of ten minutes of air (`host-sim/tests/touches`); the
//! delay is from where what the touch adds reaches three deviations of the sensor's noise:
//!
//! | plant | told, of touches | delay: mean, 90 %, worst | touches told in the air |
//! |---|---|---|---|
//! | textured, 2 Hz | 760 of 760 | 1.8, 2.0, 9.5 ms | 0 a minute |
//! | whisker, 2 Hz | 759 of 760 | 1.0, 1.5, 1.5 ms | 0.35 a minute |
//! | textured, 8 Hz | contacts: all | 7.0, 8.5, 15.0 ms | 0 |
//! | whisker, 8 Hz | contacts: all | 2.2, 2.5, 2.5 ms | 0 |
//!
//! At 8 Hz the whisker still rings from the last contact, and there are less than 100 ms
//! between two: with that gap they are one touch. Not seen: a touch in the first half
//! second; one too many may be told within two seconds of the start.

/// Samples that are kept.
const KEPT: usize = 4;
/// How often its level each sign is at the onset of contact: deflection, change, curvature.
const ONSET: [u32; 3] = [13, 11, 8];
/// Contact ends below half as much.
const HYSTERESIS: u32 = 2;
/// Samples without a sign after which contact ends: between the bounces of a whisker.
const QUIET: u16 = 16;
/// How often its level a deflection is that keeps up a touch while the gate is open. A
/// free whisker, moved as a sine, deflects by at most 2.4 times its median.
const HELD: u32 = 3;
/// How much further a deflection begins a touch, codes, where its level is so large that
/// it moves as a sine.
const FAR: u32 = 1024;
/// Bits of a level below one code.
const FRACTION: u32 = 12;
/// A level moves by 2^−n of itself a sample: in the air, in contact, and at the start.
/// In contact slowly: enough to let go, within seconds, of what is no touch.
const IN_AIR: u32 = 8;
const IN_CONTACT: u32 = 12;
const AT_START: u32 = 5;
/// The rest moves by 2^−n of the difference a sample.
const REST: u32 = 12;
const REST_AT_START: u32 = 8;
/// Samples at the start in which levels are learnt and nothing is touched.
const START: u16 = 1000;

/// What a whisker touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Touching {
    /// The number of the touch, counted from 1 and after 65535 from 1 again; 0 in the air.
    pub number: u16,
    /// It begins with this sample.
    pub is_onset: bool,
}

/// Tells touches from the codes of one whisker's sensor.
#[derive(Debug, Clone)]
pub struct TouchDetector {
    /// The last samples, the newest first.
    kept: [[i32; 2]; KEPT],
    /// x and y at rest, with [`REST`] bits below one code.
    rest: [i32; 2],
    levels: [u32; 3],
    /// Samples of the start that have been, up to [`START`].
    seen: u16,
    in_contact: bool,
    /// Samples since the last sign of contact, and since the last contact.
    quiet: u16,
    apart: u32,
    touching: Touching,
    last: u16,
}

impl Default for TouchDetector {
    fn default() -> Self {
        Self::new()
    }
}

impl TouchDetector {
    /// Before its first sample.
    pub const fn new() -> Self {
        Self {
            kept: [[0; 2]; KEPT],
            rest: [0; 2],
            levels: [4 << FRACTION; 3],
            seen: 0,
            in_contact: false,
            quiet: 0,
            apart: 0,
            touching: Touching {
                number: 0,
                is_onset: false,
            },
            last: 0,
        }
    }

    /// What is touched since the last sample.
    pub const fn touching(&self) -> Touching {
        self.touching
    }

    /// Whether there was contact in the last sample: there and gone within a touch.
    pub const fn in_contact(&self) -> bool {
        self.in_contact
    }

    /// Takes the sensor's codes of 14 bits. `gate` says whether contact π is at least
    /// its least: then a large deflection keeps up a touch, though it begins none. A
    /// touch ends after `gap` samples without contact.
    pub fn step(&mut self, codes: [u16; 2], gate: bool, gap: u32) -> Touching {
        let sample = codes.map(|code| i32::from(code.min(0x3fff)));
        let signs = self.signs(sample);
        self.compare(signs);
        self.learn(sample, signs);
        let [deflection, ..] = signs;
        let is_held = gate && deflection > HELD * (self.levels[0] >> FRACTION);
        self.apart = if self.in_contact || is_held {
            0
        } else {
            self.apart.saturating_add(1)
        };
        self.count(gap);
        self.touching
    }

    /// Deflection, change and curvature, each below 2^17.
    fn signs(&mut self, sample: [i32; 2]) -> [u32; 3] {
        if self.seen == 0 {
            self.kept = [sample; KEPT];
            self.rest = sample.map(|code| code << REST);
        }
        let [_, two, _, four] = self.kept;
        let mut signs = [0; 3];
        for axis in 0..2 {
            let (now, two, four) = (sample[axis], two[axis], four[axis]);
            signs[0] += now.abs_diff(self.rest[axis] >> REST);
            signs[1] += now.abs_diff(four);
            signs[2] += (now + four).abs_diff(2 * two);
        }
        let [one, two, three, _] = self.kept;
        self.kept = [sample, one, two, three];
        signs
    }

    fn compare(&mut self, signs: [u32; 3]) {
        if self.seen < START {
            self.seen += 1;
            return;
        }
        let share = if self.in_contact { HYSTERESIS } else { 1 };
        let levels = self.levels.map(|level| level >> FRACTION);
        let mut limits = [0, 1, 2].map(|sign| ONSET[sign] * levels[sign]);
        limits[0] = limits[0].min(HELD * levels[0] + FAR);
        if signs
            .iter()
            .zip(limits)
            .any(|(sign, limit)| sign * share > limit)
        {
            self.in_contact = true;
            self.quiet = 0;
        } else if self.in_contact {
            self.quiet += 1;
            self.in_contact = self.quiet < QUIET;
        }
    }

    /// Levels take equal steps up and down, by which they become medians; the rest is a
    /// mean. What is touched moves only the levels, and these slowly.
    fn learn(&mut self, sample: [i32; 2], signs: [u32; 3]) {
        let (rate, rest_rate) = match (self.in_contact, self.seen < START) {
            (true, _) => (IN_CONTACT, None),
            (false, true) => (AT_START, Some(REST_AT_START)),
            (false, false) => (IN_AIR, Some(REST)),
        };
        for (level, sign) in self.levels.iter_mut().zip(signs) {
            let step = *level >> rate;
            if sign > *level >> FRACTION {
                // At most 2^30: signs are below 2^17.
                *level += step;
            } else {
                *level = (*level - step).max(1 << FRACTION);
            }
        }
        if let Some(rate) = rest_rate {
            for (rest, code) in self.rest.iter_mut().zip(sample) {
                *rest += ((code << REST) - *rest) >> rate;
            }
        }
    }

    fn count(&mut self, gap: u32) {
        self.touching.is_onset = false;
        if self.touching.number != 0 {
            if self.apart >= gap {
                self.touching.number = 0;
            }
        } else if self.in_contact {
            self.last = self.last.checked_add(1).unwrap_or(1);
            self.touching = Touching {
                number: self.last,
                is_onset: true,
            };
        }
    }
}
