//! The sensor's wires as the chip drives them, and whether the sensor bears it.
//!
//! The driver's waits are held against the sensor's data: start-up, clock, gaps between bytes, and
//! the time for which /SS must be high before the first frame. A sensor that has lost its place in
//! a frame is taken to need the same time, so it is asked for after every frame that was broken
//! off, or that the master cannot have taken for good. What it needs between good frames is not
//! known: nothing, unless it is made to be silent in frames that come sooner. A TMAG5170
//! ([`Needs::TILT`]) asks for other times, mode and pins.

use mlx90333::timing::{
    BYTE_GAP_FAST_NS, BYTE_GAP_SAFE_NS, CLOCK_MAX_HZ, CLOCK_SLOW_MAX_HZ, SS_HIGH_US,
    SS_LAG_FAST_NS, SS_LAG_SLOW_NS, SS_LEAD_SLOW_NS, START_UP_US,
};
use mlx90333::{Decoder, FRAME_LEN};
use tmag5170::timing;

use super::{Fault, Ps};

pub(crate) trait SensorEnd {
    /// A frame begins: the sensor takes what it will answer with. Its bytes are fetched by the core,
    /// which `is_polled`, or by the DMA.
    fn latch(&mut self, now: Ps, is_polled: bool);

    /// Eight clocks: what is on the line while the master sends `sent`.
    fn exchange(&mut self, sent: u8) -> u8;

    fn release(&mut self) {}
}

const fn ps(nanoseconds: u32) -> Ps {
    nanoseconds as Ps * 1_000
}

/// What a sensor needs, in one of its modes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Needs {
    clock_max_hz: u32,
    /// From the supply to the first byte.
    start_up: Ps,
    gap: Ps,
    /// From /SS low to the first byte, and from the last to /SS high.
    lead: Ps,
    lag: Ps,
    /// For which /SS is high between two frames, and after one that is not good.
    high: Ps,
    rest: Ps,
    is_good: fn(Decoder, &[u8]) -> bool,
    /// The SPI mode, and whether data to the sensor comes by an open drain, as it is joined to
    /// data from it.
    mode: u32,
    is_joined: bool,
}

impl Default for Needs {
    fn default() -> Self {
        Self::FAST
    }
}

impl Needs {
    pub(crate) const FAST: Self = Self {
        clock_max_hz: CLOCK_MAX_HZ,
        start_up: ps(START_UP_US * 1_000),
        gap: ps(BYTE_GAP_FAST_NS),
        lead: 0,
        lag: ps(SS_LAG_FAST_NS),
        high: 0,
        rest: ps(SS_HIGH_US * 1_000),
        is_good: |decoder, read| {
            let frame = <[u8; FRAME_LEN]>::try_from(read);
            frame.is_ok_and(|frame| decoder.decode(&frame).is_ok())
        },
        mode: 1,
        is_joined: true,
    };
    pub(crate) const SLOW: Self = Self {
        clock_max_hz: CLOCK_SLOW_MAX_HZ,
        gap: ps(BYTE_GAP_SAFE_NS),
        lead: ps(SS_LEAD_SLOW_NS),
        lag: ps(SS_LAG_SLOW_NS),
        ..Self::FAST
    };
    pub(crate) const TILT: Self = Self {
        clock_max_hz: timing::CLOCK_MAX_HZ,
        start_up: ps(timing::START_UP_US * 1_000),
        gap: 0,
        lead: ps(timing::CS_SETUP_NS),
        lag: ps(timing::CS_SETUP_NS),
        high: ps(timing::CS_HIGH_NS),
        rest: 0,
        is_good: |_, _| true,
        mode: 0,
        is_joined: false,
    };
}

#[derive(Debug, Clone, Default)]
pub(crate) struct SensorLines {
    pub(crate) needs: Needs,
    /// How its frames are read.
    decoder: Decoder,
    /// In a frame that comes sooner after the last it is silent.
    silence: Ps,
    /// It does not see /SS rise, and takes all bytes for one frame; whether that is over.
    stuck: Option<bool>,
    side: &'static str,
    selected: bool,
    /// When /SS fell.
    fell: Ps,
    /// No byte has been clocked since /SS fell.
    fresh: bool,
    ended: Option<Ps>,
    /// When the byte that the sensor has seen began.
    seen: Option<Ps>,
    /// What the master has read since /SS fell, and where the DMA has put it.
    read: Vec<u8>,
    put: Vec<u32>,
    /// When /SS rose, and whether the frame was good.
    rose: Option<(Ps, bool)>,
    /// It has risen, and the sensor does not know.
    is_over: bool,
    /// What /SS has done wrong: reported with the next byte.
    wrong: Option<&'static str>,
}

