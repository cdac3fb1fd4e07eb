//! What a sensor's frames say of how it sends them, whatever the module takes them for.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use mlx90333::{ByteOrder, Decoder, FRAME_LEN, Faults, Mode, START_BYTE, SumRule};
use serde::Serialize;

/// Rules that look at the sum, with their words in a scene.
const RULES: [(SumRule, &str); 4] = [
    (SumRule::SumB1B6, "b1-b6"),
    (SumRule::SumB0B6, "b0-b6"),
    (SumRule::ComplementB1B6, "not-b1-b6"),
    (SumRule::ComplementB0B6, "not-b0-b6"),
];
/// Of a hundred frames a good line spoils fewer.
const CLEAN: f64 = 0.99;
/// By so much words change more from frame to frame when their bytes are exchanged.
const ROUGHER: f64 = 4.0;

pub(crate) type Frame = [u8; FRAME_LEN];

/// Frames of one sensor, one after the other, as they came.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Seen {
    pub(crate) frames: usize,
    /// All ones, all zeros, and others that do not begin as a frame does.
    pub(crate) silent: usize,
    pub(crate) low: usize,
    pub(crate) bad_start: usize,
    pub(crate) kept: Vec<(&'static str, usize)>,
    pub(crate) sum_rule: Option<&'static str>,
    pub(crate) words: Option<&'static str>,
    pub(crate) byte_order: Option<&'static str>,
    /// All bits of the error words, where the frames have such.
    pub(crate) reports: Option<u16>,
    /// Root mean square of the change of each word from one frame to the next, codes.
    pub(crate) change_codes: [f64; 2],
    /// Share of frames whose words are those of the frame before.
    pub(crate) repeated: f64,
    #[serde(skip)]
    decoder: Decoder,
}

impl Seen {
    pub(crate) fn of(frames: &[Frame]) -> Self {
        let count = |all: Frame| frames.iter().filter(|frame| **frame == all).count();
        let [silent, low] = [u8::MAX, 0].map(|byte| count([byte; FRAME_LEN]));
        // All ones begin as a frame does.
        let is_frame = |frame: &&Frame| frame[0] == START_BYTE && **frame != [u8::MAX; FRAME_LEN];
        let begun: Vec<_> = frames.iter().filter(is_frame).copied().collect();
        let bad_start = frames.len() - silent - low - begun.len();
        let keeps = |rule: SumRule, frame: &Frame| rule.expected(frame) == Some(frame[7]);
        let kept = RULES.map(|(rule, _)| begun.iter().filter(|frame| keeps(rule, frame)).count());
        let most = kept.iter().max().copied().unwrap_or_default();
        let is_clean = most > 0 && most as f64 >= CLEAN * begun.len() as f64;
        // Two that fit alike are not told apart by these frames.
        let is_alone = kept.iter().filter(|kept| **kept == most).count() == 1;
        let found = kept.iter().position(|kept| *kept == most);
        let rule = found.filter(|_| is_clean && is_alone).map(|at| RULES[at]);
        let mut good = begun;
        good.retain(|frame| rule.is_none_or(|(rule, _)| keeps(rule, frame)));
        let changes = |order| change(&good, order);
        let [low_first, high_first] = [ByteOrder::Little, ByteOrder::Big].map(changes);
        let [smooth, rough] = [low_first, high_first].map(|[x, y]| x.hypot(y));
        let order = if smooth * ROUGHER < rough {
            Some((ByteOrder::Little, "low-first"))
        } else if rough * ROUGHER < smooth {
            Some((ByteOrder::Big, "high-first"))
        } else {
            None
        };
        let decoder_order = order.map_or(ByteOrder::Little, |(order, _)| order);
        let third = |frame: &Frame| decoder_order.number([frame[5], frame[6]]);
        let thirds: BTreeSet<u16> = good.iter().map(third).collect();
        // A field has bits that stand for no fault.
        let is_report = |word: &u16| Faults::new(*word).unknown() == 0;
        let mode = if thirds.is_empty() {
            None
        } else if thirds.iter().all(is_report) {
            Some((Mode::AlphaBeta, "alpha-beta"))
        } else {
            Some((Mode::Xyz, "xyz"))
        };
        let all_bits = thirds.iter().fold(0, |all, word| all | word);
        let repeats = good.windows(2).filter(|pair| pair[0] == pair[1]).count();
        Self {
            frames: frames.len(),
            silent,
            low,
            bad_start,
            kept: RULES.iter().map(|(_, name)| *name).zip(kept).collect(),
            sum_rule: rule.map(|(_, name)| name),
            words: mode.map(|(_, name)| name),
            byte_order: order.map(|(_, name)| name),
            reports: match mode {
                Some((Mode::AlphaBeta, _)) => Some(all_bits).filter(|bits| *bits != 0),
                _ => None,
            },
            change_codes: match decoder_order {
                ByteOrder::Little => low_first,
                ByteOrder::Big => high_first,
            },
            repeated: repeats as f64 / (good.len().max(2) - 1) as f64,
            decoder: Decoder {
                mode: mode.map_or(Mode::AlphaBeta, |(mode, _)| mode),
                sum_rule: rule.map_or(SumRule::Ignore, |(rule, _)| rule),
                byte_order: decoder_order,
            },
        }
    }

