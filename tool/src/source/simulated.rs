//! A module that is simulated: `host-sim`'s.

use firmware::{Event, Place, faults};
use host_sim::Error;
use host_sim::commands::run::Loaded;
use host_sim::origin::Origin;
use host_sim::run::Run;
use scene::Scene;
use wire::TaggedCommand;

use super::texture::texture;
use super::{Heard, Source};

/// A scene's module on this PC.
pub(super) struct Simulated {
    scene: Scene,
    run: Run,
}

impl Simulated {
    pub(super) fn open(loaded: &Loaded) -> Result<Self, Error> {
        Ok(Self {
            run: Run::new(&loaded.scene, loaded.classifier()?)?,
            scene: loaded.scene.clone(),
        })
    }

    /// What a board would log of the last tick.
    fn lines(&self) -> Vec<String> {
        let t_s = self.now();
        let events = self.run.events().iter().filter_map(line);
        let mut lines: Vec<_> = events.map(|line| format!("{t_s:.3} {line}")).collect();
        lines.extend(self.run.decisions().map(|decided| {
            format!(
                "{t_s:.3} INFO  decision: {}, posterior {:.4} %, {} samples",
                decided.decision,
                100.0 * decided.posterior,
                decided.samples
            )
        }));
        lines
    }

    fn now(&self) -> f64 {
        self.run.row().t_s
    }
}

/// A line of the log about an event; decisions have names, which it does not know.
fn line(event: &Event) -> Option<String> {
    let of = |place: Place| format!("{} {}", place.side_name(), place.whisker);
    let fault = |place, number| {
        let name = faults::name(number);
        format!("ERROR {}: fault {number}, {name}", of(place))
    };
    Some(match *event {
        Event::Touch { number, .. } => format!("INFO  touch {number}"),
        Event::TouchEnd { number, .. } => format!("INFO  touch {number} has ended"),
        Event::SensorLost(place, why) => fault(place, why.code()),
        Event::MotorFault(place, why) => fault(place, why.code()),
        Event::SensorBack(place) => format!("INFO  {}: sensor is back", of(place)),
        Event::MotorRetry(place) => format!("INFO  {}: motor is tried again", of(place)),
        Event::MotorGivenUp(place) => {
            format!("ERROR {}: motor off until armed", of(place))
        }
        Event::Decision(..) => return None,
    })
}

impl Source for Simulated {
    fn next(&mut self) -> Result<Heard, Error> {
        self.run.tick();
        Ok(Heard {
            packets: self.run.module_mut().take_packets(),
            lines: self.lines(),
        })
    }

    fn request(&mut self, request: TaggedCommand) -> Result<(), Error> {
        self.run.module_mut().request(request);
        Ok(())
    }

    fn has(&self, sample: &str) -> Result<(), Error> {
        texture(sample, &self.scene).map(drop)
    }

    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        self.run.lay(texture(sample, &self.scene)?);
        Ok(())
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        Ok(self.run.is_laid())
    }

    fn now_s(&mut self) -> f64 {
        self.now()
    }

    fn duration_s(&self) -> Option<f64> {
        Some(self.scene.duration_s)
    }

    fn origin(&self) -> Origin {
        Origin::default()
            .with("board", "simulated")
            .with("firmware", env!("CARGO_PKG_VERSION"))
    }
}
