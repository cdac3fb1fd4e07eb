//! Core, memories and chip in one time.
//!
//! One step of rsemu is one instruction; its cycles, by rsemu's model of the
//! Cortex-M4 (flash without wait states), are the time on every core. While the core
//! sleeps time jumps to the next event of a peripheral.

use std::ops::Range;
use std::sync::{Arc, MutexGuard};

use crate::chip::{Chip, Fault, Model, Ps, ResetCause, SensorEnd};
use crate::core::{BRANCH_CYCLES, Core, EXCEPTION, IT_BLOCK, ROUND_CYCLES, ROUND_INSTRUCTIONS};
use crate::memory::{FLASH, Memories, Shared};
use crate::meter::Meter;
use crate::program::Program;
use crate::upset::Planned;
use rsemu::cpu::arm::v7m::Regs;
use rtt::Rtt;

/// What cortex-m-rt fills the stack with at a reset (its feature `paint-stack`).
const PAINT: u32 = 0xCCCC_CCCC;
/// Interrupts are exceptions from this number on.
const INTERRUPTS: u32 = 16;

/// Why [`Machine::run`] came back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stop {
    Tick,
    /// The core sleeps for the first time since it started.
    Ready,
    Time,
    Reset(ResetCause),
}

/// What the core has executed, instructions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Spent {
    pub tick: u64,
    /// In the handlers at the end of a frame.
    pub frame: u64,
    /// In idle, and before it.
    pub thread: u64,
    pub other: u64,
}

/// The emulated board, without what hangs on its pins.
#[derive(Debug)]
pub(crate) struct Machine {
    model: &'static Model,
    pub(crate) core: Core,
    /// The exceptions of the tick and of the ends of frames.
    tick: u32,
    frames: Vec<u32>,
    shared: Arc<Shared>,
    pub(crate) memories: Memories,
    pub(crate) rtt: Rtt,
    /// The stack, which grows down.
    stack: Range<u32>,
    pub(crate) now: Ps,
    due: Option<Ps>,
    pub(crate) cycle: Ps,
    pc: u32,
    exception: u32,
    /// What is left of an IT block, as in xPSR.
    block: u32,
    ready: bool,
    /// Until when the core waits for its flash.
    stalled: Ps,
    /// Nothing but a reset gets the core on.
    is_locked_up: bool,
    /// The supply holds the chip in reset.
    held: bool,
    pub(crate) planned: Planned,
    spent: Spent,
}

impl Machine {
    pub(crate) fn new(program: &Program) -> Result<Self, Fault> {
        let model = program.model()?;
        let memories = Memories::flashed(program.segments(), model.flash, model.ram)?;
        let shared = Shared::new(Chip::new(model)?);
        let core = Core::new(model, &memories, memories.space(&shared)?);
        let cycle = shared.chip().cycle();
        let exception = |irq: u16| u32::from(irq) + INTERRUPTS;
        Ok(Self {
            model,
            core,
            tick: exception(model.tick_irq()),
            frames: model.frame_irqs().map(exception).collect(),
            memories,
            rtt: Rtt::of_program(program.bytes())?,
            stack: program.symbol("_stack_end")?..program.symbol("_stack_start")?,
            now: 0,
            due: None,
            cycle,
            shared,
            pc: 0,
            exception: 0,
            block: 0,
            ready: false,
            stalled: 0,
            is_locked_up: false,
            held: false,
            planned: Planned::default(),
            spent: Spent::default(),
        })
    }

