//! A scene as a board's program on its emulated chip, of which bits can be inverted.

use host_sim::Error;
use host_sim::loaded::Loaded;

use wire::{Command, TaggedCommand};

use super::subject::{OfMotor, Seen, number, seen};
use crate::chip::Fault;
use crate::debug_info::DebugInfo;
use crate::program::Program;
use crate::session::Session;
use crate::upset::{MIDDLE, REGISTERS, Upset};
use crate::watch::Servos;

const STACK: &str = "stack";
/// Bytes at the top of the stack, which a tick with a decision uses.
const STACK_BYTES: u32 = 1024;
/// Rings of the log and of packets are written by the program and read by a probe only.
const RINGS: [&str; 3] = ["_SEGGER_RTT", "LOG_BYTES", "PACKETS"];

/// The words of a board's RAM that a program uses, each with the name of its variable.
pub(super) fn words(program: &Program) -> Result<Vec<(u32, String)>, Fault> {
    let info = DebugInfo::new(program)?;
    let mut words = Vec::new();
    for leaf in info.leaves()? {
        if RINGS.iter().any(|ring| leaf.path.starts_with(ring)) {
            continue;
        }
        let first = leaf.address / 4;
        let last = (leaf.address + leaf.size.max(1) - 1) / 4;
        let name = leaf.path.clone();
        words.extend((first..=last).map(|word| (4 * word, name.clone())));
    }
    let top = program.symbol("_stack_start")?;
    let stack = (top - STACK_BYTES..top).step_by(4);
    words.extend(stack.map(|address| (address, STACK.to_owned())));
    words.sort();
    words.dedup_by_key(|(address, _)| *address);
    if words.is_empty() {
        return Err(Fault::Program("it has no variables".to_owned()));
    }
    Ok(words)
}

/// Which bit, which byte or register, whether within a tick, and before which instruction of
/// it, of the first 1,500: longer ticks are not interrupted later.
const fn parts(detail: u64) -> [u32; 4] {
    let drawn = (detail >> 32) as u32;
    [
        drawn % 32,
        (drawn >> 5) % 1024,
        (drawn >> 15) % 2,
        1 + (drawn >> 16) % 1_500,
    ]
}

pub(super) struct OnBoard<'p> {
    pub(super) session: Session,
    words: &'p [(u32, String)],
    servos: Servos,
    commands: Vec<Command>,
    tag: u16,
    pub(super) changed: Option<String>,
}

impl<'p> OnBoard<'p> {
    pub(super) fn new(
        loaded: &Loaded,
        program: &Program,
        words: &'p [(u32, String)],
    ) -> Result<Self, Error> {
        let mut session = Session::running(&loaded.scene, loaded.classes()?, program)?;
        session.bear_resets(true);
        Ok(Self {
            session,
            words,
            servos: Servos::new(program, &loaded.scene)?,
            commands: Vec::new(),
            tag: 0,
            changed: None,
        })
    }

    pub(super) fn tick(&mut self) -> Result<Seen, Fault> {
        self.session.pass_tick()?;
        let mut seen = seen(&self.session.run, 1);
        let board = self.session.board_mut();
        let notices = std::mem::take(&mut board.notices).into_iter();
        let notices = notices.map(|(place, notice)| (number(place, 1), notice));
        seen.notices = notices.collect();
        seen.reset = board.reset.take();
        seen.is_late = board.is_late;
        seen.commands = std::mem::take(&mut self.commands);
        for (n, effort) in self.session.efforts().into_iter().enumerate() {
            let wants = self.servos.wants(n, &self.session.machine().memories)?;
            let motor = self.session.run.motor_mut(n);
            seen.motors
                .push(OfMotor::new(effort, wants.is_homing, motor));
        }
        Ok(seen)
    }

    pub(super) fn send(&mut self, command: Command, is_by_serial: bool) -> Result<(), Fault> {
        self.tag = self.tag.wrapping_add(1);
        let tag = self.tag;
        let frame = wire::frame(&TaggedCommand { tag, command });
        let board = self.session.board_mut();
        if is_by_serial {
            board.machine.disturbed().serial_write(&frame);
        } else if board.request_room()? < frame.len() || !board.request(&frame)? {
            // Half of a frame would spoil the next.
            return Ok(());
        }
        self.commands.push(command);
        Ok(())
    }

    pub(super) fn flip_ram(&mut self, detail: u64) -> Result<(), Fault> {
        // After the last from the first again.
        let (word, name) = &self.words[detail as u32 as usize % self.words.len()];
        let [bit, byte, within, instruction] = parts(detail);
        let (address, bits) = (word + byte % 4, 1_u8 << (bit % 8));
        let machine = self.session.machine();
        // What lies on the stack between two ticks is idle's, and little.
        let within = within % 2 == 0 || name == STACK;
        if within {
            let upset = Upset::Ram { address, bits };
            machine.planned.plan(instruction.into(), upset);
        } else {
            machine.memories.flip(address, bits)?;
        }
        let bit = 8 * (byte % 4) + bit % 8;
        let when = if within { " within a tick" } else { "" };
        self.changed = Some(format!("{word:#010x} {name} bit {bit}{when}"));
        Ok(())
    }

    pub(super) fn flip_core(&mut self, detail: u64) {
        let [bit, register, _, instruction] = parts(detail);
        let register = register % REGISTERS.len() as u32;
        let name = REGISTERS[register as usize];
        // Of xPSR the flags, which are its top five bits.
        let bit = if name == "xpsr" {
            27 + bit % 5
        } else {
            bit % 32
        };
        let upset = Upset::Core {
            register: register as u8,
            bits: 1 << bit,
        };
        let machine = self.session.machine();
        machine.planned.plan(instruction.into(), upset);
        self.changed = Some(format!("{name} bit {bit}"));
    }

    pub(super) fn hold(&mut self, detail: u64) {
        // From a tenth of a tick to ten ticks, which the watchdog bears.
        let share = 0.1 * 100.0_f64.powf((detail % 1001) as f64 / 1000.0);
        let time = share * 1e12 / f64::from(self.session.tick_hz);
        let machine = self.session.machine();
        machine.planned.plan(MIDDLE, Upset::Held(time as u64));
    }

    pub(super) fn complaints(&mut self) -> Vec<String> {
        let lines = self.session.log().into_iter();
        lines
            .filter(|line| line.contains("ERROR") || line.contains("WARN"))
            .collect()
    }
}