    pub(crate) const fn begun(&self) -> usize {
        self.frames - self.silent - self.low - self.bad_start
    }

    pub(crate) fn is_silent_at_times(&self) -> bool {
        self.begun() > 0 && self.share(self.silent) > 1.0 - CLEAN
    }

    fn share(&self, count: usize) -> f64 {
        count as f64 / self.frames.max(1) as f64
    }

    /// What is not as the module takes it, and what to do; empty where all is well.
    pub(crate) fn findings(&self, takes: Decoder) -> Vec<String> {
        let mut found = Vec::new();
        if self.begun() == 0 && self.silent > 0 {
            found.push(format!(
                "{} frames are all ones, so nothing answers. At the sensor, with an oscilloscope: 5 V at \
                 its supply; /SS, which must fall and rise in each tick (one that never rises looks \
                 like this too); SCLK; the data line, which the sensor must pull low",
                self.silent
            ));
        }
        if self.share(self.low) > 1.0 - CLEAN {
            found.push(format!(
                "{} frames are all zeros: the sensor has no supply, the data line has no pull-up, or \
                 something holds it low",
                self.low
            ));
        }
        if self.share(self.bad_start) > 1.0 - CLEAN {
            found.push(format!(
                "{} frames do not begin with ff: slow edges, a clock that is too fast, or gaps that \
                 are too short; a lower tick_hz has longer gaps",
                self.bad_start
            ));
        }
        if !found.is_empty() {
            return found;
        }
        if self.sum_rule.is_none() {
            let fault = "no rule fits the sum of nearly all frames, or two do alike: noise on the \
                         line, or a magnet that stands still; move it and look again";
            found.push(fault.to_owned());
        }
        let own = self.decoder;
        if let Some(rule) = self.sum_rule.filter(|_| own.sum_rule != takes.sum_rule) {
            found.push(format!(
                "the sum is another than the scene has: set sensor.sum_rule = \"{rule}\""
            ));
        }
        if let Some(order) = self
            .byte_order
            .filter(|_| own.byte_order != takes.byte_order)
        {
            found.push(format!(
                "words come in the other order than the scene has: set sensor.byte_order = \
                 \"{order}\""
            ));
        }
        if let Some(words) = self.words.filter(|_| own.mode != takes.mode) {
            found.push(format!(
                "the third word is not what the scene takes it for: set sensor.words = \"{words}\", \
                 or the other mode in the sensor's EEPROM"
            ));
        }
        if let Some(word) = self.reports {
            found.push(format!(
                "the sensor reports {}: the magnet, and its distance",
                Faults::new(word)
            ));
        }
        found
    }

    pub(crate) fn text(&self) -> String {
        let mut text = format!(
            "{} frames: {} all ones, {} all zeros, {} with another start",
            self.frames, self.silent, self.low, self.bad_start
        );
        if self.begun() == 0 {
            return text;
        }
        let unknown = "not certain";
        for (rule, kept) in &self.kept {
            // Writing to a string does not fail.
            let _ = write!(text, "\nsum {rule}: fits {kept}");
        }
        let [x, y] = self.change_codes;
        let _ = write!(
            text,
            "\nsum rule {}; words {}; byte order {}\nfrom frame to frame x changes by {x:.1}, y by \
             {y:.1} codes; {:.0} % repeat",
            self.sum_rule.unwrap_or(unknown),
            self.words.unwrap_or(unknown),
            self.byte_order.unwrap_or(unknown),
            100.0 * self.repeated
        );
        text
    }
}

