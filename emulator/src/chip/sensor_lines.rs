//! The sensor's wires as the chip drives them, and whether the sensor bears it.
//!
//! The driver's waits are held against the sensor's data: start-up, clock,
//! gaps between bytes, and the time for which /SS must be high before the first
//! frame. A sensor that has lost its place in a frame is taken to need the same
//! time, so it is asked for after every frame that was broken off, or that the
//! master cannot have taken for good. (What it needs between good frames is not
//! known.)

use mlx90333::timing::{BYTE_GAP_FAST_NS, CLOCK_MAX_HZ, SS_HIGH_US, START_UP_US};
use mlx90333::{Decoder, FRAME_LEN};

use super::fault::Fault;
use super::time::Ps;

/// The sensor's end of the wires.
pub(crate) trait SensorEnd {
    /// A frame begins: the sensor takes what it will answer with.
    fn latch(&mut self, now: Ps);

    /// Eight clocks: what is on the line while the master sends `sent`.
    fn exchange(&mut self, sent: u8) -> u8;
}

const fn ps(nanoseconds: u32) -> Ps {
    nanoseconds as Ps * 1_000
}

#[derive(Debug, Clone, Default)]
pub(super) struct SensorLines {
    /// What messages call the side.
    side: &'static str,
    selected: bool,
    /// No byte has been clocked since /SS fell.
    fresh: bool,
    /// When the last byte ended.
    ended: Option<Ps>,
    /// When the byte that the sensor has been told of began.
    told: Option<Ps>,
    /// What the master has read since /SS fell.
    read: Vec<u8>,
    /// When /SS rose after a frame that was not good.
    bad: Option<Ps>,
    /// /SS fell too soon after that.
    early: bool,
}

impl SensorLines {
    pub(super) fn new(side: &'static str) -> Self {
        Self {
            side,
            ..Self::default()
        }
    }

    /// /SS is at this level from `now` on.
    pub(super) fn select(&mut self, low: bool, now: Ps) {
        if low && !self.selected {
            self.fresh = true;
            self.ended = None;
            self.read.clear();
            let high = self.bad.map(|bad| now.saturating_sub(bad));
            self.early = high.is_some_and(|high| high < ps(SS_HIGH_US * 1_000));
        } else if !low && self.selected {
            let bytes = <[u8; FRAME_LEN]>::try_from(self.read.as_slice());
            let is_good = bytes.is_ok_and(|bytes| Decoder::new().decode(&bytes).is_ok());
            self.bad = (!is_good).then_some(now);
        }
        self.selected = low;
    }

    /// A byte began: the first of a frame makes the sensor latch.
    ///
    /// # Errors
    /// [`Fault::Wires`] if it comes too early or too fast.
    pub(super) fn begin(
        &mut self,
        began: Ps,
        bit: Ps,
        sensor: &mut impl SensorEnd,
    ) -> Result<(), Fault> {
        if self.told == Some(began) || !self.selected {
            return Ok(());
        }
        self.told = Some(began);
        let side = self.side;
        let wrong = |what| Err(Fault::Wires { side, what });
        if bit * Ps::from(CLOCK_MAX_HZ) < 1_000_000_000_000 {
            return wrong("the clock is too fast");
        }
        if began < ps(START_UP_US * 1_000) {
            return wrong("a frame within the sensor's start-up");
        }
        if self.early {
            return wrong("a frame too soon after one that was not good");
        }
        let gap = self.ended.map(|ended| began.saturating_sub(ended));
        if gap.is_some_and(|gap| gap < ps(BYTE_GAP_FAST_NS)) {
            return wrong("the gap between two bytes is too short");
        }
        if self.fresh {
            self.fresh = false;
            sensor.latch(began);
        }
        Ok(())
    }

    /// A byte ended: what the master has read from the sensor, if it is connected.
    pub(super) fn end(&mut self, sent: u8, now: Ps, sensor: Option<&mut impl SensorEnd>) -> u8 {
        self.ended = Some(now);
        let read = match sensor {
            Some(sensor) if self.selected => sensor.exchange(sent),
            _ => 0xFF,
        };
        self.read.push(read);
        read
    }
}
