use super::{Reading, Sensor, SensorLimits};
use crate::io::{BusError, FrameSource};
use crate::{BAD_WEIGHT, Event, Place, SensorFault};
use mlx90333::{Decoder, FRAME_LEN, Faults, FrameError, SumRule, Word, encode};

const PLACE: Place = Place::new(1, 4);

const LIMITS: SensorLimits = SensorLimits {
    hold: 3,
    recover: 2,
    resync: 0,
    stale: 3,
    frozen: 9,
    jump: 0x2000,
    burst: 40,
    zero: None,
    swing: None,
};

type Taken = Result<Option<[u8; FRAME_LEN]>, BusError>;

const BAD: Taken = Ok(Some([0xFF; FRAME_LEN]));

struct Script<I> {
    frames: I,
    last: Option<[u8; FRAME_LEN]>,
    tick: usize,
    started: Vec<usize>,
}

impl<I: Iterator<Item = Taken>> FrameSource for Script<I> {
    fn take(&mut self) -> Taken {
        let taken = self.frames.next().unwrap_or(Ok(None));
        self.last = taken.ok().flatten().or(self.last);
        taken
    }

    fn last(&self) -> Option<[u8; FRAME_LEN]> {
        self.last
    }

    fn start(&mut self) {
        self.started.push(self.tick);
    }
}

fn frame(x: u16) -> [u8; FRAME_LEN] {
    encode::alpha_beta(Word::new(x), Word::MID, Faults::NONE, SumRule::SumB1B6)
}

fn good<const N: usize>(words: [u16; N]) -> [Taken; N] {
    words.map(|x| Ok(Some(frame(x))))
}

/// Readings, events with their ticks, and the ticks in which frames were started.
type Course = (Vec<Reading>, Vec<(usize, Event)>, Vec<usize>);

fn course(limits: SensorLimits, script: &[Taken], ticks: usize) -> Course {
    let script = Script {
        frames: script.iter().copied(),
        last: None,
        tick: 0,
        started: Vec::new(),
    };
    let mut sensor = Sensor::new(script, false);
    let mut events = Vec::new();
    let readings = (0..ticks)
        .map(|tick| {
            sensor.source.tick = tick;
            sensor.read(Decoder::new(), &limits, PLACE, &mut |e| {
                events.push((tick, e));
            })
        })
        .collect();
    (readings, events, sensor.source.started)
}

fn play(script: &[Taken]) -> (Vec<Reading>, Vec<(usize, Event)>) {
    let (readings, events, _) = course(LIMITS, script, script.len());
    (readings, events)
}

#[test]
fn a_short_gap_is_bridged_and_a_long_one_is_a_fault() {
    let [first, second] = good([0x9000, 0xA000]);
    let (readings, events) = play(&[first, BAD, BAD, BAD, second, BAD, BAD, BAD, BAD, BAD]);
    assert!(readings[..8].iter().all(|r| r.valid));
    assert_eq!(readings[3].x.raw(), 0x9000, "held");
    assert!(!readings[3].fresh && readings[4].fresh);
    let lost = Event::SensorLost(PLACE, SensorFault::Frame(FrameError::NoSensor));
    assert_eq!(events, [(8, lost)], "reported once");
    assert_eq!(readings[8].x, Word::MID, "a faulty sensor feels nothing");
    assert!(!readings[9].valid);
}

/// Its sister answers nothing for 16 ms after it has reported an error.
#[test]
fn an_error_is_reported_though_the_sensor_then_starts_again() {
    let faults = Faults::GAIN_TOO_LOW;
    let word = encode::alpha_beta(Word::MID, Word::MID, faults, SumRule::SumB1B6);
    let [good] = good([0x9000]);
    let (_, events) = play(&[good, Ok(Some(word)), BAD, BAD, BAD, BAD]);
    let reported = SensorFault::Frame(FrameError::Sensor(faults));
    assert_eq!(events, [(4, Event::SensorLost(PLACE, reported))]);
    // Silence before it is no part of it.
    let (_, events) = play(&[good, BAD, Ok(Some(word)), BAD, BAD, BAD]);
    assert_eq!(events[0], (4, Event::SensorLost(PLACE, reported)));
}

#[test]
fn recovery_needs_good_frames_in_a_row() {
    let bad = Err(BusError);
    let [one, two, three] = good([1, 2, 0x1000]);
    let (readings, events) = play(&[bad, bad, Ok(None), bad, one, bad, two, three, Ok(None)]);
    let lost = Event::SensorLost(PLACE, SensorFault::Bus);
    assert_eq!(events, [(3, lost), (7, Event::SensorBack(PLACE))]);
    assert!(!readings[6].valid && readings[7].valid && readings[8].valid);
    assert_eq!(readings[8].x.raw(), 0x1000);
}

