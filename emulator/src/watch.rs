//! The module's state in the board's RAM, read as a debugger would: by the
//! names of its members, while the core is between two ticks.
//!
//! It costs the firmware nothing. What a scene leaves out is not there. Cells, lists and RTIC put
//! names around those that are looked up here, which are seen through.

mod servos;

use firmware::{Event, Place as Whisker};
use host_sim::bench::Snapshot;
use scene::Scene;
use tactile::{Decision, Estimate, Pose};
use whisking::{Fix, Real};

use crate::chip::Fault;
use crate::debug_info::{DebugInfo, Number, Place};
use crate::memory::Memories;
use crate::notice::Notice;
use crate::program::Program;

pub(crate) use servos::Servos;

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
    /// Where the place of the next stands.
    tail: u32,
    length: u32,
    events: u32,
    stride: u32,
    /// In an event: where its tag stands and what it is for a decision, and
    /// where the decision's words stand.
    tag: (u32, u8),
    words: [u32; 3],
    /// Where side and number of the whisker stand.
    whisker: [u32; 2],
    /// Of a pose likewise: its tag, and where value and error of tilt and depth stand.
    pose: (u8, [u32; 4]),
    /// The tags of faults and their ends.
    notices: Vec<(u8, Notice)>,
    /// The place of the first that was not seen.
    seen: u32,
}

#[derive(Debug)]
pub(crate) struct Watch {
    contact: Vec<Variable>,
    z: Vec<Variable>,
    /// θ and g of every whisker, left side first.
    theta: Vec<Variable>,
    gain: Vec<[Variable; 2]>,
    /// Where ticks are counted that did not happen in time.
    pub(crate) missed: u32,
    touch: Vec<u32>,
    queue: Queue,
}

/// What these names lead to.
pub(crate) fn along<'d>(from: Place<'d>, names: &[&str]) -> Result<Place<'d>, Fault> {
    let mut names = names.iter();
    names.try_fold(from, |place, name| place.member(name))
}

