//! Telemetry of a program that has it: packets and requests through rings in RAM.

#[path = "configs.rs"]
mod configs;

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use firmware::{About, Event, Link, ModelState, Notes, PacketSink, PacketSlot, Part};
use wire::{
    Answer, Command, CommandStatus, Load, PACKET_BYTES, PACKET_WORDS, REQUEST_BYTES, TaggedCommand,
};

use crate::board::integrity::Changed;
use crate::board::log;
use crate::board::rtt::{DOWN, PACKETS, PACKETS_COUNT, REQUESTS, UP};
use crate::board::slots::{self, ROOM};
use crate::board::types::{Inner, Settings};
pub(crate) use configs::{Configs, Queue};
use configs::{End, Spare, Verdict};

/// A request from idle to the tick: its words but for the sum, which is right; then what idle has
/// found out about it, a [`Verdict`].
static INBOX: [AtomicU32; 5] = [const { AtomicU32::new(0) }; 5];

/// Whether one lies there. Idle sets it, the tick clears it; loads and stores will do, as idle
/// cannot interrupt the tick.
static IS_FULL: AtomicBool = AtomicBool::new(false);

/// Whether that came by the serial port, and is answered there.
static IS_BY_SERIAL: AtomicBool = AtomicBool::new(false);

/// Whether packets go by the serial port: whoever has asked for records last reads them.
/// Only idle has it.
static SERIAL_READS: AtomicBool = AtomicBool::new(false);

/// Whether a request or an answer waits for the tick.
static WAITS: AtomicBool = AtomicBool::new(false);

/// Whether the tick has anything to do for the link: that, or records.
static IS_BUSY: AtomicBool = AtomicBool::new(false);

/// Takes the next request that a PC has written, unless the tick has yet to take the last;
/// for idle.
pub(crate) fn hear(configs: &mut Configs) {
    if !IS_FULL.load(Ordering::Relaxed) && DOWN.waiting() as usize >= REQUEST_BYTES {
        next(configs);
    }
}

/// Hands the next request to the tick.
#[cold]
fn next(configs: &mut Configs) {
    if let Some(words) = read_request() {
        SERIAL_READS.store(false, Ordering::Relaxed);
        post(words, false, configs);
    }
}

/// The next request. Bytes that are none are passed over with all that was written by then:
/// nobody knows where the next begins.
fn read_request() -> Option<[u32; 2]> {
    let mut at = DOWN.reader() as usize;
    let mut bytes = [0; REQUEST_BYTES];
    for byte in &mut bytes {
        if let Some(place) = REQUESTS.get(at) {
            // Erased, lest a flipped bit in an offset has it carried out again.
            *byte = place.load(Ordering::Relaxed);
            place.store(0, Ordering::Relaxed);
        }
        at = if at + 1 < REQUESTS.len() { at + 1 } else { 0 };
    }
    let words = wire::summed(&bytes);
    let read = words.map_or_else(|| DOWN.writer(), |_| at as u32);
    DOWN.has_read(read);
    words
}

/// Hands a request to the tick.
fn post(words: [u32; 2], is_by_serial: bool, configs: &mut Configs) {
    let verdict = TaggedCommand::from_words(words).map_or(Verdict::Unknown, |request| {
        log::requested(request.command);
        configs.prepare(request.command)
    });
    for (place, word) in INBOX.iter().zip(words.into_iter().chain(verdict.words())) {
        place.store(word, Ordering::Relaxed);
    }
    IS_BY_SERIAL.store(is_by_serial, Ordering::Relaxed);
    IS_FULL.store(true, Ordering::Release);
    WAITS.store(true, Ordering::Release);
    IS_BUSY.store(true, Ordering::Release);
}

/// Hands a request of the serial port to the tick; whether that could take it. Whoever asks
/// for records there has them from then on, and no probe.
pub(crate) fn ask_by_serial(words: [u32; 2], configs: &mut Configs) -> bool {
    if IS_FULL.load(Ordering::Relaxed) {
        return false;
    }
    let request = TaggedCommand::from_words(words);
    if request.is_ok_and(|request| request.command == Command::Stream(true)) {
        UP.has_read(UP.writer());
        SERIAL_READS.store(true, Ordering::Relaxed);
    }
    post(words, true, configs);
    true
}

/// The next packet, if packets go by the serial port.
pub(crate) fn packet_for_serial() -> Option<[u32; PACKET_WORDS]> {
    if !SERIAL_READS.load(Ordering::Relaxed) || (UP.waiting() as usize) < PACKET_BYTES {
        return None;
    }
    let packet = PACKETS.get(UP.reader() as usize / PACKET_BYTES)?;
    Some(packet.get())
}

/// That packet is sent.
pub(crate) fn has_taken_packet() {
    let next = UP.reader() as usize / PACKET_BYTES + 1;
    let next = if next < PACKETS_COUNT { next } else { 0 };
    UP.has_read((next * PACKET_BYTES) as u32);
}

