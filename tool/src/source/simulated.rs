//! A module that is simulated: `host-sim`'s.

use std::path::Path;

use firmware::faults::{self, number};
use firmware::{Event, Place, Refusal};
use host_sim::Error;
use host_sim::classifier::deployed;
use host_sim::loaded::Loaded;
use host_sim::origin::Origin;
use host_sim::run::Run;
use tactile::ModelBuf;
use wire::TaggedCommand;

use super::flash::Flash;
use super::room::{ModelRoom, fits};
use super::texture::texture;
use super::{Heard, Source};

/// A scene's module on this PC.
pub(super) struct Simulated {
    loaded: Loaded,
    flash: Flash,
    run: Run,
    /// Lines that it has logged before its first tick.
    first: Vec<String>,
}

/// As the NUCLEO-F446RE has it.
const ROOM: ModelRoom = ModelRoom {
    bytes: 128 * 1024,
    classes: 16,
};

impl Simulated {
    pub(super) fn open(mut loaded: Loaded, flash: Flash) -> Result<Self, Error> {
        let flash = flash.of_size(ROOM.bytes)?;
        let mut first = Vec::new();
        if loaded.scene.awaits_model() {
            let found = deployed(flash.contents(), &loaded.scene, ROOM.classes)?;
            first = told(&found);
            loaded = loaded.with_deployed(flash.name(), found.ok());
        }
        Ok(Self {
            run: Run::new(&loaded.scene, loaded.classifier()?)?,
            loaded,
            flash,
            first,
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

/// What a board would log of the model that it has found.
fn told(found: &Result<ModelBuf, Refusal>) -> Vec<String> {
    let at_start = |line: String| format!("0.000 {line}");
    let lines = match found {
        Ok(model) => vec![format!(
            "INFO  decides by model {:08x}, {} classes",
            model.crc(),
            model.classes()
        )],
        Err(refusal) => vec![
            format!(
                "WARN  limit {}, {}",
                number::NO_MODEL,
                faults::name(number::NO_MODEL)
            ),
            format!("WARN  - {}", refusal.text()),
        ],
    };
    lines.into_iter().map(at_start).collect()
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
        Event::ZeroMoved(place, [x, y]) => {
            format!("INFO  {}: zero moved to x {x}, y {y} codes", of(place))
        }
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
        let mut lines = std::mem::take(&mut self.first);
        lines.extend(self.lines());
        Ok(Heard {
            packets: self.run.module_mut().take_packets(),
            lines,
        })
    }

    fn request(&mut self, request: TaggedCommand) -> Result<(), Error> {
        self.run.module_mut().request(request);
        Ok(())
    }

    fn has(&self, sample: &str) -> Result<(), Error> {
        texture(sample, &self.loaded.scene).map(drop)
    }

    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        self.run.lay(texture(sample, &self.loaded.scene)?);
        Ok(())
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        Ok(self.run.is_laid())
    }

    fn now_s(&mut self) -> f64 {
        self.now()
    }

    fn duration_s(&self) -> Option<f64> {
        Some(self.loaded.scene.duration_s)
    }

    fn origin(&self) -> Origin {
        Origin::default().with("board", "simulated")
    }

    fn takes(&self, path: &Path, model: &ModelBuf) -> Result<(), Error> {
        ROOM.takes("simulated board", path, model)?;
        fits(&self.loaded, path, model)
    }

    fn deploy(&mut self, model: &ModelBuf) -> Result<(), Error> {
        self.flash.program(model.as_bytes())?;
        let name = self.flash.name().to_owned();
        let loaded = self.loaded.clone();
        self.loaded = loaded.with_deployed(&name, Some(model.clone()));
        self.first = told(&Ok(model.clone()));
        self.run = Run::new(&self.loaded.scene, self.loaded.classifier()?)?;
        Ok(())
    }
}
