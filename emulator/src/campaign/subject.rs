//! What a campaign asks of where a scene runs, and a scene on this PC.

use firmware::Place;
use host_sim::Error;
use host_sim::bus::Slave;
use host_sim::loaded::Loaded;
use host_sim::motor::SimMotor;
use host_sim::run::Run;
use host_sim::trace::Row;

use crate::chip::{Fault, ResetCause};
use crate::notice::Notice;

/// What can be seen of a tick from outside.
#[derive(Debug, Clone, Default)]
pub(super) struct Seen {
    /// Setpoints and angles.
    pub(super) row: Row,
    /// What the pins ask of each motor, 0 to 1, left side first.
    pub(super) effort: Vec<f64>,
    /// By how much each whisker is displaced from its encoder's count, degrees.
    pub(super) displaced_deg: Vec<f64>,
    /// What the module has reported, and of which whisker.
    pub(super) notices: Vec<(usize, Notice)>,
    /// The whiskers that have decided, and for what.
    pub(super) decisions: Vec<(usize, String)>,
    /// What has reset the chip.
    pub(super) reset: Option<ResetCause>,
    /// The core has not come to the end of a tick in a tick's time.
    pub(super) is_late: bool,
}

impl Seen {
    /// Whether nothing at all differs from `other`.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        // A side that does not exist has values that are not even equal to themselves.
        let bits = |row: &Row| row.pairs().map(|pair| pair.map(f64::to_bits));
        bits(&self.row) == bits(&other.row)
            && self.row.touch == other.row.touch
            && self.effort == other.effort
            && self.displaced_deg == other.displaced_deg
            && self.notices == other.notices
            && self.decisions == other.decisions
            && self.reset == other.reset
            && self.is_late == other.is_late
    }
}

/// A scene that runs. Without a chip there is nothing of one to be changed.
pub(super) trait Subject {
    /// One tick.
    ///
    /// # Errors
    /// What the emulated chip cannot go along with.
    fn tick(&mut self) -> Result<Seen, Fault>;

    /// A whisker's motor; none where motors are ideal.
    fn motor(&mut self, whisker: usize) -> Option<&mut SimMotor>;

    /// A whisker's sensor.
    fn slave(&mut self, whisker: usize) -> Option<&mut Slave>;

    /// Inverts a bit of RAM.
    ///
    /// # Errors
    /// [`Fault`] where there is none.
    fn flip_ram(&mut self, _detail: u64) -> Result<(), Fault> {
        Ok(())
    }

    /// Inverts a bit of a register of the core within the next tick.
    fn flip_core(&mut self, _detail: u64) {}

    /// Inverts a bit of a peripheral's register.
    ///
    /// # Errors
    /// [`Fault`] where there is none.
    fn flip_register(&mut self, _detail: u64) -> Result<(), Fault> {
        Ok(())
    }

    /// Stops the DMA of a sensor.
    ///
    /// # Errors
    /// [`Fault`] where there is none.
    fn stop_dma(&mut self) -> Result<(), Fault> {
        Ok(())
    }

    /// Stops the clock that the chip is fed with.
    ///
    /// # Errors
    /// [`Fault`] where its core stands still for it.
    fn stop_clock(&mut self) -> Result<(), Fault> {
        Ok(())
    }

    /// Holds the core within the next tick.
    fn hold(&mut self, _detail: u64) {}

    /// The word or register that was changed.
    fn changed(&self) -> Option<String> {
        None
    }

    /// Errors and warnings of the log since the last call.
    fn complaints(&mut self) -> Vec<String> {
        Vec::new()
    }
}

/// A scene on this PC.
pub(super) struct OnPc {
    run: Run,
    whiskers: usize,
    per_side: usize,
}

impl OnPc {
    /// # Errors
    /// As [`Run::new`].
    pub(super) fn new(loaded: &Loaded) -> Result<Self, Error> {
        Ok(Self {
            run: Run::new(&loaded.scene, loaded.classifier()?)?,
            whiskers: loaded.scene.whiskers(),
            per_side: loaded.scene.head.whiskers_per_side,
        })
    }
}

/// The number of a whisker, left side first.
pub(super) fn number(place: Place, per_side: usize) -> usize {
    usize::from(place.side) * per_side + usize::from(place.whisker)
}

/// What can be seen of the last tick of `run`.
pub(super) fn seen<B: host_sim::bench::Bench + ?Sized>(run: &Run<B>, per_side: usize) -> Seen {
    let notices = run.events().iter().filter_map(Notice::of);
    let decisions = run.decisions().filter_map(|decided| {
        let place = decided.place?;
        Some((number(place, per_side), decided.decision))
    });
    Seen {
        row: *run.row(),
        notices: notices
            .map(|(place, notice)| (number(place, per_side), notice))
            .collect(),
        decisions: decisions.collect(),
        ..Seen::default()
    }
}

impl Subject for OnPc {
    fn tick(&mut self) -> Result<Seen, Fault> {
        self.run.tick();
        let mut seen = seen(&self.run, self.per_side);
        for n in 0..self.whiskers {
            if let Some(motor) = self.run.motor_mut(n) {
                seen.effort.push(motor.effort());
                seen.displaced_deg.push(motor.displaced_deg());
            }
        }
        Ok(seen)
    }

    fn motor(&mut self, whisker: usize) -> Option<&mut SimMotor> {
        self.run.motor_mut(whisker)
    }

    fn slave(&mut self, whisker: usize) -> Option<&mut Slave> {
        self.run.slave_mut(whisker)
    }
}