/// The answer to the serial port's last request, from the tick to idle.
static ANSWER: PacketSlot = PacketSlot::new();

/// Whether one lies there. The tick sets it, idle clears it.
static IS_ANSWERED: AtomicBool = AtomicBool::new(false);

/// It, once it is there.
pub(crate) fn answer_for_serial() -> Option<[u32; PACKET_WORDS]> {
    let is_answered = IS_ANSWERED.load(Ordering::Acquire);
    is_answered.then(|| ANSWER.get())
}

/// It is sent.
pub(crate) fn has_taken_answer() {
    IS_ANSWERED.store(false, Ordering::Release);
}

/// Who wants a scene loaded, whose answer lies there then: nobody, somebody at the serial port,
/// or at a probe. A flipped bit makes none of these from another, lest it costs a scene.
static TO_LOAD: AtomicU32 = AtomicU32::new(0);
const BY_SERIAL: u32 = 0x5A5A_A5A5;
const BY_PROBE: u32 = 0xC33C_3CC3;

/// Words of it: of the configuration, of the model.
static LOAD: [AtomicU32; 2] = [const { AtomicU32::new(0) }; 2];

/// What somebody wants to be loaded, the answer to it, and whether that is at the serial port.
pub(crate) fn to_load() -> Option<(Load, Answer, bool)> {
    let by = TO_LOAD.load(Ordering::Acquire);
    if by != BY_SERIAL && by != BY_PROBE {
        return None;
    }
    let [config, model] = LOAD
        .each_ref()
        .map(|words| words.load(Ordering::Relaxed) as u16);
    let answer = Answer::from_words(ANSWER.get());
    Some((Load { config, model }, answer, by == BY_SERIAL))
}

/// The probe's end of a loader, to which nobody else listens any more.
pub(crate) struct ProbeLine(Packets);

impl ProbeLine {
    /// From the next packet on.
    pub(crate) fn new() -> Self {
        Self(Packets {
            next: UP.writer() as usize / PACKET_BYTES,
            room: 0,
        })
    }

    /// The next request.
    pub(crate) fn next(&mut self) -> Option<TaggedCommand> {
        if (DOWN.waiting() as usize) < REQUEST_BYTES {
            return None;
        }
        TaggedCommand::from_words(read_request()?).ok()
    }

    /// Sends an answer.
    pub(crate) fn reply(&mut self, answer: &Answer) {
        self.0.put(|slot| slot.set(answer.words()));
    }

    /// Whether all was fetched.
    pub(crate) fn has_sent(&self) -> bool {
        UP.waiting() == 0
    }
}

/// The tick's end of the answer to the serial port.
struct SerialAnswer;

impl PacketSink for SerialAnswer {
    fn put(&mut self, fill: impl FnOnce(&PacketSlot)) -> bool {
        if IS_ANSWERED.load(Ordering::Acquire) {
            return false;
        }
        fill(&ANSWER);
        IS_ANSWERED.store(true, Ordering::Release);
        true
    }
}

/// Whether there is something to be done after a tick.
#[inline]
pub(crate) fn is_busy() -> bool {
    IS_BUSY.load(Ordering::Relaxed)
}

/// Whether a request or an answer waits.
#[inline]
pub(crate) fn waits() -> bool {
    WAITS.load(Ordering::Relaxed)
}

/// What the events of this tick say.
static NOTES: Notes = Notes::new();

/// Notes an event of this tick.
// Apart, as there are many places with events, and few events.
#[inline(never)]
pub(crate) fn note(event: &Event) {
    NOTES.note(event);
}

/// The module's end of the link.
pub(crate) struct Telemetry {
    link: Link,
    packets: Packets,
    about: About,
    /// What is to be answered came by the serial port.
    is_by_serial: bool,
    changed: Changed,
    /// Idle, where other settings come from.
    idle: End,
}

impl Telemetry {
    /// Of a module with these settings, both of which stay where they are; it decides by this
    /// model, and other settings come from idle.
    pub(crate) fn new(settings: &Settings, inner: &Inner, model: ModelState, idle: End) -> Self {
        Self {
            link: Link::new(),
            packets: Packets::new(),
            about: About { model },
            is_by_serial: false,
            changed: Changed::new(settings, inner),
            idle,
        }
    }

    /// Sends records of a tick, the `tick`-th since the start, if they were asked for.
    pub(crate) fn send(&mut self, module: &Inner, settings: &Settings, tick: u32) {
        let Self { link, packets, .. } = self;
        link.send(module, settings, tick, &NOTES, packets);
    }