/// The tick that finds it bad, and `resync` more; the fault is that of the frame.
#[test]
fn after_a_bad_frame_none_is_started_for_a_while() {
    let limits = SensorLimits {
        resync: 2,
        hold: 7,
        burst: u16::MAX,
        ..LIMITS
    };
    let [one, two, three] = good([0x8100, 0x8200, 0x8300]);
    let script = [one, BAD, two, Err(BusError), BAD, BAD, three];
    let (readings, events, started) = course(limits, &script, 20);
    // Ticks 1, 5, 8 and 11 find bad frames.
    assert_eq!(started[..7], [0, 3, 4, 7, 10, 13, 14]);
    let fresh = readings.iter().enumerate().filter(|(_, r)| r.fresh);
    let fresh: Vec<usize> = fresh.map(|(tick, _)| tick).collect();
    assert_eq!(fresh, [0, 4]);
    let lost = Event::SensorLost(PLACE, SensorFault::Frame(FrameError::NoSensor));
    assert_eq!(events, [(12, lost)]);
}

#[test]
fn words_that_repeat_are_no_evidence_and_then_a_fault() {
    let mut script = vec![Ok(Some(frame(0x8100)))];
    script.extend([Ok(Some(frame(0x8101))); 8]);
    script.push(BAD);
    script.extend([Ok(Some(frame(0x8101))); 9]);
    let (readings, events) = play(&script);
    // Repeated for the first time in tick 2, and bridged in tick 9.
    assert!(readings[..=4].iter().all(|r| r.current));
    assert!(readings[5..].iter().all(|r| r.valid != r.current));
    let lost = Event::SensorLost(PLACE, SensorFault::Frozen);
    assert_eq!(events, [(12, lost)]);

    // It is not back before the words change, and do so again.
    script.extend(good([0x8102; 9]));
    script.extend(good([0x8103, 0x8104]));
    let (_, events) = play(&script);
    assert_eq!(events[1], (20, Event::SensorBack(PLACE)));
    let once = [Ok(Some(frame(0x8101))); 40];
    assert_eq!(play(&once).1.len(), 1, "it stays away");
}

#[test]
fn a_jump_is_bridged_and_jumps_are_a_fault() {
    let [rest, far, near] = good([0x8000, 0xA002, 0xA000]);
    let (readings, events) = play(&[rest, far, rest, near, near]);
    let fresh = readings.iter().map(|r| r.fresh);
    assert!(fresh.eq([true, false, true, true, true]));
    assert_eq!(events, []);
    // Where it stays, the whisker may have moved there in the meantime.
    let (readings, events) = play(&[rest, far, far, far]);
    assert_eq!((readings[2].x.raw(), events), (0xA002, vec![]));

    let [other] = good([0x8001]);
    let script = [rest, far, other, far].repeat(10);
    let lost = Event::SensorLost(PLACE, SensorFault::Jump);
    assert_eq!(play(&script).1, [(27, lost)]);
}

/// More than a fifth of the ticks, in the long run.
#[test]
fn bad_frames_that_are_too_many_are_a_fault_though_none_is_long() {
    let every = |n: usize| -> Vec<Taken> {
        let good = |tick: usize| Ok(Some(frame(0x8000 + tick as u16 % 7)));
        let ticks = 1..1000;
        ticks
            .map(|tick| if tick % n == 0 { BAD } else { good(tick) })
            .collect()
    };
    let why = SensorFault::Often(18);
    let lost = |tick| (tick, Event::SensorLost(PLACE, why));
    assert_eq!(play(&every(2)).1, [lost(27)]);
    assert!(!play(&every(BAD_WEIGHT.into())).1.is_empty());
    assert_eq!(play(&every(usize::from(BAD_WEIGHT) + 1)).1, []);
}

/// Bytes say more than "all ones" and "all zeros" of what came.
#[test]
fn a_frame_that_was_refused_is_shown() {
    let mut summed = frame(0x9000);
    summed[7] ^= 0x55;
    let shown = |bytes| {
        let script = [Ok(Some(bytes)); 30];
        let (_, events) = play(&script);
        let of_frame = |event: &(usize, Event)| match event.1 {
            Event::Frame(PLACE, bytes) => Some(bytes),
            _ => None,
        };
        events.iter().find_map(of_frame)
    };
    assert_eq!(shown(summed), Some(summed));
    assert_eq!(shown([0xFE; FRAME_LEN]), Some([0xFE; FRAME_LEN]));
    assert_eq!(shown([0xFF; FRAME_LEN]), None);
    assert_eq!(shown([0; FRAME_LEN]), None);
}
