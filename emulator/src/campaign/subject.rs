//! What a campaign asks of where a scene runs, and a scene on this PC.

use firmware::Place;
use host_sim::Error;
use host_sim::bus::Slave;
use host_sim::loaded::Loaded;
use host_sim::motor::SimMotor;
use host_sim::run::Run;
use host_sim::trace::Row;
use wire::{Command, TaggedCommand};

use super::on_board::OnBoard;
use crate::chip::{Fault, ResetCause};
use crate::notice::Notice;
use crate::program::Program;

#[derive(Debug, Clone, Default)]
pub(super) struct Seen {
    pub(super) row: Row,
    /// Left side first.
    pub(super) motors: Vec<OfMotor>,
    /// What was sent to it before this tick.
    pub(super) commands: Vec<Command>,
    pub(super) notices: Vec<(usize, Notice)>,
    pub(super) decisions: Vec<(usize, String)>,
    pub(super) reset: Option<ResetCause>,
    /// The core has not come to the end of a tick in a tick's time.
    pub(super) is_late: bool,
}

#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct OfMotor {
    /// What the pins ask of it, 0 to 1.
    pub(super) effort: f64,
    /// By how much its whisker is displaced from its encoder's count, degrees.
    pub(super) displaced_deg: f64,
    /// It drives its whisker into an end stop; it looks for its own.
    pub(super) is_into_stop: bool,
    pub(super) is_homing: bool,
}

/// So near to an end stop a whisker is at it, degrees.
const AT_STOP_DEG: f64 = 0.1;

impl OfMotor {
    pub(super) fn new(effort: f64, is_homing: bool, motor: Option<&mut SimMotor>) -> Self {
        let mut of_motor = Self {
            effort,
            is_homing,
            ..Self::default()
        };
        if let Some(motor) = motor {
            let (angle, duty) = (motor.angle_deg(), motor.duty());
            let [back, front] = motor.settings().stops_deg;
            of_motor.is_into_stop = duty < 0.0 && angle <= back + AT_STOP_DEG
                || duty > 0.0 && angle >= front - AT_STOP_DEG;
            of_motor.displaced_deg = motor.displaced_deg();
        }
        of_motor
    }
}

impl Seen {
    pub(super) fn is_same(&self, other: &Self) -> bool {
        // A side that does not exist has values that are not even equal to themselves.
        let bits = |row: &Row| row.pairs().map(|pair| pair.map(f64::to_bits));
        bits(&self.row) == bits(&other.row)
            && self.row.touch == other.row.touch
            && self.motors == other.motors
            && self.commands == other.commands
            && self.notices == other.notices
            && self.decisions == other.decisions
            && self.reset == other.reset
            && self.is_late == other.is_late
    }
}

pub(super) enum Subject<'p> {
    OnPc {
        run: Box<Run>,
        per_side: usize,
        commands: Vec<Command>,
    },
    OnBoard(Box<OnBoard<'p>>),
}

impl<'p> Subject<'p> {
    pub(super) fn new(
        loaded: &Loaded,
        board: Option<(&Program, &'p [(u32, String)])>,
    ) -> Result<Self, Error> {
        Ok(match board {
            None => Self::OnPc {
                run: Box::new(Run::new(&loaded.scene, loaded.classifier()?)?),
                per_side: loaded.scene.head.whiskers_per_side,
                commands: Vec::new(),
            },
            Some((program, words)) => {
                Self::OnBoard(Box::new(OnBoard::new(loaded, program, words)?))
            }
        })
    }

    /// One tick, as far as the emulated chip goes along.
    pub(super) fn tick(&mut self) -> Result<Seen, Fault> {
        let (run, per_side, commands) = match self {
            Self::OnPc {
                run,
                per_side,
                commands,
            } => (run, *per_side, commands),
            Self::OnBoard(board) => return board.tick(),
        };
        run.tick();
        let mut seen = seen(run, per_side);
        seen.commands = std::mem::take(commands);
        for n in 0.. {
            let is_homing = run.module_mut().is_homing(n);
            let Some(motor) = run.motor_mut(n) else { break };
            seen.motors
                .push(OfMotor::new(motor.effort(), is_homing, Some(motor)));
        }
        Ok(seen)
    }

    pub(super) fn send(&mut self, command: Command, is_by_serial: bool) -> Result<(), Fault> {
        match self {
            Self::OnPc { run, commands, .. } => {
                let module = run.module_mut();
                module.request(TaggedCommand { tag: 0, command });
                module.take_packets();
                commands.push(command);
                Ok(())
            }
            Self::OnBoard(board) => board.send(command, is_by_serial),
        }
    }

    /// A whisker's motor; none where motors are ideal.
    pub(super) fn motor(&mut self, whisker: usize) -> Option<&mut SimMotor> {
        match self {
            Self::OnPc { run, .. } => run.motor_mut(whisker),
            Self::OnBoard(board) => board.session.run.motor_mut(whisker),
        }
    }

    pub(super) fn slave(&mut self, whisker: usize) -> Option<&mut Slave> {
        match self {
            Self::OnPc { run, .. } => run.slave_mut(whisker),
            Self::OnBoard(board) => board.session.run.slave_mut(whisker),
        }
    }

    pub(super) fn board(&mut self) -> Option<&mut OnBoard<'p>> {
        match self {
            Self::OnPc { .. } => None,
            Self::OnBoard(board) => Some(board),
        }
    }
}

pub(super) fn number(place: Place, per_side: usize) -> usize {
    usize::from(place.side) * per_side + usize::from(place.whisker)
}

pub(super) fn seen<B: host_sim::bench::Bench + ?Sized>(run: &Run<B>, per_side: usize) -> Seen {
    let notices = run.events().iter().filter_map(Notice::of);
    let notices = notices.map(|(place, notice)| (number(place, per_side), notice));
    let decisions = run.decisions().filter_map(|decided| {
        let place = decided.place?;
        Some((number(place, per_side), decided.decision))
    });
    Seen {
        row: *run.row(),
        notices: notices.collect(),
        decisions: decisions.collect(),
        ..Seen::default()
    }
}