impl Watch {
    /// Of a board that runs `scene`, and has so many of its whiskers.
    pub(crate) fn new(program: &Program, scene: &Scene, whiskers: usize) -> Result<Self, Fault> {
        let info = DebugInfo::new(program)?;
        let module = info.variable("INNER")?;
        let sides = scene.head.sides.count() as u32;
        let whiskers = whiskers as u32;
        let some = |count: u32, names: &[&str], part: &[&str]| -> Result<Vec<Place<'_>>, Fault> {
            let list = along(module, names)?;
            (0..count).map(|n| along(list.element(n)?, part)).collect()
        };
        let each = |names: &[&str], part: &[&str]| some(whiskers, names, part);
        let numbers = |places: Vec<Place<'_>>| -> Result<Vec<Variable>, Fault> {
            places.into_iter().map(Variable::at).collect()
        };
        let mut watch = Self {
            missed: along(module, &["timing", "missed"])?.scalar()?.0,
            touch: Vec::new(),
            contact: numbers(some(sides, &["contact"], &[])?)?,
            z: Vec::new(),
            theta: Vec::new(),
            gain: Vec::new(),
            queue: Queue::new(&info)?,
        };
        if scene.classifier.is_some() {
            let numbers = each(&["perception", "touches"], &["touching", "number"])?.into_iter();
            watch.touch = numbers.map(|number| number.address).collect();
        }
        if scene.whisking.is_some() {
            let all = ["motion", "state", "whiskers"];
            watch.z = numbers(some(sides, &["motion", "state", "sides"], &["z"])?)?;
            watch.theta = numbers(each(&all, &["muscle", "theta"])?)?;
            let nominal = numbers(each(&all, &["nominal", "first"])?)?;
            let lift = numbers(each(&all, &["lift"])?)?;
            let gains = nominal.into_iter().zip(lift);
            watch.gain = gains.map(|(nominal, lift)| [nominal, lift]).collect();
        }
        Ok(watch)
    }

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
            *touch = ram.bytes(*address).map(u16::from_le_bytes)?;
        }
        Ok(())
    }

    pub(crate) const fn restart(&mut self) {
        self.queue.seen = 0;
    }

    /// Adds what has been queued since the last call: decisions and poses to `events`, faults and ends
    /// of faults to `notices`.
    pub(crate) fn take(
        &mut self,
        ram: &Memories,
        events: &mut Vec<Event>,
        notices: &mut Vec<(Whisker, Notice)>,
    ) -> Result<(), Fault> {
        let queue = &mut self.queue;
        // A flipped bit may have led it out of the ring.
        let tail = ram.word(queue.tail)? % queue.length;
        while queue.seen != tail {
            let at = queue.events + queue.seen * queue.stride;
            let [tag] = ram.bytes(at + queue.tag.0)?;
            let [side] = ram.bytes(at + queue.whisker[0])?;
            let [whisker] = ram.bytes(at + queue.whisker[1])?;
            let place = Whisker::new(side, whisker);
            if let Some((_, notice)) = queue.notices.iter().find(|(value, _)| tag == *value) {
                notices.push((place, *notice));
            } else if tag == queue.tag.1 {
                let [samples, packed, touch] = queue.words.map(|word| ram.word(at + word));
                let decision = Decision::from_memory(samples?, packed?, touch?);
                events.extend(decision.map(|decision| Event::Decision(place, decision)));
            } else if tag == queue.pose.0 {
                let half = |n: usize| ram.bytes(at + queue.pose.1[n]);
                let estimate = |n| -> Result<Estimate, Fault> {
                    Ok(Estimate {
                        hundredths: half(n).map(i16::from_le_bytes)?,
                        error_hundredths: half(n + 1).map(u16::from_le_bytes)?,
                    })
                };
                let (tilt, depth) = (estimate(0)?, estimate(2)?);
                events.push(Event::Pose(place, Pose { tilt, depth }));
            }
            queue.seen = (queue.seen + 1) % queue.length;
        }
        Ok(())
    }
}

impl Queue {
    fn new(info: &DebugInfo) -> Result<Self, Fault> {
        let queues = info.variable("__rtic_internal_local_init_queues")?;
        let queue = queues.member("events")?;
        let events = queue.member("buffer")?;
        let first = events.element(0)?;
        let of_first = first.member("event")?;
        let (tag, value, event) = of_first.variant("Decision")?;
        let (whisker, decision) = (event.member("__0")?, event.member("__1")?);
        let (_, posed, event) = of_first.variant("Pose")?;
        let pose = event.member("__1")?;
        let mut numbers = Vec::new();
        for estimate in ["tilt", "depth"] {
            for part in ["hundredths", "error_hundredths"] {
                let number = pose.member(estimate)?.member(part)?;
                numbers.push(number.address - first.address);
            }
        }
        let notices = [
            ("SensorLost", Notice::SensorLost),
            ("SensorBack", Notice::SensorBack),
            ("MotorFault", Notice::MotorFault),
            ("MotorRetry", Notice::MotorRetry),
            ("MotorGivenUp", Notice::MotorGivenUp),
        ];
        let notices = notices
            .into_iter()
            .map(|(name, notice)| Ok((of_first.variant(name)?.1, notice)));
        let offset =
            |name| -> Result<u32, Fault> { Ok(decision.member(name)?.scalar()?.0 - first.address) };
        Ok(Self {
            tail: queue.member("tail")?.address,
            length: events.length()?,
            events: first.address,
            stride: first.size()?,
            tag: (tag - first.address, value),
            words: [offset("samples")?, offset("packed")?, offset("touch")?],
            whisker: [
                whisker.member("side")?.address - first.address,
                whisker.member("whisker")?.address - first.address,
            ],
            pose: (posed, std::array::from_fn(|n| numbers[n])),
            notices: notices.collect::<Result<_, Fault>>()?,
            seen: 0,
        })
    }
}
