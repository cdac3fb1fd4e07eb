//! A mock SPI bus with an MLX90333 on it that speaks the wire format.
//!
//! Glossary:
//!
//! - *slave*: the sensor on the bus ([`Slave`]). The module owns it as its SPI
//!   device; the simulation reaches it through the module between ticks;
//! - *latch*: at the falling edge of /SS the slave takes the deflections of
//!   that moment; a frame never mixes two of them;
//! - *wired-AND*: MOSI and MISO are one open-drain line. Whoever sends a zero pulls it low, so the
//!   master reads `sent & answered` and a master that sends zeros reads zeros;
//! - *noise*: what a sensor has below its resolution of 14 bits: the lowest bit of its words
//!   changes from frame to frame, so that two frames are never the same though their codes are;
//! - *error word*: what the sensor reports about itself, in a valid frame;
//! - *wire fault*: what happens to the frame on its way ([`WireFault`]).
//!
//! No time passes on this bus: delays are accepted and added up.
//!
//! The other sensor has its own: [`tmag5170`].

pub mod tmag5170;
mod wire;

use self::tmag5170::{BelowMagnet, TmagSlave};
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use mlx90333::{Decoder, FRAME_LEN, Faults, Mode, Word, encode};
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
pub use wire::SimSpiError;
use wire::{Injected, RELEASED, Traffic};

/// What happens to frames on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WireFault {
    /// The slave does not answer: all bytes 0xFF. A lost frame, a cut wire and
    /// a sensor without supply look alike.
    Silent,
    /// The line is held low: all bytes 0x00.
    LineLow,
    /// B7 is one more than the sum rule wants.
    BadSum,
    /// The bus controller reports an error; nothing is read.
    Bus,
    /// One bit of the frame arrives inverted: 0 is the first on the wire, the
    /// top bit of B0, and 63 the last. Others change nothing.
    Flip(u8),
    /// A byte, counted from 0, is lost: the next ones come a byte early, and the last
    /// reads as released. Others change nothing.
    ByteLost(u8),
    /// A byte, counted from 0, comes twice: the next ones come a byte late, and the last
    /// is lost. Others change nothing.
    ByteDoubled(u8),
    /// The line is held low after the first byte, which leaves a good sum.
    LowAfterStart,
    /// The sensor's converter stands still: frame after frame is that of the start of the fault.
    Frozen,
    /// No magnet is near: the sensor converts no deflection, and its noise.
    NoField,
    /// Alpha arrives this far off, modulo 65,536, under a good sum.
    Shift(u16),
}

/// Random disturbances, each drawn once a frame.
#[derive(Debug, Clone)]
struct Disturbance {
    lost: f64,
    flipped: f64,
    random: Xoshiro256PlusPlus,
}

impl Disturbance {
    fn draw(&mut self) -> Option<WireFault> {
        let word = self.random.next_u64();
        // The upper 53 bits as a number in [0, 1); the lower ones choose the bit.
        let chance = (word >> 11) as f64 / (1_u64 << 53) as f64;
        if chance < self.lost {
            Some(WireFault::Silent)
        } else if chance < self.lost + self.flipped {
            Some(WireFault::Flip((word % 64) as u8))
        } else {
            None
        }
    }
}

/// A sensor, and the wire to it: the module's [`SpiDevice`].
///
/// A new one is at rest (mid-scale) and without fault.
#[derive(Debug, Clone)]
pub struct Slave {
    /// How its frames are to be read, which is set in its EEPROM, or in the part itself.
    decoder: Decoder,
    words: [Word; 3],
    /// The words of the last frame, with noise.
    sent: [Word; 3],
    is_noisy: bool,
    error_word: Faults,
    injected: Injected<WireFault>,
    disturbance: Option<Disturbance>,
    traffic: Traffic,
}

impl Slave {
    /// A sensor whose frames are to be read by `decoder`. In XYZ mode Z stays at mid-scale and
    /// there is no error word.
    pub fn of(decoder: Decoder) -> Self {
        Self {
            decoder,
            words: [Word::MID; 3],
            sent: [Word::MID; 3],
            is_noisy: true,
            error_word: Faults::NONE,
            injected: Injected::NONE,
            disturbance: None,
            traffic: Traffic::default(),
        }
    }

