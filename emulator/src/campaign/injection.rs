//! What can be injected, and how it is done.

use clap::ValueEnum;
use host_sim::bus::WireFault;
use host_sim::motor::{EncoderFlaws, SimMotor, Wire};
use mlx90333::Faults;
use rand_core::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use wire::{Command, WhiskerId};

use super::on_board::OnBoard;
use super::subject::Subject;
use crate::chip::Fault;

/// A fault that can be injected: those of a motor's wires first, then those of a sensor and of the
/// chip.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, ValueEnum,
)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The encoder's cable is cut: its count stands still.
    EncoderStuck,
    /// The encoder's channels are exchanged.
    EncoderExchanged,
    /// The encoder's cable has a loose contact.
    EncoderLoose,
    /// The encoder's count jitters, in half of the runs around one that stands still.
    EncoderJitter,
    /// The winding's cable is cut.
    WindingOpen,
    /// The winding's cable has a loose contact.
    WindingLoose,
    /// The winding's terminals are exchanged.
    WindingExchanged,
    /// The whisker is held.
    Held,
    /// Something turns the whisker with up to twice the motor's torque.
    Pushed,
    /// Motor and gear have up to ten times their friction.
    Friction,
    /// The motor has another supply, from none to twice its own.
    Supply,
    /// Somebody sends commands at random, by both links.
    Commands,
    /// The sensor does not answer: a cut wire, or no supply.
    SensorSilent,
    /// The sensor's cable has a loose contact.
    SensorLoose,
    /// The data line is shorted to ground.
    SensorLow,
    /// The data line is shorted to ground after the first byte, which leaves a good sum.
    SensorLowTail,
    /// The sensor repeats a frame.
    SensorFrozen,
    /// Alpha is far off under a good sum.
    SensorJumps,
    /// One frame in so many has an inverted bit.
    SensorNoise,
    /// A byte of every frame is lost.
    ByteLost,
    /// A byte of every frame comes twice.
    ByteDoubled,
    /// The sum of every frame is wrong.
    SumWrong,
    /// The sensor reports an error of its own.
    ErrorWord,
    /// The controller of the bus reports an error.
    BusError,
    /// A bit of the board's RAM is inverted once, between two ticks or within one.
    RamBit,
    /// A bit of a register of the core is inverted once, within a tick.
    CoreBit,
    /// A bit of a peripheral's register that is not zero is inverted once.
    RegisterBit,
    /// The DMA that moves the bytes of the frames stops.
    DmaStopped,
    /// The clock that the board is fed with stops.
    ClockStopped,
    /// Interrupts come late: the core is held within a tick.
    Late,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Befallen {
    Motor,
    Sensor,
    Chip,
}

impl Kind {
    /// All that befall this. Not an encoder that loses counts or has another scale: while it whisks
    /// nothing tells them from one that does not, and they are harmful until home is looked for
    /// again (record 49).
    pub(super) fn all(at: Befallen) -> Vec<Self> {
        let all = Self::value_variants().iter().copied();
        all.filter(|kind| kind.befalls() == at).collect()
    }

    pub(super) fn befalls(self) -> Befallen {
        if self <= Self::Commands {
            Befallen::Motor
        } else if self <= Self::BusError {
            Befallen::Sensor
        } else {
            Befallen::Chip
        }
    }

    pub(super) const fn spoils_every_frame(self) -> bool {
        matches!(
            self,
            Self::SensorSilent
                | Self::SensorLow
                | Self::SensorLowTail
                | Self::SensorFrozen
                | Self::SumWrong
                | Self::ErrorWord
        )
    }

    /// Whether it happens once, and is not taken away again.
    pub(super) fn is_momentary(self) -> bool {
        self.befalls() == Befallen::Chip
    }

    const fn on_the_wire(self, byte: u8) -> Option<WireFault> {
        Some(match self {
            Self::SensorSilent | Self::SensorLoose => WireFault::Silent,
            Self::SensorLow => WireFault::LineLow,
            Self::SensorLowTail => WireFault::LowAfterStart,
            Self::SensorFrozen => WireFault::Frozen,
            // By a half of the range: beyond what a whisker does.
            Self::SensorJumps => WireFault::Shift(0x8000),
            Self::SumWrong => WireFault::BadSum,
            Self::BusError => WireFault::Bus,
            Self::ByteLost => WireFault::ByteLost(byte),
            Self::ByteDoubled => WireFault::ByteDoubled(byte),
            _ => return None,
        })
    }

