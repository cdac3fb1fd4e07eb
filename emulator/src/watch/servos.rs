//! What the motors' position controls do, for who judges them. It rests on names in the module
//! that may change: what is not found is taken as not there.

use scene::Scene;

use super::{Variable, along};
use crate::chip::Fault;
use crate::debug_info::{DebugInfo, Place};
use crate::memory::Memories;
use crate::program::Program;

#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Wants {
    /// The setpoint that was commanded in place of the pattern generator's, degrees.
    pub(crate) commanded_deg: Option<f64>,
    /// By how much the setpoint that it follows is behind, as it is brought there slowly, degrees.
    pub(crate) behind_deg: f64,
    /// It looks for its stop.
    pub(crate) is_homing: bool,
}

/// A byte that is this value.
#[derive(Debug, Clone, Copy)]
struct Tag {
    address: u32,
    value: u8,
}

impl Tag {
    fn is_so(self, ram: &Memories) -> Result<bool, Fault> {
        Ok(ram.bytes(self.address)? == [self.value])
    }
}

#[derive(Debug)]
struct Servo {
    homing: Option<Tag>,
    /// By how much it is behind, while it runs.
    behind: Option<(Tag, Variable)>,
    commanded: Option<(Tag, Variable)>,
}

impl Servo {
    fn at(servo: Place<'_>) -> Self {
        let kept = |names: &[&str], variant, member| {
            let (tag, held) = within(servo, names, variant)?;
            Some((tag, Variable::at(held.member(member).ok()?).ok()?))
        };
        Self {
            homing: within(servo, &["state"], "Homing").map(|(tag, _)| tag),
            behind: kept(&["state"], "Running", "behind"),
            commanded: kept(&["setpoint", "first"], "Some", "__0"),
        }
    }
}

/// A variant of what these names lead to, and what it holds.
fn within<'d>(from: Place<'d>, names: &[&str], variant: &str) -> Option<(Tag, Place<'d>)> {
    let (address, value, held) = along(from, names).ok()?.variant(variant).ok()?;
    Some((Tag { address, value }, held))
}

/// The position controls of all motors, left side first.
#[derive(Debug)]
pub(crate) struct Servos {
    motors: Vec<Servo>,
    armed: Option<u32>,
    /// That of the left side, as its integrator keeps it.
    oscillator: Option<[Variable; 2]>,
    /// Whether a board of a head has joined, and messages that it could not use.
    on_bus: Option<[u32; 2]>,
}

impl Servos {
    pub(crate) fn new(program: &Program, scene: &Scene) -> Result<Self, Fault> {
        let info = DebugInfo::new(program)?;
        let module = info.variable("INNER")?;
        let whiskers = module.member("whiskers")?;
        let sides = scene.head.sides.count() as u32;
        let servos = (0..sides).filter_map(|n| {
            let servo = whiskers.element(n).ok()?.member("servo").ok()?;
            Some(Servo::at(servo))
        });
        let armed = along(module, &["motion", "is_armed"]).ok();
        let kept = along(module, &["motion", "state"])
            .and_then(|state| along(state, &["oscillators", "kept"]));
        let kept = kept.and_then(|kept| kept.element(0));
        let part = |n| Variable::at(kept.as_ref().ok()?.element(n).ok()?).ok();
        let on_bus = info.variable("ON_BUS").ok().and_then(|on_bus| {
            let at = |names| Some(along(on_bus, names).ok()?.address);
            at(&["node", "is_joined"]).zip(at(&["node", "lost"]))
        });
        Ok(Self {
            motors: servos.collect(),
            armed: armed.map(|armed| armed.address),
            on_bus: on_bus.map(|(joined, lost)| [joined, lost]),
            oscillator: part(0).zip(part(1)).map(|(x, y)| [x, y]),
        })
    }

    /// Whether motors are armed; none: it is not known.
    pub(crate) fn are_armed(&self, ram: &Memories) -> Result<Option<bool>, Fault> {
        let read = |address| Tag { address, value: 1 }.is_so(ram);
        self.armed.map(read).transpose()
    }

    /// Whether a board of a head has joined it, and messages that it could not use; none: it is no
    /// such board.
    pub(crate) fn on_bus(&self, ram: &Memories) -> Result<Option<(bool, u32)>, Fault> {
        let Some([joined, lost]) = self.on_bus else {
            return Ok(None);
        };
        let (address, value) = (joined, 1);
        Ok(Some((Tag { address, value }.is_so(ram)?, ram.word(lost)?)))
    }

    /// Where the oscillator of the left side, or the mean of both, is in its circle, degrees; none:
    /// it is not known.
    pub(crate) fn phase_deg(&self, ram: &Memories) -> Result<Option<f64>, Fault> {
        let Some([x, y]) = self.oscillator else {
            return Ok(None);
        };
        Ok(Some(y.read(ram)?.atan2(x.read(ram)?).to_degrees()))
    }

    pub(crate) fn wants(&self, side: usize, ram: &Memories) -> Result<Wants, Fault> {
        let mut wants = Wants::default();
        let Some(servo) = self.motors.get(side) else {
            return Ok(wants);
        };
        if let Some(homing) = servo.homing {
            wants.is_homing = homing.is_so(ram)?;
        }
        if let Some((running, behind)) = servo.behind
            && running.is_so(ram)?
        {
            wants.behind_deg = whisking::degrees(behind.read(ram)?) - whisking::REST_DEG;
        }
        if let Some((is_there, commanded)) = servo.commanded
            && is_there.is_so(ram)?
        {
            wants.commanded_deg = Some(whisking::degrees(commanded.read(ram)?));
        }
        Ok(wants)
    }
}
