//! From the records of one side to samples, as the module's own classifier gets them, and from
//! those of a label to touches and the trials that they make.

use host_sim::recording::{GATE, Stream};
use tactile::TouchDetector;
use wire::{Flags, TickRecord};

use super::alike::Felt;
use crate::sample::Sample;
use crate::tally::Before;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sampled {
    pub(crate) codes: [u16; 2],
    pub(crate) contact: f64,
    /// The number of the touch, as soon as it is sure; 0 in the air.
    pub(crate) touch: u16,
}

impl Sampled {
    /// Whether nothing is touched, nor was within the memory of contact.
    pub(crate) fn is_in_the_air(&self) -> bool {
        self.touch == 0 && self.contact < GATE
    }
}

/// A record as a sample; nothing while the whisker has a fault. Touches are numbered by the same rule
/// from the same codes as the module does, of whose touches a record says only that there is one, and
/// where nothing classifies not even that.
pub(crate) fn sampled(
    touches: &mut TouchDetector,
    record: &TickRecord,
    before: Before,
) -> Option<Sampled> {
    let is_valid = record.flags.contains(Flags::VALID);
    if before != Before::Nothing || !is_valid {
        touches.interrupt();
    }
    if !is_valid {
        return None;
    }
    let Sample { codes, contact, .. } = Sample::new(record, 0.0);
    let number = touches.step(codes).number;
    let touch = if touches.is_sure() { number } else { 0 };
    Some(Sampled {
        codes,
        contact,
        touch,
    })
}

/// Touches of a trial: at the usual 2 Hz of whisking 2.5 s.
const OF_TRIAL: u32 = 5;

#[derive(Debug, Default)]
pub(crate) struct Touches {
    label: String,
    /// Trials that are full, and the one that goes on.
    streams: Vec<Stream>,
    trial: u64,
    of_trial: u32,
    /// Number and samples of the touch that goes on.
    present: Option<(u16, Felt)>,
    /// Samples of the trial before that touch.
    before: usize,
    /// Touches with contact that have ended.
    pub(crate) felt: Vec<Felt>,
    /// Touches that have ended without any: they do not count.
    pub(crate) without_contact: u32,
}

impl Touches {
    pub(crate) fn new(label: &str, trial: u64) -> Self {
        let mut touches = Self {
            label: label.to_owned(),
            trial,
            ..Self::default()
        };
        touches.begin();
        touches
    }

    fn begin(&mut self) {
        self.streams.push(Stream {
            label: self.label.clone(),
            trial: self.trial.to_string(),
            samples: Vec::new(),
            contact: Some(Vec::new()),
            touch: Some(Vec::new()),
            pose: None,
            stands: None,
        });
        self.trial += 1;
        self.of_trial = 0;
    }

    /// Takes a sample; whether a touch that counts has ended before it.
    pub(crate) fn take(&mut self, sample: &Sampled) -> bool {
        let goes_on = |(number, _): &mut (u16, Felt)| *number != sample.touch;
        let ended = self.present.take_if(goes_on);
        let has_ended = ended.is_some_and(|(_, felt)| self.end(felt));
        if has_ended && self.of_trial == OF_TRIAL {
            self.begin();
        }
        if let Some(stream) = self.streams.last_mut() {
            if self.present.is_none() {
                self.before = stream.samples.len();
            }
            stream.samples.push(sample.codes.map(f64::from));
            stream.contact.get_or_insert_default().push(sample.contact);
            stream.touch.get_or_insert_default().push(sample.touch);
        }
        if sample.touch != 0 {
            let (_, felt) = self.present.get_or_insert((sample.touch, Felt::default()));
            if sample.contact >= GATE {
                felt.take(sample.codes);
            }
        }
        has_ended
    }

    fn end(&mut self, felt: Felt) -> bool {
        let counts = felt.samples() > 0;
        if counts {
            self.of_trial += 1;
            self.felt.push(felt);
        } else {
            self.without_contact += 1;
        }
        counts
    }

    /// Samples are missing: the touch that goes on is none, and what comes is another trial.
    pub(crate) fn interrupt(&mut self) {
        let was_touched = self.present.take().is_some();
        if let Some(stream) = self.streams.last_mut() {
            let is_cut = !stream.samples.is_empty();
            let kept = match was_touched {
                // What is of the air alone is of no use.
                _ if self.of_trial == 0 => 0,
                true => self.before,
                false => stream.samples.len(),
            };
            stream.samples.truncate(kept);
            stream.contact.get_or_insert_default().truncate(kept);
            stream.touch.get_or_insert_default().truncate(kept);
            if is_cut && kept > 0 {
                self.begin();
            }
        }
    }

    pub(crate) fn into_streams(mut self) -> Vec<Stream> {
        if self.of_trial == 0 {
            self.streams.pop();
        }
        self.streams
    }
}

/// How many touches with contact the streams of a label have.
pub(crate) fn count<'s>(streams: impl Iterator<Item = &'s Stream>) -> usize {
    let mut found = 0;
    for stream in streams {
        let mut last = 0;
        // Without a column each run of contact is one.
        for touch in stream.touches(GATE, 1).filter(|touch| *touch != 0) {
            found += usize::from(touch != last);
            last = touch;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{OF_TRIAL, Sampled, Touches, count};

    fn sample(touch: u16, contact: f64) -> Sampled {
        Sampled {
            codes: [8192 + touch, 8192],
            contact,
            touch,
        }
    }

    #[test]
    fn touches_count_with_contact_and_make_trials() {
        let mut touches = Touches::new("felt", 3);
        let mut ended = Vec::new();
        for touch in 1..=OF_TRIAL as u16 + 1 {
            let samples = [(0, 0.0), (touch, 0.0), (touch, 0.1), (0, 0.2)];
            for (n, (number, contact)) in samples.into_iter().enumerate() {
                // The second touch has no contact.
                let contact = if touch == 2 { 0.0 } else { contact };
                if touches.take(&sample(number, contact)) {
                    ended.push((touch, n));
                }
            }
        }
        touches.take(&sample(9, 0.1));
        assert_eq!(ended, [1, 3, 4, 5, 6].map(|touch| (touch, 3)));
        assert_eq!((touches.felt.len(), touches.without_contact), (5, 1));
        let streams = touches.into_streams();
        // The last trial, with a touch that goes on, has none that counts.
        assert_eq!(streams.len(), 1);
        assert_eq!(streams[0].trial, "3");
        assert_eq!(count(streams.iter()), 5);
    }
}