    const fn at_the_motor(self) -> Option<Wire> {
        Some(match self {
            Self::EncoderStuck | Self::EncoderLoose => Wire::Encoder,
            Self::EncoderExchanged => Wire::EncoderChannels,
            Self::WindingOpen | Self::WindingLoose => Wire::Winding(0),
            Self::WindingExchanged => Wire::Windings,
            _ => return None,
        })
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Injection {
    pub(super) kind: Kind,
    /// The whisker, counted from 0, left side first.
    pub(super) whisker: usize,
    /// The tick before which it begins, and how many ticks it lasts; `None`: to the end.
    pub(super) start: u64,
    pub(super) ticks: Option<u64>,
    /// What is left open is drawn from it: which bit, which byte, how often.
    pub(super) detail: u64,
}

impl Injection {
    /// The first tick without it; `None`: it stays.
    pub(super) fn end(&self) -> Option<u64> {
        self.ticks.map(|ticks| self.start + ticks)
    }

    pub(super) fn lasts(&self, tick: u64) -> bool {
        tick >= self.start && self.end().is_none_or(|end| tick < end)
    }

    pub(super) fn cuts_encoder(&self) -> bool {
        let jitters = self.kind == Kind::EncoderJitter && self.jitters_around_stillness();
        jitters || self.kind == Kind::EncoderStuck
    }

    const fn jitters_around_stillness(&self) -> bool {
        self.detail.is_multiple_of(2)
    }

    /// `tick` counts from 1; `random` is that of the run.
    pub(super) fn apply(
        &self,
        tick: u64,
        subject: &mut Subject<'_>,
        random: &mut Xoshiro256PlusPlus,
    ) -> Result<(), Fault> {
        let begins = tick == self.start;
        let ends = Some(tick) == self.end();
        let lasts = self.lasts(tick);
        if !(lasts || ends) {
            return Ok(());
        }
        // A loose contact is drawn again every 8 ticks in the mean.
        let flips = begins || random.next_u64().is_multiple_of(8);
        let closed = random.next_u64().is_multiple_of(2);
        let is_there = match self.kind {
            Kind::EncoderLoose | Kind::WindingLoose | Kind::SensorLoose => {
                if !(flips || ends) {
                    return Ok(());
                }
                lasts && !closed
            }
            // Now and then.
            Kind::SensorJumps => lasts && random.next_u64().is_multiple_of(16),
            _ => lasts,
        };
        if let Some(fault) = self.kind.on_the_wire((self.detail % 8) as u8) {
            if let Some(slave) = subject.slave(self.whisker) {
                slave.set_fault(is_there.then_some(fault));
            }
        } else if let Some(wire) = self.kind.at_the_motor() {
            match subject.motor(self.whisker) {
                Some(motor) if is_there => motor.cut(wire),
                Some(motor) => motor.mend(wire),
                None => {}
            }
        } else if self.kind == Kind::Commands {
            // Some fifty a second.
            if lasts && random.next_u64().is_multiple_of(40) {
                let command = self.command(random);
                subject.send(command, random.next_u64().is_multiple_of(2))?;
            }
        } else if self.kind.is_momentary() {
            match subject.board() {
                Some(board) if begins => self.befall(board)?,
                _ => {}
            }
        } else if let Some(motor) = subject.motor(self.whisker)
            && self.kind.befalls() == Befallen::Motor
        {
            self.at_motor(motor, lasts);
        } else if let Some(slave) = subject.slave(self.whisker) {
            match self.kind {
                Kind::SensorNoise if begins || ends => {
                    // From one frame in two thousand to every second one.
                    let share = 0.5 * 0.001_f64.powf((self.detail % 1001) as f64 / 1000.0);
                    slave.disturb(0.0, if lasts { share } else { 0.0 }, self.detail);
                }
                Kind::ErrorWord => {
                    let bits = if lasts { 1 << (self.detail % 16) } else { 0 };
                    slave.set_error_word(Faults::new(bits));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn at_motor(&self, motor: &mut SimMotor, lasts: bool) {
        let drawn = (self.detail % 4001) as f64 / 4000.0;
        match self.kind {
            Kind::Held => motor.block(lasts),
            Kind::EncoderJitter => {
                if lasts && self.jitters_around_stillness() {
                    motor.cut(Wire::Encoder);
                } else {
                    motor.mend(Wire::Encoder);
                }
                // A test of a motor is not misled by so much (`whisking::motor::Expected`).
                motor.set_encoder(EncoderFlaws {
                    jitter: if lasts { 1 + (3.0 * drawn) as u16 } else { 0 },
                    ..EncoderFlaws::NONE
                });
            }
            Kind::Friction => motor.set_friction(if lasts { 1.0 + 9.0 * drawn } else { 1.0 }),
            Kind::Supply => {
                let own_v = motor.settings().supply_v;
                motor.set_supply_v(lasts.then_some(2.0 * drawn * own_v));
            }
            // The torque at standstill is 6.6 mN·m at the whisker.
            _ => {
                let share = (self.detail % 4001) as f64 / 1000.0 - 2.0;
                motor.set_load_nm(if lasts { share * 6.6e-3 } else { 0.0 });
            }
        }
    }

    fn command(&self, random: &mut Xoshiro256PlusPlus) -> Command {
        let whisker = WhiskerId {
            side: (self.detail % 2) as u8,
            number: 0,
        };
        let value = (random.next_u64() % (1 << 25)) as i32;
        match random.next_u64() % 12 {
            0 | 1 => Command::Stop,
            2 | 3 => Command::Arm,
            4 | 5 => Command::Clear(whisker),
            6 | 7 => Command::Gain(whisker, value),
            8 => Command::Home(whisker),
            9 => Command::Status,
            10 => Command::Scene,
            _ => Command::Stream(value % 2 == 0),
        }
    }

    fn befall(&self, board: &mut OnBoard<'_>) -> Result<(), Fault> {
        match self.kind {
            Kind::RamBit => board.flip_ram(self.detail)?,
            Kind::CoreBit => board.flip_core(self.detail),
            Kind::RegisterBit => board.changed = board.session.machine().chip().flip(self.detail),
            Kind::DmaStopped => board.session.machine().chip().stop_dma(),
            Kind::ClockStopped => _ = board.session.machine().disturbed().stop_clock(true)?,
            _ => board.hold(self.detail),
        }
        Ok(())
    }
}
