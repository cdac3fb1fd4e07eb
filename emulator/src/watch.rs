//! The module's state in the board's RAM, read as a debugger would: by the
//! names of its members, while the core is between two ticks.
//!
//! It costs the firmware nothing. What a scene leaves out is not there.

use firmware::Place as Whisker;
use host_sim::bench::Snapshot;
use tactile::Decision;
use whisking::{Fix, Real};

use crate::chip::Fault;
use crate::debug_info::{DebugInfo, Number, Place};
use crate::memory::Memories;
use crate::notice::Notice;
use crate::program::Program;

/// Every name that is looked up, in one place.
mod name {
    use crate::notice::Notice;

    /// The module, a shared resource of RTIC.
    pub(super) const MODULE: &str = "__rtic_internal_shared_resource_module";
    /// The queue from the tick to idle.
    pub(super) const QUEUE: &str = "__rtic_internal_local_init_queue";
    /// Contact π of each side.
    pub(super) const CONTACT: &str = "contact";
    /// The pattern generator.
    pub(super) const STATE: [&str; 2] = ["motion", "state"];
    /// In it: the gate of each side.
    pub(super) const Z: &str = "z";
    /// In it: the whiskers of each side.
    pub(super) const WHISKERS: &str = "whiskers";
    /// In a whisker: its protraction.
    pub(super) const THETA: [&str; 2] = ["muscle", "theta"];
    /// What contact adds to its nominal gain, and that.
    pub(super) const LIFT: &str = "lift";
    pub(super) const NOMINAL: [&str; 2] = ["nominal", "first"];
    /// Ticks that did not happen in time.
    pub(super) const MISSED: [&str; 2] = ["timing", "missed"];
    /// What is made at the start; in it where perception lies, a list of one.
    pub(super) const PLACE: &str = "__rtic_internal_local_init_place";
    pub(super) const PERCEPTION: &str = "perception";
    /// In it: what tells the touches of the whiskers of each side.
    pub(super) const TOUCHES: &str = "touches";
    /// In that: the number of the touch.
    pub(super) const TOUCHING: [&str; 2] = ["touching", "number"];
    /// In the queue: its ring, and how many events were put in since the start.
    pub(super) const EVENTS: &str = "events";
    pub(super) const PUT: &str = "put";
    /// In a list.
    pub(super) const BUFFER: &str = "buffer";
    /// The event, and what stands in it.
    pub(super) const DECISION: &str = "Decision";
    pub(super) const SAMPLES: &str = "samples";
    pub(super) const PACKED: &str = "packed";
    pub(super) const TOUCH: &str = "touch";
    /// Events that are faults, or their ends.
    pub(super) const NOTICES: [(&str, Notice); 5] = [
        ("SensorLost", Notice::SensorLost),
        ("SensorBack", Notice::SensorBack),
        ("MotorFault", Notice::MotorFault),
        ("MotorRetry", Notice::MotorRetry),
        ("MotorGivenUp", Notice::MotorGivenUp),
    ];
    /// In an event: the whisker, and the decision if it is one.
    pub(super) const PLACED: [&str; 2] = ["__0", "__1"];
    /// In the whisker.
    pub(super) const SIDE: &str = "side";
    pub(super) const WHISKER: &str = "whisker";
}

/// A number at an address.
#[derive(Debug, Clone, Copy)]
struct Variable {
    address: u32,
    number: Number,
}

impl Variable {
    fn at(place: Place<'_>) -> Result<Self, Fault> {
        let (address, number) = place.scalar()?;
        Ok(Self { address, number })
    }

    fn read(self, ram: &Memories) -> Result<f64, Fault> {
        let word = ram.word(self.address)?;
        Ok(match self.number {
            Number::Single => f32::from_bits(word).into(),
            Number::Word => Fix(word.cast_signed()).to_f64(),
        })
    }
}

