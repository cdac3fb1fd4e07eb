//! How often nodes say what, in ticks.

/// Times of the bus in ticks, from one on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Times {
    /// From the stamp of a message to its effect: 4 ms.
    pub(super) delay: u16,
    /// Between two ψ of a side: 2 ms.
    pub(super) psi: u16,
    /// Between two messages of contact: 10 ms.
    pub(super) contact: u16,
    /// Least between two of contact that rises: 5 ms.
    pub(super) rise: u16,
    /// After which a node that is not heard does not live: three times that of contact.
    pub(super) drop: u16,
}

impl Times {
    /// At so many ticks a second, up to 20,000.
    pub(super) const fn at(tick_hz: u32) -> Self {
        const fn ticks(ms: u32, tick_hz: u32) -> u16 {
            (ms * tick_hz).div_ceil(1000) as u16
        }
        let contact = ticks(10, tick_hz);
        Self {
            delay: ticks(4, tick_hz),
            psi: ticks(2, tick_hz),
            contact,
            rise: ticks(5, tick_hz),
            drop: 3 * contact,
        }
    }
}
