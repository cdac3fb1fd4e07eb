//! What can be injected, and how it is done.

use host_sim::bus::WireFault;
use host_sim::motor::Wire;
use mlx90333::Faults;
use rand_core::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::subject::Subject;
use crate::chip::Fault;

/// A fault that can be injected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The encoder's cable is cut: its count stands still.
    EncoderStuck,
    /// The encoder's channels are exchanged.
    EncoderExchanged,
    /// The encoder's cable has a loose contact.
    EncoderLoose,
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

impl Kind {
    /// Those that befall the wires of a motor.
    pub(super) const MOTOR: [Self; 8] = [
        Self::EncoderStuck,
        Self::EncoderExchanged,
        Self::EncoderLoose,
        Self::WindingOpen,
        Self::WindingLoose,
        Self::WindingExchanged,
        Self::Held,
        Self::Pushed,
    ];
    /// Those that befall a sensor and its wires.
    pub(super) const SENSOR: [Self; 12] = [
        Self::SensorSilent,
        Self::SensorLoose,
        Self::SensorLow,
        Self::SensorLowTail,
        Self::SensorFrozen,
        Self::SensorJumps,
        Self::SensorNoise,
        Self::ByteLost,
        Self::ByteDoubled,
        Self::SumWrong,
        Self::ErrorWord,
        Self::BusError,
    ];
    /// Those that befall a chip.
    pub(super) const CHIP: [Self; 6] = [
        Self::RamBit,
        Self::CoreBit,
        Self::RegisterBit,
        Self::DmaStopped,
        Self::ClockStopped,
        Self::Late,
    ];

    /// Whether every frame that the sensor sends while it lasts is bad.
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
    pub(super) const fn is_momentary(self) -> bool {
        matches!(
            self,
            Self::RamBit
                | Self::CoreBit
                | Self::RegisterBit
                | Self::DmaStopped
                | Self::ClockStopped
                | Self::Late
        )
    }
}

/// A fault, and when and where it is injected.
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

    /// Whether it is there in this tick.
    pub(super) fn lasts(&self, tick: u64) -> bool {
        tick >= self.start && self.end().is_none_or(|end| tick < end)
    }

    /// Does what is to be done before `tick`, counted from 1; `random` is that of the run.
    ///
    /// # Errors
    /// What the emulated chip cannot go along with.
    pub(super) fn apply(
        &self,
        tick: u64,
        subject: &mut dyn Subject,
        random: &mut Xoshiro256PlusPlus,
    ) -> Result<(), Fault> {
        let begins = tick == self.start;
        let ends = Some(tick) == self.end();
        let lasts = self.lasts(tick);
        if !(lasts || ends) {
            return Ok(());
        }
        // A loose contact changes every 8 ticks in the mean.
        let flips = begins || random.next_u64().is_multiple_of(8);
        let closed = random.next_u64().is_multiple_of(2);
        match self.kind {
            Kind::EncoderStuck => self.wire(subject, Wire::Encoder, lasts),
            Kind::EncoderExchanged => self.wire(subject, Wire::EncoderChannels, lasts),
            Kind::EncoderLoose if flips || ends => {
                self.wire(subject, Wire::Encoder, lasts && !closed);
            }
            Kind::WindingOpen => self.wire(subject, Wire::Winding(0), lasts),
            Kind::WindingLoose if flips || ends => {
                self.wire(subject, Wire::Winding(0), lasts && !closed);
            }
            Kind::WindingExchanged => self.wire(subject, Wire::Windings, lasts),
            Kind::Held => {
                if let Some(motor) = subject.motor(self.whisker) {
                    motor.block(lasts);
                }
            }
            Kind::Pushed => {
                // The torque at standstill is 6.6 mN·m at the whisker.
                let share = (self.detail % 4001) as f64 / 1000.0 - 2.0;
                if let Some(motor) = subject.motor(self.whisker) {
                    motor.set_load_nm(if lasts { share * 6.6e-3 } else { 0.0 });
                }
            }
            Kind::SensorSilent => self.frames(subject, lasts.then_some(WireFault::Silent)),
            Kind::SensorLoose if flips || ends => {
                let open = lasts && !closed;
                self.frames(subject, open.then_some(WireFault::Silent));
            }
            Kind::SensorLow => self.frames(subject, lasts.then_some(WireFault::LineLow)),
            Kind::SensorLowTail => {
                self.frames(subject, lasts.then_some(WireFault::LowAfterStart));
            }
            Kind::SensorFrozen => self.frames(subject, lasts.then_some(WireFault::Frozen)),
            Kind::SensorJumps => {
                // Now and then, by a half of the range: beyond what a whisker does.
                let jumps = lasts && random.next_u64().is_multiple_of(16);
                self.frames(subject, jumps.then_some(WireFault::Shift(0x8000)));
            }
            Kind::SumWrong => self.frames(subject, lasts.then_some(WireFault::BadSum)),
            Kind::BusError => self.frames(subject, lasts.then_some(WireFault::Bus)),
            Kind::ByteLost => {
                let byte = (self.detail % 8) as u8;
                self.frames(subject, lasts.then_some(WireFault::ByteLost(byte)));
            }
            Kind::ByteDoubled => {
                let byte = (self.detail % 8) as u8;
                self.frames(subject, lasts.then_some(WireFault::ByteDoubled(byte)));
            }
            Kind::SensorNoise if begins || ends => {
                // From one frame in a thousand to every second one.
                let share = 0.5 * 0.001_f64.powf((self.detail % 1001) as f64 / 1000.0);
                if let Some(slave) = subject.slave(self.whisker) {
                    slave.disturb(0.0, if lasts { share } else { 0.0 }, self.detail);
                }
            }
            Kind::ErrorWord => {
                let bit = 1 << (self.detail % 16);
                if let Some(slave) = subject.slave(self.whisker) {
                    slave.set_error_word(if lasts {
                        Faults::new(bit)
                    } else {
                        Faults::NONE
                    });
                }
            }
            Kind::RamBit if begins => subject.flip_ram(self.detail)?,
            Kind::CoreBit if begins => subject.flip_core(self.detail),
            Kind::RegisterBit if begins => subject.flip_register(self.detail)?,
            Kind::DmaStopped if begins => subject.stop_dma()?,
            Kind::ClockStopped if begins => subject.stop_clock()?,
            Kind::Late if begins => subject.hold(self.detail),
            _ => {}
        }
        Ok(())
    }

    fn wire(&self, subject: &mut dyn Subject, wire: Wire, cut: bool) {
        if let Some(motor) = subject.motor(self.whisker) {
            if cut {
                motor.cut(wire);
            } else {
                motor.mend(wire);
            }
        }
    }

    fn frames(&self, subject: &mut dyn Subject, fault: Option<WireFault>) {
        if let Some(slave) = subject.slave(self.whisker) {
            slave.set_fault(fault);
        }
    }
}
