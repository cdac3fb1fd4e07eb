//! Requests to another board of a head, by way of the board that a PC is connected to.
//!
//! The board that asks says a request again until it is answered. The one that is asked carries it
//! out once: where the same comes again, it answers again. Letters have the bus behind all else
//! ([`can::Letter`]), so that records of each tick do not fit on it: those of a hundredth of a second
//! go ([`RELAYED_HZ`]).

use can::{Assembly, Frame, LETTER_BYTES, Letter, LetterKind, PARTS, Part};
use wire::{
    Answer, COMMAND_MOST, Command, CommandStatus, ForNode, Load, TaggedCommand, UnknownCommand,
};

use crate::packet::PACKET_BYTES;
use crate::{BusConfig, Packet};

/// Records of a whisker that go to another board in a second, at most.
pub const RELAYED_HZ: u32 = 100;

/// A request is said again each tenth of a second until it is answered, but for one that erases
/// flash: the board that does so hears nothing meanwhile.
const TENTH: u32 = 10;

/// For how many tenths of a second an answer is waited for; and where flash is erased for it.
const PATIENCE: u32 = 5;
const LONG_PATIENCE: u32 = 200;

const _: () = assert!(LETTER_BYTES == PACKET_BYTES);
const _: () = assert!(LETTER_BYTES >= 4 + 2 + COMMAND_MOST);

/// Frames of a letter.
pub type Frames = [Frame; PARTS];