/// The events that the tick has queued.
#[derive(Debug)]
struct Queue {
    put: u32,
    length: u32,
    events: u32,
    stride: u32,
    /// In an event: where its tag stands and what it is for a decision, and
    /// where the decision's words stand.
    tag: (u32, u8),
    words: [u32; 3],
    /// Where side and number of the whisker stand.
    whisker: [u32; 2],
    /// The tags of faults and their ends.
    notices: Vec<(u8, Notice)>,
    seen: u32,
}

/// What the tick has queued.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Said {
    Decision(Decision),
    Notice(Notice),
}

/// Where everything is.
#[derive(Debug)]
pub(crate) struct Watch {
    contact: Vec<Variable>,
    z: Vec<Variable>,
    /// θ and g of every whisker, left side first; g counts for the first of a side.
    theta: Vec<Variable>,
    gain: Vec<[Variable; 2]>,
    missed: u32,
    /// Of the first whisker of each side that is heard.
    touch: Vec<u32>,
    queue: Queue,
}

fn along<'d>(from: Place<'d>, names: &[&str]) -> Result<Option<Place<'d>>, Fault> {
    let mut place = from;
    for name in names {
        match place.find(name)? {
            Some(found) => place = found,
            None => return Ok(None),
        }
    }
    Ok(Some(place))
}

fn elements(array: Place<'_>) -> Result<Vec<Place<'_>>, Fault> {
    (0..array.length()?).map(|n| array.element(n)).collect()
}

/// Where the numbers of touches stand, of the first whisker of each side; nowhere, if
/// nothing is felt.
fn touches(info: &DebugInfo) -> Result<Vec<u32>, Fault> {
    let place = info.variable(name::PLACE)?;
    let list = place.member(name::PERCEPTION)?;
    // The list's storage, and the array in it.
    let storage = list.member(name::BUFFER)?.member(name::BUFFER)?;
    let perception = storage.element(0)?;
    let Some(sides) = perception.find(name::TOUCHES)? else {
        return Ok(Vec::new());
    };
    let mut addresses = Vec::new();
    for side in elements(sides)? {
        let number = along(side.element(0)?, &name::TOUCHING)?;
        addresses.extend(number.map(|number| number.address));
    }
    Ok(addresses)
}

impl Watch {
    pub(crate) fn new(program: &Program) -> Result<Self, Fault> {
        let info = DebugInfo::new(program)?;
        let module = info.variable(name::MODULE)?;
        let numbers = |array: Place<'_>| -> Result<Vec<Variable>, Fault> {
            elements(array)?.into_iter().map(Variable::at).collect()
        };
        let missing = |what: &str| Fault::Program(format!("debug information: no {what}"));
        let missed = along(module, &name::MISSED)?.ok_or_else(|| missing("count of ticks"))?;
        let mut watch = Self {
            missed: missed.scalar()?.0,
            touch: touches(&info)?,
            contact: numbers(module.member(name::CONTACT)?)?,
            z: Vec::new(),
            theta: Vec::new(),
            gain: Vec::new(),
            queue: Queue::new(&info)?,
        };
        if let Some(state) = along(module, &name::STATE)? {
            watch.z = numbers(state.member(name::Z)?)?;
            for side in elements(state.member(name::WHISKERS)?)? {
                for (w, whisker) in elements(side)?.into_iter().enumerate() {
                    let theta = along(whisker, &name::THETA)?.ok_or_else(|| missing("θ"))?;
                    watch.theta.push(Variable::at(theta)?);
                    if w == 0 {
                        let nominal =
                            along(whisker, &name::NOMINAL)?.ok_or_else(|| missing("gain"))?;
                        let lift = whisker.member(name::LIFT)?;
                        watch
                            .gain
                            .push([Variable::at(nominal)?, Variable::at(lift)?]);
                    }
                }
            }
        }
        Ok(watch)
    }

    /// Fills in what the module shows of itself.
    pub(crate) fn look(&self, ram: &Memories, snapshot: &mut Snapshot) -> Result<(), Fault> {
        let fill = |places: &mut [f64], variables: &[Variable]| -> Result<(), Fault> {
            for (place, variable) in places.iter_mut().zip(variables) {
                *place = variable.read(ram)?;
            }
            Ok(())
        };
        fill(&mut snapshot.contact, &self.contact)?;
        fill(&mut snapshot.z, &self.z)?;
        for (place, [nominal, lift]) in snapshot.g.iter_mut().zip(&self.gain) {
            *place = nominal.read(ram)? + lift.read(ram)?;
        }
        for (place, theta) in snapshot.theta_deg.iter_mut().zip(&self.theta) {
            *place = whisking::degrees(theta.read(ram)?);
        }
        for (touch, address) in snapshot.touch.iter_mut().zip(&self.touch) {
            let mut number = [0; 2];
            ram.read(*address, &mut number)?;
            *touch = u16::from_le_bytes(number);
        }
        Ok(())
    }

    /// Ticks that the module has missed since it started.
    pub(crate) fn missed(&self, ram: &Memories) -> Result<u32, Fault> {
        ram.word(self.missed)
    }

    /// The program starts anew, with an empty queue.
    pub(crate) const fn restart(&mut self) {
        self.queue.seen = 0;
    }

    /// The decisions, faults and ends of faults that have been queued since the last call.
    pub(crate) fn said(&mut self, ram: &Memories) -> Result<Vec<(Whisker, Said)>, Fault> {
        self.queue.take(ram)
    }
}

