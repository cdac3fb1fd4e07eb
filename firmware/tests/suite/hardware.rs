//! Hardware that is always the same, and a motor that can be turned.

use std::cell::RefCell;
use std::rc::Rc;

use firmware::{
    AngleInput, BusError, Clock, CodeClassifier, Config, FrameSource, Hardware, HeadConfig, Module,
    SensingConfig, SensorLimits, WhiskerParts, WordSource,
};
use mlx90333::{FRAME_LEN, Faults, SumRule, Word, encode};
use whisking::motor::{Duty, Fault, MotorDriver};
use whisking::{Real, filter};

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
            limits: AT_ONCE,
            ..still.sensor
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
    type Motor = Rig;
    type Angle = Rig;
    type Classifier = CodeClassifier;
    type Clock = NoClock;
}

#[derive(Debug, Default)]
pub(crate) struct Turned {
    pub(crate) duty: f64,
    /// Where it is, counts.
    pub(crate) counts: f64,
    pub(crate) stuck_at: Option<i32>,
}

/// A motor and its encoder.
#[derive(Clone, Default)]
pub(crate) struct Rig(pub(crate) Rc<RefCell<Turned>>);

impl Rig {
    pub(crate) fn duty(&self) -> f64 {
        self.0.borrow().duty
    }
}

impl MotorDriver for Rig {
    fn drive(&mut self, duty: Duty) -> Result<(), Fault> {
        self.0.borrow_mut().duty = f64::from(duty.q15()) / 32_767.0;
        Ok(())
    }

    fn off(&mut self) {
        self.0.borrow_mut().duty = 0.0;
    }

    fn clear(&mut self) {}
}

impl AngleInput for Rig {
    fn counts(&mut self) -> i32 {
        let rig = self.0.borrow();
        rig.stuck_at.unwrap_or(rig.counts.round() as i32)
    }
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
