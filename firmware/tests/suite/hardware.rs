//! Hardware that is always the same.

use firmware::{
    BusError, Clock, Config, FrameSource, Hardware, HeadConfig, Module, Sample, SampleClassifier,
    SensingConfig, SensorKind, SensorLimits, WhiskerParts, WordSource,
};
use mlx90333::{FRAME_LEN, Faults, SumRule, Word, encode};
use tactile::{ClassSetting, Decision, RuleSettings};
use whisking::{Real, filter};

use crate::command::{Kept, Still};

/// A bad frame is bridged, and a good one ends the fault.
pub(crate) const AT_ONCE: SensorLimits = SensorLimits {
    hold: 1,
    ..SensorLimits::ANY
};

pub(crate) fn feeling<R: Real>(contact: Option<filter::Config<R>>) -> Config<R> {
    let still = Config::still();
    Config {
        head: HeadConfig {
            sides: 2,
            whiskers_per_side: 2,
            ..still.head.clone()
        },
        sensor: SensingConfig {
            kind: SensorKind::FastMlx90333,
            rest_us: 50,
            decoder: mlx90333::Decoder::new(),
            self_motion: None,
            limits: AT_ONCE,
        },
        contact,
        ..still
    }
}

/// Left side first.
pub(crate) fn passive<R: Real, S: WordSource>(
    config: &Config<R>,
    sources: impl IntoIterator<Item = S>,
) -> Module<R, Toy<S>> {
    let parts = sources.into_iter().map(|source| WhiskerParts {
        source,
        motor: None,
    });
    Module::new(config, parts, None, (NoClock, 0))
}

pub(crate) struct Toy<S>(S);

impl<S: WordSource> Hardware for Toy<S> {
    type Source = S;
    type Motor = Kept;
    type Angle = Still;
    type Classifier = NoClassifier;
    type Clock = NoClock;
}

pub(crate) struct NoClassifier;

impl SampleClassifier for NoClassifier {
    fn push(&mut self, _: usize, _: Sample) -> Option<Decision> {
        None
    }

    fn knows_touches(&self) -> bool {
        false
    }

    fn interrupt(&mut self, _: usize) {}

    fn reset(&mut self) {}

    fn set_rule(&mut self, _: &RuleSettings, _: &[ClassSetting]) {}
}

pub(crate) struct Bent(pub(crate) u16);

impl FrameSource for Bent {
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        let x = Word::new(self.0);
        Ok(Some(encode::alpha_beta(
            x,
            Word::MID,
            Faults::NONE,
            SumRule::SumB1B6,
        )))
    }
}

pub(crate) struct NoClock;

impl Clock for NoClock {
    fn now(&mut self) -> u32 {
        0
    }
}
