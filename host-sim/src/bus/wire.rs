//! What the sensors on mock buses share: bytes, traffic, and faults that come and go.

use embedded_hal::spi::{ErrorKind, Operation};

/// What a line reads when nothing pulls it low.
pub(super) const RELEASED: u8 = 0xFF;

/// What the master sends where embedded-hal leaves it open (reads, and a transfer whose answer is
/// longer than what it sends). Zero is the value that a driver for these sensors must not rely on.
const FILLER: u8 = 0x00;

/// What has gone over a bus since its slave was made.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Traffic {
    /// Times that /SS went low, failed transactions included.
    pub(super) transactions: u64,
    pub(super) bytes: u64,
    /// Sum of the delays asked for inside transactions.
    pub(super) delay_ns: u64,
}

/// The bus controller failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("simulated bus error")]
pub struct SimSpiError;

impl embedded_hal::spi::Error for SimSpiError {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

/// `byte` takes what the master sends and gives what it reads. Counts delays and bytes.
pub(super) fn clock(
    operations: &mut [Operation<'_, u8>],
    traffic: &mut Traffic,
    mut byte: impl FnMut(u8) -> u8,
) {
    let mut byte = |sent| {
        traffic.bytes = traffic.bytes.saturating_add(1);
        byte(sent)
    };
    for operation in operations {
        match operation {
            Operation::Read(buffer) => transfer(buffer, &[], &mut byte),
            Operation::Write(bytes) => transfer(&mut [], bytes, &mut byte),
            Operation::Transfer(read, write) => transfer(read, write, &mut byte),
            Operation::TransferInPlace(buffer) => {
                for slot in buffer.iter_mut() {
                    *slot = byte(*slot);
                }
            }
            Operation::DelayNs(ns) => {
                traffic.delay_ns = traffic.delay_ns.saturating_add(u64::from(*ns));
            }
        }
    }
}

fn transfer(read: &mut [u8], write: &[u8], byte: &mut impl FnMut(u8) -> u8) {
    for i in 0..read.len().max(write.len()) {
        let received = byte(write.get(i).copied().unwrap_or(FILLER));
        if let Some(slot) = read.get_mut(i) {
            *slot = received;
        }
    }
}

/// A fault that stays until it is mended, or for some frames.
#[derive(Debug, Clone)]
pub(super) struct Injected<F> {
    /// In every frame; none: mended.
    pub(super) standing: Option<F>,
    passing: Option<(F, u32)>,
}

impl<F: Copy> Injected<F> {
    pub(super) const NONE: Self = Self {
        standing: None,
        passing: None,
    };

    /// In the next `frames` frames; replaces what is left of the last.
    pub(super) fn pass(&mut self, fault: F, frames: u32) {
        self.passing = (frames > 0).then_some((fault, frames));
    }

    /// The fault of the next frame. A standing one takes precedence, and a passing one goes
    /// by meanwhile.
    pub(super) fn next(&mut self) -> Option<F> {
        let passing = self.passing.map(|(fault, _)| fault);
        self.passing = self
            .passing
            .and_then(|(fault, left)| Some((fault, left.checked_sub(1).filter(|&n| n > 0)?)));
        self.standing.or(passing)
    }
}