    /// Deflections along x and y, limited to ±1 and rounded to the sensor's 14
    /// bits; NaN reads as rest.
    pub fn set(&mut self, [x, y]: [f64; 2]) {
        let [_, _, z] = self.words;
        let word = |value: f64| Word::from_normalised(value as f32);
        self.words = [word(x), word(y), z];
    }

    /// Has its frames be read by another `decoder` from now on.
    pub const fn program(&mut self, decoder: Decoder) {
        self.decoder = decoder;
    }

    /// What the sensor reports about itself from now on.
    pub const fn set_error_word(&mut self, faults: Faults) {
        self.error_word = faults;
    }

    /// A wire fault in every frame from now on; `None` mends it. It takes
    /// precedence over [`Slave::inject`], and that over [`Slave::disturb`].
    pub const fn set_fault(&mut self, fault: Option<WireFault>) {
        self.injected.standing = fault;
    }

    /// A wire fault in the next `frames` frames; replaces what is left of the last.
    pub fn inject(&mut self, fault: WireFault, frames: u32) {
        self.injected.pass(fault, frames);
    }

    /// From now on each frame is lost with probability `lost`, else has one bit
    /// inverted with probability `flipped`. NaN and negative count as 0, a sum
    /// above 1 as 1; both 0 ends it. The same seed gives the same faults.
    pub fn disturb(&mut self, lost: f64, flipped: f64, seed: u64) {
        let (lost, flipped) = (lost.max(0.0), flipped.max(0.0));
        self.disturbance = (lost + flipped > 0.0).then(|| Disturbance {
            lost,
            flipped,
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
        });
    }

    /// Latches a frame, for a master that clocks it byte by byte itself. On those wires there is no
    /// controller to fail: [`WireFault::Bus`] reads as [`WireFault::Silent`].
    pub fn select(&mut self) -> Exchange {
        let (frame, fault) = self.latch();
        let frame = match fault {
            Some(WireFault::Bus) => [RELEASED; FRAME_LEN],
            _ => frame,
        };
        Exchange::new(frame, fault)
    }

    /// Puts the deflections of this moment into a frame that was latched before, of which
    /// no byte that carries any has been clocked yet; what happens to it stays.
    pub fn latch_again(&mut self, exchange: &mut Exchange) {
        self.measure(exchange.fault);
        exchange.replace(match exchange.fault {
            Some(WireFault::Bus) => [RELEASED; FRAME_LEN],
            fault => self.frame(fault),
        });
    }

    /// The falling edge of /SS: the frame to answer with, and what happens to it.
    fn latch(&mut self) -> ([u8; FRAME_LEN], Option<WireFault>) {
        self.traffic.transactions = self.traffic.transactions.saturating_add(1);
        let by_chance = self.disturbance.as_mut().and_then(Disturbance::draw);
        let fault = self.injected.next().or(by_chance);
        self.measure(fault);
        (self.frame(fault), fault)
    }

    fn measure(&mut self, fault: Option<WireFault>) {
        if fault != Some(WireFault::Frozen) {
            let noise = self.is_noisy && self.traffic.transactions.is_multiple_of(2);
            let noisy = |word: Word| Word::new(word.raw() | u16::from(noise));
            let words = match fault {
                Some(WireFault::NoField) => [Word::MID; 3],
                _ => self.words,
            };
            self.sent = words.map(noisy);
        }
    }