    /// Answers what was asked for, and carries out what is.
    pub(crate) fn talk(&mut self, module: &mut Inner, settings: &mut Spare, tick: u32) {
        self.answer();
        if self.link.is_free() && IS_FULL.load(Ordering::Acquire) {
            let [first, value, verdict @ ..] = &INBOX;
            let words = [first, value].map(|word| word.load(Ordering::Relaxed));
            let verdict = Verdict::of(verdict.each_ref().map(|word| word.load(Ordering::Relaxed)));
            // Erased too: no command has the number 0.
            first.store(0, Ordering::Relaxed);
            self.is_by_serial = IS_BY_SERIAL.load(Ordering::Relaxed);
            IS_FULL.store(false, Ordering::Release);
            match (TaggedCommand::from_words(words), verdict) {
                (Ok(request), Verdict::Done(status, values)) => {
                    let answer = firmware::answer(request, tick, (status, values));
                    self.link.reply(answer);
                }
                (Ok(request), Verdict::TakeOver) if Part::Set.is_built() => {
                    self.take_over(module, settings, request, tick);
                }
                (Ok(request), _) => {
                    if let Command::Load(load) = request.command
                        && Part::Deploy.is_built()
                    {
                        self.load(load, module.is_armed(), request, tick);
                    } else {
                        let about = self.about;
                        self.link.carry_out(module, settings, request, about, tick);
                    }
                }
                (Err(unknown), _) => self.link.refuse(unknown, tick),
            }
            self.answer();
        }
        let waits = !self.link.is_free() || IS_FULL.load(Ordering::Relaxed);
        WAITS.store(waits, Ordering::Relaxed);
        IS_BUSY.store(waits || self.link.streams(), Ordering::Relaxed);
    }

    /// Answers whoever has asked.
    fn answer(&mut self) {
        if Part::Serial.is_built() && self.is_by_serial {
            self.link.answer(&mut SerialAnswer);
        } else {
            self.link.answer(&mut self.packets);
        }
    }

    /// Has idle load a scene, which answers then, or says why not.
    fn load(&mut self, load: Load, is_armed: bool, request: TaggedCommand, tick: u32) {
        let may = match firmware::may_load(load, ROOM, is_armed) {
            Ok(()) if !slots::is_paired(load) => Err(CommandStatus::OutOfRange),
            may => may,
        };
        let status = may.err().unwrap_or(CommandStatus::Done);
        let answer = firmware::answer(request, tick, (status, [load.words().cast_signed(), 0]));
        if may.is_err() {
            self.link.reply(answer);
            return;
        }
        ANSWER.set(answer.words());
        for (place, words) in LOAD.iter().zip([load.config, load.model]) {
            place.store(words.into(), Ordering::Relaxed);
        }
        let by = if self.is_by_serial {
            BY_SERIAL
        } else {
            BY_PROBE
        };
        TO_LOAD.store(by, Ordering::Release);
    }

    /// Has the module go on by the settings that idle has prepared.
    #[cold]
    #[inline(never)]
    fn take_over(
        &mut self,
        module: &mut Inner,
        settings: &mut Spare,
        request: TaggedCommand,
        tick: u32,
    ) {
        // The last thing that is asked for: idle resets the board.
        if !self.changed.holds() {
            return;
        }
        let Some(mut next) = self.idle.receive.dequeue() else {
            return;
        };
        let taken = firmware::take_over(module, settings, next);
        if taken.is_ok() {
            core::mem::swap(settings, &mut next);
            self.changed.after(settings);
        }
        // There is room for one.
        let _ = self.idle.send.enqueue(next);
        let answer = firmware::answer(request, tick, firmware::applied(taken));
        self.link.reply(answer);
    }
}

/// The writer of the ring of packets.
struct Packets {
    /// The place of the next.
    next: usize,
    /// For how many there is room at least: the reader's offset is looked at when there is
    /// none, and not for each.
    room: u32,
}

impl Packets {
    const fn new() -> Self {
        Self { next: 0, room: 0 }
    }
}

/// For how many packets there is room from the `next`-th place on.
// Apart, as it is done once for many packets.
#[cold]
#[inline(never)]
fn room_from(next: usize) -> u32 {
    let writer = next * PACKET_BYTES;
    UP.room(writer as u32) / PACKET_BYTES as u32
}

impl PacketSink for Packets {
    #[inline]
    fn put(&mut self, fill: impl FnOnce(&PacketSlot)) -> bool {
        // Within the ring, whatever a flipped bit has made of it.
        let next = self.next % PACKETS_COUNT;
        let mut left = self.room.wrapping_sub(1);
        if left >= PACKETS_COUNT as u32 - 1 {
            let Some(found) = room_from(next).checked_sub(1) else {
                self.room = 0;
                return false;
            };
            left = found;
        }
        let following = (next + 1) % PACKETS_COUNT;
        (self.next, self.room) = (following, left);
        fill(&PACKETS[next]);
        UP.has_written((following * PACKET_BYTES) as u32);
        true
    }
}
