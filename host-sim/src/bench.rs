//! A module of any scene behind one interface: the firmware's [`firmware::Module`] on mock hardware.

mod board;
pub mod can;
mod head;
mod line;
mod sensor;

use config::{Mismatch, NumberFormat, RunsOn, Target};
use firmware::{Command, Config, Event, NotDone, Packet};
use scene::Scene;
use tactile::ClassList;
use whisking::{Fix, Number};
use wire::TaggedCommand;

use crate::Error;
use crate::bus::OnWire;
use crate::classifier::{Classifier, Tap};
use crate::motor::Pins;
pub use board::NoClock;
pub use can::Load;
use head::Head;
pub use head::{Bus, Happened};

/// What a module shows of itself after a tick. Values of a side that does not exist are NaN.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Snapshot {
    /// θ' of every whisker, left side first, degrees.
    pub theta_deg: Vec<f64>,
    /// z of each side.
    pub z: [f64; 2],
    /// g of the first whisker of each side.
    pub g: [f64; 2],
    /// Contact π of each side.
    pub contact: [f64; 2],
    /// The number of the touch of the first whisker of each side; 0 in the air, and where
    /// it is not heard.
    pub touch: [u16; 2],
}

/// A module as a run sees it.
pub trait Bench {
    /// One tick.
    fn tick(&mut self, events: &mut Vec<Event>);

    /// Fills in `snapshot`; `theta_deg` has a place for every whisker.
    fn look(&mut self, snapshot: &mut Snapshot);

    /// The sensor of whisker `n`, counted from 0, left side first.
    fn sensor_mut(&mut self, n: usize) -> Option<OnWire<'_>>;

    /// Contact π of whisker `n`, counted from 0, left side first; none: that of its side is
    /// all that is known.
    fn felt_by(&self, _n: usize) -> Option<f64> {
        None
    }

    /// Whether whisker `n`, counted from 0, left side first, is being homed.
    fn is_homing(&self, _n: usize) -> bool {
        false
    }

    /// Whether its events tell of faults.
    fn tells_faults(&self) -> bool {
        true
    }
}

/// The firmware's module on this machine.
pub trait HostModule: Bench + Send {
    /// Starts again with another seed, on these ends of the motors' wires.
    ///
    /// # Errors
    /// [`Error::Work`] if there are not as many as whiskers.
    fn restart(&mut self, seed: u64, pins: Vec<Pins>) -> Result<(), Error>;

    /// Carries out `command` for whisker `n`, counted from 0, left side first.
    ///
    /// # Errors
    /// As [`firmware::Module::command`].
    fn command(&mut self, n: usize, command: Command<f64>) -> Result<(), NotDone>;

    /// Arms the motors or keeps them off, from the next tick on.
    fn arm(&mut self, is_armed: bool);

    /// What the classifier gets.
    fn tap(&mut self) -> Option<&mut Tap>;

    /// Carries out `request` before the next tick.
    fn request(&mut self, request: TaggedCommand);

    /// Has requests go to this board of several, and takes what that has sent; at first the one with
    /// number 0.
    fn talk_with(&mut self, board: usize);

    /// Has another board of its head carry out `request`; whether it has one of that number.
    fn request_of(&mut self, board: usize, request: TaggedCommand) -> bool;

    /// What it has sent since the last call, and answers of other boards.
    fn take_packets(&mut self) -> Vec<Packet>;

    /// The bus of a head of several boards; none where one board has all whiskers.
    fn bus(&mut self) -> Option<&mut Bus>;
}

/// How many whiskers of a scene are heard by its classifier.
pub fn heard(scene: &Scene) -> usize {
    let all = scene.whiskers();
    let classifier = scene.classifier.as_ref();
    classifier.map_or(1, |classifier| classifier.whiskers.heard(all))
}

/// Makes the module of `scene`: its motors on `pins`, left side first (none
/// where the whiskers are passive), the samples of its whiskers going to `classifier`.
///
/// # Errors
/// [`Error::Work`] if the parts do not fit the scene, [`Error::Input`] if the
/// scene's position control is unstable.
pub fn build(
    scene: &Scene,
    pins: &[Pins],
    classifier: Option<Classifier>,
) -> Result<Box<dyn HostModule>, Error> {
    Ok(match config::in_simulation(scene) {
        NumberFormat::Double => Box::new(Head::<f64>::new(scene, pins, classifier)?),
        NumberFormat::Fixed => Box::new(Head::<Fix>::new(scene, pins, classifier)?),
        NumberFormat::Single => Box::new(Head::<f32>::new(scene, pins, classifier)?),
    })
}

fn broken(mismatch: Mismatch) -> Error {
    match mismatch {
        Mismatch::Unstable(_)
        | Mismatch::Unbearable(_)
        | Mismatch::Unsettled(_)
        | Mismatch::Gate { .. }
        | Mismatch::Threshold { .. }
        | Mismatch::Classes { .. } => Error::Input(mismatch.to_string()),
        mismatch => Error::Work(mismatch.to_string()),
    }
}

/// The configuration of the simulated module of `scene`, which decides by a model with this
/// contact and these classes, if any, or records for one.
///
/// # Errors
/// What is wrong with the scene for it.
pub fn config_of<R: Number>(
    scene: &Scene,
    (gate, classes): (Option<f32>, Option<&ClassList>),
    records: bool,
    overrides: &str,
) -> Result<Config<R>, Error> {
    let target = Target {
        runs_on: RunsOn::Simulation { records },
        gate,
        classes,
        overrides,
    };
    config::build(scene, target).map_err(broken)
}
