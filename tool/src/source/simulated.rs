//! A module that is simulated: `host-sim`'s.

use firmware::boards::NUCLEO_F446RE;
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
use super::texture::texture;
use super::{Heard, Source};
use crate::deployment::Deployment;

/// A scene's module on this PC.
pub(super) struct Simulated {
    loaded: Loaded,
    flash: Flash,
    run: Run,
    /// Lines that it has logged before its first tick.
    first: Vec<String>,
}

/// Bytes for a model, as the NUCLEO-F446RE has them.
const ROOM: usize = NUCLEO_F446RE.flash.slots[0].model.bytes as usize;

impl Simulated {
    pub(super) fn open(mut loaded: Loaded, flash: Flash) -> Result<Self, Error> {
        let flash = flash.of_size(ROOM)?;
        let mut first = Vec::new();
        if loaded.scene.awaits_model() {
            let found = deployed(flash.contents(), &loaded.scene, NUCLEO_F446RE.max_classes)?;
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

    fn deploy(&mut self, what: &Deployment) -> Result<(), Error> {
        let Some(loaded) = &what.loaded else {
            let fault = "a simulated module is made from its scene: --scene FILE says which";
            return Err(Error::Input(fault.to_owned()));
        };
        if self.flash.is_kept() && loaded.scene.name != self.loaded.scene.name {
            let fault = "--flash keeps the model of a simulated module, and not its scene, which \
                         is that of --sim SCENE";
            return Err(Error::Input(fault.to_owned()));
        }
        let run = Run::new(&loaded.scene, loaded.classifier()?)?;
        let model = what.model.as_ref();
        self.flash
            .program(model.map_or(&[], |model| model.as_bytes()))?;
        self.first = match model {
            _ if loaded.scene.classifier.is_none() => Vec::new(),
            Some(model) => told(&Ok(model.clone())),
            None => told(&Err(Refusal::Absent)),
        };
        self.loaded = loaded.clone();
        self.run = run;
        Ok(())
    }
}