/// It fell too soon after it rose.
const EARLY: &str = "a frame too soon after one that was not good";
const CLOSE: &str = "a frame too soon after the last";
/// It rose too soon after the last byte.
const CUT: &str = "/SS high too soon after the last byte";

impl SensorLines {
    pub(super) fn new(side: &'static str) -> Self {
        Self {
            side,
            ..Self::default()
        }
    }

    /// Its frames are read by `decoder`; it is silent in those that come sooner than `rest_us` after
    /// the last.
    pub(crate) fn program(&mut self, decoder: Decoder, rest_us: u32) {
        self.decoder = decoder;
        self.silence = ps(rest_us * 1_000);
    }

    pub(crate) const fn stick(&mut self, is_stuck: bool) {
        self.stuck = if is_stuck { Some(false) } else { None };
    }

    /// The SPI mode that the sensor needs, and whether its lines of data are joined.
    pub(super) const fn wires(&self) -> (u32, bool) {
        (self.needs.mode, self.needs.is_joined)
    }

    pub(super) fn select(&mut self, low: bool, now: Ps) {
        if low && !self.selected {
            self.fell = now;
            self.fresh = true;
            self.ended = None;
            self.read.clear();
            self.put.clear();
            if matches!(self.wrong, Some(EARLY | CLOSE)) {
                self.wrong = None;
            }
            if let Some((rose, is_good)) = self.rose {
                let high = now.saturating_sub(rose);
                if high < self.needs.high {
                    self.wrong = Some(CLOSE);
                } else if !is_good && high < self.needs.rest {
                    self.wrong = Some(EARLY);
                }
            }
        } else if !low && self.selected {
            let is_good = (self.needs.is_good)(self.decoder, &self.read);
            let lag = self.ended.map(|ended| now.saturating_sub(ended));
            if is_good && lag.is_some_and(|lag| lag < self.needs.lag) {
                self.wrong = Some(CUT);
            }
            self.rose = Some((now, is_good));
            self.is_over = true;
            if let Some(is_over) = &mut self.stuck {
                *is_over = true;
            }
        }
        self.selected = low;
    }

    fn is_silent(&self) -> bool {
        let rested = self.rose.map(|(rose, _)| self.fell.saturating_sub(rose));
        // What follows a frame that does not end is a line that is let go.
        self.stuck == Some(true) || rested.is_some_and(|rested| rested < self.silence)
    }

    /// Whether /SS has risen since the last call.
    pub(super) const fn take_over(&mut self) -> bool {
        std::mem::replace(&mut self.is_over, false)
    }

    /// A byte began, at that time and of bits so long: the first of a frame makes the sensor latch.
    pub(super) fn begin(
        &mut self,
        (began, bit): (Ps, Ps),
        is_polled: bool,
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
        if began < self.needs.start_up {
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
            sensor.latch(began, is_polled);
        }
        Ok(())
    }

    pub(super) fn put(&mut self, place: u32) {
        self.put.push(place);
    }

    /// The sensor has said this so far, and nothing else: where the DMA has put it. None of a frame
    /// in which the sensor was not connected all the time.
    pub(crate) fn say_again(&mut self, said: &[u8]) -> Vec<u32> {
        if self.is_silent() || said.len() != self.read.len() || said.len() != self.put.len() {
            return Vec::new();
        }
        self.read = said.to_vec();
        self.put.clone()
    }

    /// A byte ended: what the master has read from the sensor, if it is connected.
    pub(super) fn end(&mut self, sent: u8, now: Ps, sensor: Option<&mut impl SensorEnd>) -> u8 {
        self.ended = Some(now);
        let read = match sensor {
            Some(sensor) if self.selected && !self.is_silent() => sensor.exchange(sent),
            _ => 0xFF,
        };
        self.read.push(read);
        read
    }
}