/// By how much each of the first two words changes from frame to frame, codes, root mean square.
fn change(frames: &[Frame], order: ByteOrder) -> [f64; 2] {
    let word = |frame: &Frame, at| f64::from(order.number([frame[at], frame[at + 1]]) >> 2);
    [1, 3].map(|at| {
        let pairs = frames.windows(2);
        let squares = pairs.map(|pair| (word(&pair[1], at) - word(&pair[0], at)).powi(2));
        let count = frames.len().max(2) - 1;
        (squares.sum::<f64>() / count as f64).sqrt()
    })
}

#[cfg(test)]
mod tests {
    use mlx90333::{ByteOrder, Decoder, FRAME_LEN, Mode, encode};
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::{Frame, RULES, Seen};

    /// A magnet that swings, with noise of a code or two, as this decoder takes it.
    fn swinging(decoder: Decoder, phase: f64) -> Vec<Frame> {
        let words = (0..400).map(|n| {
            let angle = 0.05 * f64::from(n) + phase;
            let noise = (n * 7919 % 13) as u16;
            let x = (32_768.0 + 3_000.0 * angle.sin()) as u16 + noise;
            let y = (32_768.0 + 500.0 * (1.3 * angle).cos()) as u16 + noise;
            let z = match decoder.mode {
                Mode::AlphaBeta => 0,
                // One that stands still, as that of a magnet on the axis.
                Mode::Xyz => 0x8000 + (noise & 1),
            };
            encode::words([x, y, z], decoder)
        });
        words.collect()
    }

    fn decoder() -> impl Strategy<Value = Decoder> {
        let rules = RULES.map(|(rule, _)| rule).to_vec();
        let modes = vec![Mode::AlphaBeta, Mode::Xyz];
        let orders = vec![ByteOrder::Little, ByteOrder::Big];
        let parts = (select(rules), select(modes), select(orders));
        parts.prop_map(|(sum_rule, mode, byte_order)| Decoder {
            mode,
            sum_rule,
            byte_order,
        })
    }

    proptest! {
        #[test]
        fn how_a_sensor_sends_is_found_and_what_the_module_takes_otherwise_is_named(
            sent in decoder(),
            taken in decoder(),
            phase in 0.0..6.0,
        ) {
            let seen = Seen::of(&swinging(sent, phase));
            prop_assert_eq!(seen.decoder, sent);
            prop_assert_eq!(seen.findings(sent), Vec::<String>::new());
            let found = seen.findings(taken);
            let names = |key: &str| found.iter().any(|found| found.contains(key));
            prop_assert_eq!(names("sum_rule"), sent.sum_rule != taken.sum_rule);
            prop_assert_eq!(names("byte_order"), sent.byte_order != taken.byte_order);
            prop_assert_eq!(names("sensor.words"), sent.mode != taken.mode);
        }
    }

    #[test]
    fn silence_a_short_and_a_report_are_found() {
        let says = |frames: &[Frame], what: &str| {
            let found = Seen::of(frames).findings(Decoder::new());
            assert!(found.iter().any(|found| found.contains(what)), "{found:?}");
        };
        says(&[[0xFF; FRAME_LEN]; 50], "nothing answers");
        says(&[[0; FRAME_LEN]; 50], "no supply");
        says(&[[0xFE; FRAME_LEN]; 50], "do not begin with ff");
        let mut each_second = swinging(Decoder::new(), 1.0);
        for frame in each_second.iter_mut().step_by(2) {
            *frame = [0xFF; FRAME_LEN];
        }
        let seen = Seen::of(&each_second);
        assert!(seen.is_silent_at_times());
        assert_eq!(seen.findings(Decoder::new()), Vec::<String>::new());
        assert!(!Seen::of(&[[0xFF; FRAME_LEN]; 50]).is_silent_at_times());
        let low = |n: u16| encode::words([30_000 + n, 32_768, 0x0080], Decoder::new());
        let low: Vec<_> = (0..50).map(low).collect();
        says(&low, "field too low");
    }
}