/// What has come for this board.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Heard {
    /// The answer to what it has asked another board for, or that there is none.
    Answered(Answer),
    /// What the board has sent that it asked last: a packet's bytes.
    Packet([u8; LETTER_BYTES]),
    /// Nothing; these are to be said.
    Say(Frames),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Asking {
    request: ForNode,
    made: u32,
    said: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Asked {
    from: u8,
    request: ForNode,
    made: u32,
    is_taken: bool,
    answer: Option<Answer>,
}

/// A board's requests to others, and theirs to it.
#[derive(Debug)]
pub struct Relay {
    number: u8,
    nodes: u8,
    tick_hz: u32,
    letters: u8,
    asking: Option<Asking>,
    /// The board that it has asked for records, whose packets it reads.
    reads: Option<u8>,
    asked: Option<Asked>,
    /// Of that board, and of another one that is asked meanwhile.
    packets: [Assembly; 2],
    requests: Assembly,
}

impl Relay {
    /// Of board `number` of a head.
    pub const fn new(number: u8, bus: BusConfig, tick_hz: u32) -> Self {
        Self {
            number,
            nodes: bus.nodes,
            tick_hz,
            letters: 0,
            asking: None,
            reads: None,
            asked: None,
            packets: [Assembly::new(); 2],
            requests: Assembly::new(),
        }
    }

    /// Its number.
    pub const fn number(&self) -> u8 {
        self.number
    }

    /// Whether the head has a board of that number.
    pub const fn has(&self, node: u8) -> bool {
        node < self.nodes
    }

    /// Of how many ticks one has its records sent to another board.
    pub const fn every(tick_hz: u32) -> u32 {
        let every = tick_hz / RELAYED_HZ;
        if every > 1 { every } else { 1 }
    }

    /// Asks another board, in tick `now`; `None`: the head has no such board.
    pub fn ask(&mut self, request: ForNode, now: u32) -> Option<Frames> {
        if !self.has(request.node) || request.node == self.number {
            return None;
        }
        self.asking = Some(Asking {
            request,
            made: now,
            said: now,
        });
        if request.number() == Command::Stream(true).number() {
            self.reads = Some(request.node);
        }
        self.say_request()
    }

    /// After so many ticks.
    pub fn pass(&mut self, now: u32) -> Option<Heard> {
        let Asking {
            request,
            made,
            said,
        } = self.asking?;
        let is_long = request.number() == Command::Load(Load::default()).number();
        let patience = if is_long { LONG_PATIENCE } else { PATIENCE };
        let tenth = self.tick_hz / TENTH;
        if now.wrapping_sub(made) >= patience * tenth {
            self.asking = None;
            return Some(Heard::Answered(Self::no_board(&request, now)));
        }
        if is_long || now.wrapping_sub(said) < tenth {
            return None;
        }
        if let Some(asking) = &mut self.asking {
            asking.said = now;
        }
        self.say_request().map(Heard::Say)
    }

    /// A frame has come.
    pub fn hear(&mut self, frame: &Frame) -> Option<Heard> {
        let part = Part::of(frame).filter(|part| part.to == self.number)?;
        match part.kind {
            LetterKind::Packet => {
                let asking = self.asking.map(|asking| asking.request.node);
                let mut whose = [self.reads, asking].into_iter();
                let place = whose.position(|node| node == Some(part.from))?;
                let letter = self.packets.get_mut(place)?.push(&part)?;
                self.hear_packet(letter.bytes)
            }
            LetterKind::Request => {
                let letter = self.requests.push(&part)?;
                self.hear_request(&letter).map(Heard::Say)
            }
        }
    }

    fn hear_packet(&mut self, packet: [u8; LETTER_BYTES]) -> Option<Heard> {
        let Some(answer) = Packet::answer(&packet) else {
            return Some(Heard::Packet(packet));
        };
        // That to a request which was said twice comes twice.
        let asking = self.asking.filter(|asking| {
            let request = asking.request;
            (request.tag, request.number()) == (answer.tag, answer.command)
        });
        asking?;
        self.asking = None;
        Some(Heard::Answered(answer))
    }

    fn hear_request(&mut self, letter: &Letter) -> Option<Frames> {
        let (made, rest) = letter.bytes.split_first_chunk()?;
        let (tag, rest) = rest.split_first_chunk()?;
        let (made, from) = (u32::from_le_bytes(*made), letter.node);
        let request = ForNode {
            node: self.number,
            tag: u16::from_le_bytes(*tag),
            command: *rest.first_chunk()?,
        };
        let last = self
            .asked
            .filter(|asked| (asked.from, asked.made, asked.request) == (from, made, request));
        if let Some(last) = last {
            let answer = last.answer?;
            return Some(self.packet(from, &Packet::Answer(answer)));
        }
        // One after the other: this comes again.
        if self
            .asked
            .is_some_and(|asked| asked.is_taken && asked.answer.is_none())
        {
            return None;
        }
        self.asked = Some(Asked {
            from,
            request,
            made,
            is_taken: false,
            answer: None,
        });
        None
    }

    /// What another board asks for, once, and which.
    pub fn take_request(&mut self) -> Option<(u8, Result<TaggedCommand, UnknownCommand>)> {
        let asked = self.asked.as_mut().filter(|asked| !asked.is_taken)?;
        asked.is_taken = true;
        Some((asked.from, asked.request.here()))
    }

    /// That a head has no such board, or that it does not answer.
    pub const fn no_board(request: &ForNode, now: u32) -> Answer {
        Answer {
            sequence: now,
            tag: request.tag,
            command: request.number(),
            status: CommandStatus::NoBoard,
            values: [0; 2],
        }
    }

    /// Answers what another board has asked for; `None`: none has.
    pub fn answer(&mut self, answer: &Answer) -> Option<Frames> {
        let asked = self.asked.as_mut();
        let asked = asked.filter(|asked| asked.is_taken && asked.request.tag == answer.tag)?;
        asked.answer = Some(*answer);
        let from = asked.from;
        Some(self.packet(from, &Packet::Answer(*answer)))
    }

    /// Sends another board what a PC would get.
    pub fn packet(&mut self, to: u8, packet: &Packet) -> Frames {
        self.letter(LetterKind::Packet, to, packet.bytes())
    }

    fn say_request(&mut self) -> Option<Frames> {
        let asking = self.asking?;
        let mut bytes = [0; LETTER_BYTES];
        let ForNode { node, tag, command } = asking.request;
        let made = asking.made.to_le_bytes().into_iter();
        let words = made.chain(tag.to_le_bytes()).chain(command);
        for (place, byte) in bytes.iter_mut().zip(words) {
            *place = byte;
        }
        Some(self.letter(LetterKind::Request, node, bytes))
    }

    fn letter(&mut self, kind: LetterKind, node: u8, bytes: [u8; LETTER_BYTES]) -> Frames {
        self.letters = self.letters.wrapping_add(1);
        Letter { kind, node, bytes }.frames(self.number, self.letters)
    }
}

#[cfg(test)]
mod tests {
    use can::Frame;
    use proptest::prelude::*;
    use wire::{
        Answer, COMMAND_MOST, Command, CommandStatus, ForNode, Load, TaggedCommand, WhiskerId,
    };

    use super::{Heard, Relay};
    use crate::{BusConfig, Packet};

    const TICK_HZ: u32 = 2_000;

    fn relay(number: u8) -> Relay {
        let bus = BusConfig {
            nodes: 3,
            kbit_s: 1_000,
        };
        Relay::new(number, bus, TICK_HZ)
    }

    fn request(tag: u16) -> TaggedCommand {
        let command = match tag % 4 {
            0 => Command::Hello,
            1 => {
                let [side, number] = [255; 2];
                Command::Gain(WhiskerId { side, number }, i32::MIN)
            }
            2 => Command::Word(255, u32::MAX),
            _ => Command::Stage(3, u32::MAX),
        };
        TaggedCommand { tag, command }
    }

    fn of(node: u8, request: TaggedCommand) -> ForNode {
        let mut command = [0; COMMAND_MOST];
        postcard::to_slice(&request.command, &mut command).unwrap();
        let tag = request.tag;
        ForNode { node, tag, command }
    }

    fn answer(request: TaggedCommand, count: u32) -> Answer {
        crate::answer(request, count, (CommandStatus::Done, [i32::MIN, -1]))
    }

    proptest! {
        /// Whatever is lost on the way, a request is carried out once at most, and its answer is its
        /// own or that there is none.
        #[test]
        fn a_request_is_carried_out_once_and_answered(
            tags in prop::collection::vec(any::<u16>(), 1..6),
            lost in prop::collection::vec(any::<bool>(), 0..400),
            share in 0..4_u8,
            late in 0..300_u32,
        ) {
            let mut lost = lost.into_iter().cycle().zip(0_u8..).map(|(lost, n)| lost && n % 4 < share);
            let mut is_lost = || lost.next().unwrap_or(false);
            let (mut here, mut there) = (relay(0), relay(2));
            let (mut now, mut done) = (0, 0);
            for tag in tags {
                let request = request(tag);
                let mut down: Vec<Frame> = here.ask(of(2, request), now).unwrap().to_vec();
                let mut due: Option<(u32, u8)> = None;
                let mut carried_out = 0;
                let answered = loop {
                    now += 1;
                    let mut up = Vec::new();
                    for frame in down.drain(..).filter(|_| !is_lost()) {
                        if let Some(Heard::Say(frames)) = there.hear(&frame) {
                            up.extend(frames);
                        }
                    }
                    if let Some((from, asked)) = there.take_request() {
                        prop_assert_eq!(asked, Ok(request));
                        carried_out += 1;
                        due = Some((now + late, from));
                    }
                    if let Some((_, from)) = due.take_if(|(at, _)| *at <= now) {
                        done += 1;
                        prop_assert_eq!(from, 0);
                        up.extend(there.answer(&answer(request, done)).unwrap());
                    }
                    let mut heard: Vec<Heard> = up.iter().filter(|_| !is_lost())
                        .filter_map(|frame| here.hear(frame)).collect();
                    heard.extend(here.pass(now));
                    let answers: Vec<Answer> = heard.iter().filter_map(|heard| match heard {
                        Heard::Answered(answer) => Some(*answer),
                        _ => None,
                    }).collect();
                    for heard in heard {
                        if let Heard::Say(frames) = heard {
                            down.extend(frames);
                        }
                    }
                    prop_assert!(answers.len() <= 1);
                    if let Some(answer) = answers.first() {
                        break *answer;
                    }
                };
                prop_assert!(carried_out <= 1);
                let is_answered = answered == answer(request, done);
                prop_assert!(is_answered || answered.status == CommandStatus::NoBoard);
                prop_assert!(is_answered || share > 0);
                // As a board does, which takes no other before it has answered one.
                if due.is_some() {
                    done += 1;
                    there.answer(&answer(request, done));
                }
            }
        }
    }

    #[test]
    fn there_is_no_board_beyond_the_head_and_one_that_is_silent_is_none() {
        let mut here = relay(0);
        assert_eq!(here.ask(of(3, request(0)), 0), None);
        assert_eq!(here.ask(of(0, request(0)), 0), None);
        let load = TaggedCommand {
            tag: 7,
            command: Command::Load(Load::default()),
        };
        for (request, patience, says) in [(request(0), 1_000, 4), (load, 40_000, 0)] {
            assert!(here.ask(of(1, request), 5).is_some());
            let mut said = 0;
            let gave_up = (5..100_000).find(|now| match here.pass(*now) {
                Some(Heard::Say(_)) => {
                    said += 1;
                    false
                }
                Some(Heard::Answered(answer)) => {
                    assert_eq!(answer.status, CommandStatus::NoBoard);
                    true
                }
                _ => false,
            });
            assert_eq!((gave_up, said), (Some(patience + 5), says));
            assert_eq!(here.pass(u32::MAX), None);
        }
    }

    #[test]
    fn records_of_one_board_come_while_another_is_asked() {
        let mut here = relay(0);
        let stream = TaggedCommand {
            tag: 1,
            command: Command::Stream(true),
        };
        here.ask(of(2, stream), 0).unwrap();
        let begun = relay(2).packet(0, &Packet::Answer(answer(stream, 1)));
        let heard = begun.iter().find_map(|frame| here.hear(frame));
        assert_eq!(heard, Some(Heard::Answered(answer(stream, 1))));
        here.ask(of(1, request(0)), 0).unwrap();
        // Their parts come by turns; those of a board that was not asked are dropped.
        let record = Packet::Record(wire::TickRecord::default());
        let records = relay(2).packet(0, &record);
        let answers = relay(1).packet(0, &Packet::Answer(answer(request(0), 2)));
        let others = relay(3).packet(0, &record);
        let frames = (0..3).flat_map(|n| [records[n], answers[n], others[n]]);
        let heard: Vec<Heard> = frames.filter_map(|frame| here.hear(&frame)).collect();
        let answered = Heard::Answered(answer(request(0), 2));
        assert_eq!(heard, [Heard::Packet(record.bytes()), answered]);
    }
}