impl Queue {
    fn new(info: &DebugInfo) -> Result<Self, Fault> {
        let queue = info.variable(name::QUEUE)?;
        let events = queue.member(name::EVENTS)?;
        let first = events.element(0)?;
        let (tag, value, event) = first.variant(name::DECISION)?;
        let [whisker, decision] = name::PLACED.map(|part| event.member(part));
        let (whisker, decision) = (whisker?, decision?);
        let notices = name::NOTICES.into_iter();
        let notices = notices.map(|(name, notice)| Ok((first.variant(name)?.1, notice)));
        let offset =
            |name| -> Result<u32, Fault> { Ok(decision.member(name)?.scalar()?.0 - first.address) };
        Ok(Self {
            put: queue.member(name::PUT)?.address,
            length: events.length()?,
            events: first.address,
            stride: first.size()?,
            tag: (tag - first.address, value),
            words: [
                offset(name::SAMPLES)?,
                offset(name::PACKED)?,
                offset(name::TOUCH)?,
            ],
            whisker: [
                whisker.member(name::SIDE)?.address - first.address,
                whisker.member(name::WHISKER)?.address - first.address,
            ],
            notices: notices.collect::<Result<_, Fault>>()?,
            seen: 0,
        })
    }

    fn take(&mut self, ram: &Memories) -> Result<Vec<(Whisker, Said)>, Fault> {
        let put = ram.word(self.put)?;
        let mut said = Vec::new();
        // What has been overwritten since is lost; idle has seen it.
        self.seen = put.wrapping_sub(put.wrapping_sub(self.seen).min(self.length));
        while self.seen != put {
            let event = self.events + self.seen % self.length * self.stride;
            let mut tag = [0];
            ram.read(event + self.tag.0, &mut tag)?;
            let mut place = [[0]; 2];
            for (byte, offset) in place.iter_mut().zip(self.whisker) {
                ram.read(event + offset, byte)?;
            }
            let [[side], [whisker]] = place;
            let notice = self.notices.iter().find(|(value, _)| tag == [*value]);
            let found = match notice {
                Some((_, notice)) => Some(Said::Notice(*notice)),
                None if tag == [self.tag.1] => {
                    let [samples, packed, touch] = self.words;
                    let decision = Decision::from_memory(
                        ram.word(event + samples)?,
                        ram.word(event + packed)?,
                        ram.word(event + touch)?,
                    );
                    decision.map(Said::Decision)
                }
                None => None,
            };
            said.extend(found.map(|found| (Whisker::new(side, whisker), found)));
            self.seen = self.seen.wrapping_add(1);
        }
        Ok(said)
    }
}