    fn frame(&self, fault: Option<WireFault>) -> [u8; FRAME_LEN] {
        let [x, y, z] = self.sent;
        let by = match fault {
            Some(WireFault::Shift(by)) => by,
            _ => 0,
        };
        let last = match self.decoder.mode {
            Mode::AlphaBeta => self.error_word.bits(),
            Mode::Xyz => z.raw(),
        };
        let words = [x.raw().wrapping_add(by), y.raw(), last];
        let mut frame = encode::words(words, self.decoder);
        match fault {
            Some(WireFault::LowAfterStart) => {
                let [_, rest @ ..] = &mut frame;
                rest.fill(0);
            }
            Some(WireFault::Silent) => frame = [RELEASED; FRAME_LEN],
            Some(WireFault::BadSum) => {
                let [.., sum] = &mut frame;
                *sum = sum.wrapping_add(1);
            }
            Some(WireFault::ByteLost(byte)) => {
                if let Some(late @ [_, ..]) = frame.get_mut(usize::from(byte)..) {
                    late[0] = RELEASED;
                    late.rotate_left(1);
                }
            }
            Some(WireFault::ByteDoubled(byte)) => {
                if let Some(late @ [_, _, ..]) = frame.get_mut(usize::from(byte)..) {
                    late.rotate_right(1);
                    late[0] = late[1];
                }
            }
            _ => {}
        }
        frame
    }
}

/// A sensor in alpha-beta mode that sends the default sum.
impl Default for Slave {
    fn default() -> Self {
        Self::of(Decoder::new())
    }
}

/// The sensor of a whisker, of either kind.
pub enum OnWire<'s> {
    /// An MLX90333.
    Mlx90333(&'s mut Slave),
    /// A TMAG5170, below its magnet.
    Tmag5170(&'s mut BelowMagnet),
}

impl<'s> OnWire<'s> {
    /// It, if it is an MLX90333.
    pub fn mlx(self) -> Option<&'s mut Slave> {
        match self {
            Self::Mlx90333(slave) => Some(slave),
            Self::Tmag5170(_) => None,
        }
    }

    /// It, if it is a TMAG5170.
    pub fn tmag(self) -> Option<&'s mut TmagSlave> {
        match self {
            Self::Mlx90333(_) => None,
            Self::Tmag5170(below) => Some(&mut below.slave),
        }
    }

    /// Deflections along x and y from now on, in units of its range.
    pub fn bend(self, deflection: [f64; 2]) {
        match self {
            Self::Mlx90333(slave) => slave.set(deflection),
            Self::Tmag5170(below) => below.bend(deflection),
        }
    }
}

/// One transaction: the frame latched at its start, byte by byte.
#[derive(Debug, Clone)]
pub struct Exchange {
    /// The shift register: the next byte on top, behind the last one a line that is released.
    answer: u64,
    fault: Option<WireFault>,
    /// What noise inverts, in the same positions.
    noise: u64,
    /// All ones, or zeros where the line is held low.
    most: u8,
    bytes: u64,
}

impl Exchange {
    fn new(frame: [u8; FRAME_LEN], fault: Option<WireFault>) -> Self {
        Self {
            answer: u64::from_be_bytes(frame),
            fault,
            noise: match fault {
                Some(WireFault::Flip(bit @ 0..64)) => 1 << (63 - bit),
                _ => 0,
            },
            most: match fault {
                Some(WireFault::LineLow) => 0,
                _ => RELEASED,
            },
            bytes: 0,
        }
    }

    /// Eight clocks: what the master reads while it sends a byte.
    pub fn byte(&mut self, sent: u8) -> u8 {
        self.bytes += 1;
        let [answered, ..] = self.answer.to_be_bytes();
        let [inverted, ..] = self.noise.to_be_bytes();
        self.answer = self.answer << 8 | u64::from(RELEASED);
        self.noise <<= 8;
        (sent & answered & self.most) ^ inverted
    }

    /// Answers from here on as if this frame had been latched.
    fn replace(&mut self, frame: [u8; FRAME_LEN]) {
        self.answer = u64::from_be_bytes(frame);
        for _ in 0..self.bytes.min(8) {
            self.answer = self.answer << 8 | u64::from(RELEASED);
        }
    }

    /// Bytes clocked so far.
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl ErrorType for Slave {
    type Error = SimSpiError;
}

impl SpiDevice for Slave {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), SimSpiError> {
        let (frame, fault) = self.latch();
        if fault == Some(WireFault::Bus) {
            return Err(SimSpiError);
        }
        let mut exchange = Exchange::new(frame, fault);
        wire::clock(operations, &mut self.traffic, |sent| exchange.byte(sent));
        Ok(())
    }
}

#[cfg(test)]
mod tests;