    /// The chip at this time; nothing runs while it is held.
    pub(crate) fn chip(&self) -> MutexGuard<'_, Chip> {
        let mut chip = self.shared.chip();
        chip.now = self.now;
        chip
    }

    /// The same, for what changes from outside what the core sees.
    pub(crate) fn disturbed(&self) -> MutexGuard<'_, Chip> {
        self.shared.touch();
        self.chip()
    }

    pub(crate) fn stands_still(&self) -> Fault {
        if self.is_locked_up {
            Fault::LockUp { pc: self.core.pc() }
        } else {
            Fault::Asleep
        }
    }

    /// The chip is in reset while that is too low; its RAM keeps its contents.
    pub(crate) fn set_supply(&mut self, supply_mv: u32) -> Result<Option<ResetCause>, Fault> {
        let held = self.disturbed().set_supply(supply_mv)?;
        if let Some(cause) = held {
            self.reset(cause)?;
        }
        self.held = held.is_some();
        Ok(held)
    }

    pub(crate) fn say_again(&mut self, side: usize, said: &[u8]) -> Result<(), Fault> {
        let places = self.shared.chip().lines[side].say_again(said);
        let mut bytes = places.into_iter().zip(said);
        bytes.try_for_each(|(place, byte)| self.memories.write(place, &[*byte]))
    }

    pub(crate) const fn is_in_tick(&self) -> bool {
        self.exception == self.tick
    }

    /// How much stack the program has used: what was never written still has its paint.
    pub(crate) fn stack_used(&self) -> Result<u32, Fault> {
        let Range { start, end } = self.stack;
        if self.memories.word(start)? != PAINT {
            let what = "the stack was not painted, or ran over its end";
            return Err(Fault::Program(what.to_owned()));
        }
        for address in (start..end).step_by(4) {
            if self.memories.word(address)? != PAINT {
                return Ok(end - address);
            }
        }
        Ok(0)
    }

    /// Runs, with `sensors` on the wires, the left one first, until the tick's handler
    /// has returned, the chip has been reset, the program is ready, or the time is
    /// `until`.
    pub(crate) fn run(
        &mut self,
        until: Ps,
        sensors: &mut [impl SensorEnd],
        mut meter: Option<&mut Meter>,
    ) -> Result<Stop, Fault> {
        if self.held {
            self.reach(until);
            return Ok(Stop::Time);
        }
        self.pc = self.core.pc();
        loop {
            if let Some(cause) = self.look(sensors)? {
                self.reset(cause)?;
                return Ok(Stop::Reset(cause));
            }
            if self.now >= until {
                return self.at_end();
            }
            if self.is_locked_up {
                self.sleep(until, 0)?;
                continue;
            }
            if self.stalled > self.now {
                self.stall(until);
                continue;
            }
            let from = self.pc;
            let cycles = self.core.step_at(from);
            // In one: each question takes a lock.
            let Regs { r, xpsr, .. } = self.core.regs();
            self.pc = r[15];
            // It sleeps on where it is, in one cycle.
            if cycles == 1 && self.pc == from && self.core.is_asleep() {
                if !self.ready {
                    self.ready = true;
                    return Ok(Stop::Ready);
                }
                // The step that found it asleep has counted its cycle.
                self.sleep(until, cycles * self.cycle)?;
                continue;
            }
            self.reach(self.now + cycles * self.cycle);
            // Nothing befalls it before a certain instruction.
            let is_left_alone = self.planned.is_none();
            if self.account(xpsr, &mut meter)? {
                return Ok(Stop::Tick);
            }
            let has_looped = cycles == BRANCH_CYCLES && self.pc.wrapping_add(2) == from;
            if has_looped && is_left_alone {
                self.count_down(until);
            }
        }
    }

    /// In a loop that only counts down, nothing happens before the next event.
    fn count_down(&mut self, until: Ps) {
        let free = self.due.unwrap_or(Ps::MAX).min(until);
        let round = ROUND_CYCLES * self.cycle;
        let most = free.saturating_sub(self.now) / round;
        let rounds = self.core.count_down(most, &self.memories);
        *self.spent_in(self.exception) += ROUND_INSTRUCTIONS * rounds;
        self.reach(self.now + rounds * round);
    }

    fn reach(&mut self, now: Ps) {
        self.now = now;
        self.shared.set_now(now);
    }

    /// Nothing is pending: on to the next event, of which SysTick has counted a part.
    fn sleep(&mut self, until: Ps, counted: Ps) -> Result<(), Fault> {
        let due = self.due.ok_or(Fault::Asleep)?;
        let slept = due.min(until).saturating_sub(self.now);
        self.reach(self.now + slept);
        self.core.pass(slept.saturating_sub(counted), self.cycle);
        Ok(())
    }

    /// The flash is erased or written, and the core gets no instruction.
    fn stall(&mut self, until: Ps) {
        let due = self.due.unwrap_or(Ps::MAX);
        let waited = self.stalled.min(until).min(due).saturating_sub(self.now);
        self.reach(self.now + waited);
        self.core.pass(waited, self.cycle);
    }

    /// The time is up. A reset that the core asks for touches no peripheral, and so is seen
    /// with the next event of one, or here.
    fn at_end(&mut self) -> Result<Stop, Fault> {
        if !self.core.reset_requested() {
            return Ok(Stop::Time);
        }
        self.core.clear_reset_request();
        self.reset(ResetCause::Software)?;
        Ok(Stop::Reset(ResetCause::Software))
    }

    /// Counts the step that was just made; whether the tick's handler has returned.
    fn account(&mut self, xpsr: u32, meter: &mut Option<&mut Meter>) -> Result<bool, Fault> {
        let before = self.exception;
        self.exception = xpsr & EXCEPTION;
        let block = std::mem::replace(&mut self.block, xpsr & IT_BLOCK);
        if block != 0 && self.exception != 0 && before != self.exception {
            self.core.keep_block(block, before, &self.memories)?;
        }
        if self.exception != 0 && before != self.exception && (before == 0 || self.exception < 16) {
            // An entry is no instruction.
            self.look_for_tick(meter);
            return Ok(false);
        }
        *self.spent_in(before) += 1;
        // No handler of the program's is more urgent than the tick's: behind another it begins.
        if before >= INTERRUPTS && before != self.exception {
            self.look_for_tick(meter);
        }
        if let Some(upset) = self.planned.due(self.spent.tick) {
            let held = upset.happen(&self.core, &self.memories)?;
            self.pc = self.core.pc();
            self.now += held;
            self.core.pass(held, self.cycle);
        }
        // Another handler of its priority may follow at once.
        if before == self.tick && self.exception != self.tick {
            if let Some(meter) = meter {
                meter.tick_ends(self.now);
            }
            return Ok(true);
        }
        self.is_locked_up = before != 0 && before < INTERRUPTS && self.core.has_locked_up();
        Ok(false)
    }

    fn spent_in(&mut self, exception: u32) -> &mut u64 {
        match exception {
            tick if tick == self.tick => &mut self.spent.tick,
            exception if self.frames.contains(&exception) => &mut self.spent.frame,
            0 => &mut self.spent.thread,
            _ => &mut self.spent.other,
        }
    }

    fn look_for_tick(&mut self, meter: &mut Option<&mut Meter>) {
        if self.exception == self.tick {
            let latency = self.now - self.shared.chip().tick_began();
            if let Some(meter) = meter {
                meter.tick_begins(self.now, latency, &self.spent);
            }
            self.planned.tick_begins(self.spent.tick);
        }
    }

    fn look(&mut self, sensors: &mut [impl SensorEnd]) -> Result<Option<ResetCause>, Fault> {
        let due = self.due.is_some_and(|due| due <= self.now);
        if !self.shared.take_touched() && !due {
            return Ok(None);
        }
        let mut chip = self.shared.chip();
        let reset = match chip.advance(self.now, &self.memories, sensors) {
            Ok(reset) => reset,
            Err(Fault::Unmodelled { address, write, .. }) => {
                let pc = self.core.pc();
                return Err(Fault::Unmodelled { address, write, pc });
            }
            Err(fault) => return Err(fault),
        };
        let erased = chip.flash.take_erased();
        self.stalled = chip.flash.busy_until();
        drop(chip);
        if let Some(place) = erased {
            self.memories
                .erase(FLASH + place.start..FLASH + place.end)?;
        }
        self.core.check()?;
        self.follow_chip();
        if self.core.reset_requested() {
            self.core.clear_reset_request();
            return Ok(Some(ResetCause::Software));
        }
        Ok(reset)
    }

    pub(crate) fn reset(&mut self, cause: ResetCause) -> Result<(), Fault> {
        let space = self.memories.space(&self.shared)?;
        self.core = Core::new(self.model, &self.memories, space);
        let mut chip = self.shared.chip();
        chip.reset(cause)?;
        // A core that was held knows nothing of the time since.
        self.now = chip.now;
        self.shared.set_now(self.now);
        drop(chip);
        self.follow_chip();
        (self.exception, self.block) = (0, 0);
        self.ready = false;
        self.is_locked_up = false;
        self.stalled = 0;
        Ok(())
    }

    fn follow_chip(&mut self) {
        let chip = self.shared.chip();
        self.due = chip.next_event();
        self.cycle = chip.cycle();
        for (irq, up) in chip.interrupts() {
            self.core.set_irq(irq, up);
        }
        self.core.set_nmi(chip.has_nmi());
    }
}
