//! The sensor's wires as the chip drives them, and whether the sensor bears it.
//!
//! The driver's waits are held against the sensor's data: start-up, clock,
//! gaps between bytes, and the time for which /SS must be high before the first
//! frame. A sensor that has lost its place in a frame is taken to need the same
//! time, so it is asked for after every frame that was broken off, or that the
//! master cannot have taken for good. What it needs between good frames is not known: nothing,
//! unless it is made to be silent in frames that come sooner.

use mlx90333::timing::{
    BYTE_GAP_FAST_NS, BYTE_GAP_SAFE_NS, CLOCK_MAX_HZ, CLOCK_SLOW_MAX_HZ, SS_HIGH_US,
    SS_LAG_FAST_NS, SS_LAG_SLOW_NS, SS_LEAD_SLOW_NS, START_UP_US,
};
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

/// What a sensor needs in one of its modes.
#[derive(Debug, Clone)]
struct Needs {
    clock_max_hz: u32,
    /// Between two bytes.
    gap: Ps,
    /// From /SS low to the first byte, and from the last to /SS high.
    lead: Ps,
    lag: Ps,
}

impl Needs {
    const FAST: Self = Self {
        clock_max_hz: CLOCK_MAX_HZ,
        gap: ps(BYTE_GAP_FAST_NS),
        lead: 0,
        lag: ps(SS_LAG_FAST_NS),
    };
    const SLOW: Self = Self {
        clock_max_hz: CLOCK_SLOW_MAX_HZ,
        gap: ps(BYTE_GAP_SAFE_NS),
        lead: ps(SS_LEAD_SLOW_NS),
        lag: ps(SS_LAG_SLOW_NS),
    };
}

#[derive(Debug, Clone)]
pub(super) struct SensorLines {
    needs: Needs,
    /// How its frames are read.
    decoder: Decoder,
    /// In a frame that comes sooner after the last it is silent.
    rest: Ps,
    is_silent: bool,
    /// When /SS rose.
    rose: Option<Ps>,
    /// What messages call the side.
    side: &'static str,
    selected: bool,
    /// When /SS fell.
    fell: Ps,
    /// No byte has been clocked since /SS fell.
    fresh: bool,
    /// When the last byte ended.
    ended: Option<Ps>,
    /// When the byte that the sensor has seen began.
    seen: Option<Ps>,
    /// What the master has read since /SS fell, and where the DMA has put it.
    read: Vec<u8>,
    put: Vec<u32>,
    /// When /SS rose after a frame that was not good.
    bad: Option<Ps>,
    /// What /SS has done wrong: reported with the next byte.
    wrong: Option<&'static str>,
}

/// It fell too soon after it rose.
const EARLY: &str = "a frame too soon after one that was not good";
/// It rose too soon after the last byte.
const CUT: &str = "/SS high too soon after the last byte";

impl SensorLines {
    pub(super) fn new(side: &'static str) -> Self {
        Self {
            needs: Needs::FAST,
            decoder: Decoder::new(),
            rest: 0,
            is_silent: false,
            rose: None,
            side,
            selected: false,
            fell: 0,
            fresh: false,
            ended: None,
            seen: None,
            read: Vec::new(),
            put: Vec::new(),
            bad: None,
            wrong: None,
        }
    }

    /// The sensor is in its slow mode from now on.
    pub(super) fn slow_down(&mut self) {
        self.needs = Needs::SLOW;
    }

    /// Its frames are read by `decoder`, and come `rest_us` after the last at the earliest.
    pub(super) fn program(&mut self, decoder: Decoder, rest_us: u32) {
        self.decoder = decoder;
        self.rest = ps(rest_us * 1_000);
    }

    /// /SS is at this level from `now` on.
    pub(super) fn select(&mut self, low: bool, now: Ps) {
        if low && !self.selected {
            self.fell = now;
            let rested = self.rose.map(|rose| now.saturating_sub(rose));
            self.is_silent = rested.is_some_and(|rested| rested < self.rest);
            self.fresh = true;
            self.ended = None;
            self.read.clear();
            self.put.clear();
            let high = self.bad.map(|bad| now.saturating_sub(bad));
            if high.is_some_and(|high| high < ps(SS_HIGH_US * 1_000)) {
                self.wrong = Some(EARLY);
            } else if self.wrong == Some(EARLY) {
                self.wrong = None;
            }
        } else if !low && self.selected {
            self.rose = Some(now);
            let bytes = <[u8; FRAME_LEN]>::try_from(self.read.as_slice());
            let is_good = bytes.is_ok_and(|bytes| self.decoder.decode(&bytes).is_ok());
            let lag = self.ended.map(|ended| now.saturating_sub(ended));
            if is_good && lag.is_some_and(|lag| lag < self.needs.lag) {
                self.wrong = Some(CUT);
            }
            self.bad = (!is_good).then_some(now);
        }
        self.selected = low;
    }

    /// A byte began: the first of a frame makes the sensor latch.
    pub(super) fn begin(
        &mut self,
        began: Ps,
        bit: Ps,
        sensor: &mut impl SensorEnd,
    ) -> Result<(), Fault> {
        if self.seen == Some(began) || !self.selected {
            return Ok(());
        }
        self.seen = Some(began);
        let side = self.side;
        let wrong = |what| Err(Fault::Wires { side, what });
        if bit * Ps::from(self.needs.clock_max_hz) < 1_000_000_000_000 {
            return wrong("the clock is too fast");
        }
        if began < ps(START_UP_US * 1_000) {
            return wrong("a frame within the sensor's start-up");
        }
        if let Some(what) = self.wrong {
            return wrong(what);
        }
        if self.fresh && began.saturating_sub(self.fell) < self.needs.lead {
            return wrong("a byte too soon after /SS low");
        }
        let gap = self.ended.map(|ended| began.saturating_sub(ended));
        if gap.is_some_and(|gap| gap < self.needs.gap) {
            return wrong("the gap between two bytes is too short");
        }
        if self.fresh {
            self.fresh = false;
            sensor.latch(began);
        }
        Ok(())
    }

    /// The DMA has put the next byte there.
    pub(super) fn put(&mut self, place: u32) {
        self.put.push(place);
    }

    /// The sensor has said this so far, and nothing else: where it was put.
    pub(super) fn say_again(&mut self, said: &[u8]) -> Vec<u32> {
        if self.is_silent || said.len() != self.read.len() || said.len() != self.put.len() {
            return Vec::new();
        }
        self.read = said.to_vec();
        self.put.clone()
    }

    /// A byte ended: what the master has read from the sensor, if it is connected.
    pub(super) fn end(&mut self, sent: u8, now: Ps, sensor: Option<&mut impl SensorEnd>) -> u8 {
        self.ended = Some(now);
        let read = match sensor {
            Some(sensor) if self.selected && !self.is_silent => sensor.exchange(sent),
            _ => 0xFF,
        };
        self.read.push(read);
        read
    }
}
