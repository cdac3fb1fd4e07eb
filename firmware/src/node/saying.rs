//! What a board of a head says to the others after each tick.

use can::{Contact, Frame, Message};
use tactile::Decision;
use whisking::{MAX_SIDES, Number};

use super::{Due, Node, STOPS, Times};
use crate::{Config, Hardware, Module};

/// By how much contact π rises before that is said at once, Q15: 1/64.
const RISE: u16 = 1 << 9;

impl Node {
    /// After a tick, in which this board may have `decided`: what it says to the others.
    pub fn after<R: Number, H: Hardware>(
        &mut self,
        (module, config): (&Module<R, H>, &Config<R>),
        decided: Option<Decision>,
        say: &mut impl FnMut(Frame),
    ) {
        let tick = self.tick;
        self.tick = tick.wrapping_add(1);
        if self.is_twin() {
            return;
        }
        let stamp = tick as u8;
        let number = self.number;
        let mut say = |message: Message| say(message.frame(number, stamp));
        let Times { psi, contact, .. } = self.times;
        let of_turn = |count: u32| count.checked_rem(contact.into());
        let is_turn = of_turn(tick) == of_turn(number.into());
        if self.stops > STOPS || self.stops > 0 && is_turn {
            self.stops = self.stops.min(STOPS);
            say(Message::Stop);
        }
        let since_stop = self.since_stop;
        self.since_stop = since_stop.saturating_add(1);
        // A stop waits for the bus no longer than the delay. Whoever hears it and the arm in one
        // tick could not know which was made first.
        if self.arms && since_stop > self.times.delay {
            self.arms = false;
            say(Message::Arm);
            let at = tick.wrapping_add(self.times.delay.into());
            let frame = Message::Arm.frame(number, stamp);
            let due = Due { at, frame };
            // Where there is no room it is the others alone that are armed, and this one stays off.
            let _ = self.due.push(due);
        }
        if is_turn && self.is_joined && self.members.leader_of_time(true) == Some(number) {
            let (number, last_us) = self.clock.next();
            say(Message::Time { number, last_us });
        }
        if tick.is_multiple_of(psi.into())
            && let (Some(motion), Some(config)) = (module.motion(), &config.motion)
        {
            let all = config.whisking.oscillators.psi(&motion.state().oscillators);
            self.replica.keep(tick, &all);
            for side in 0..MAX_SIDES {
                if let Some(psi) = self.replica.at(tick, side).filter(|_| self.leads(side)) {
                    say(Message::Psi {
                        side: side as u8,
                        psi,
                    });
                }
            }
        }
        self.say_contact(is_turn, module, &mut say);
        let together = config.classifier.as_ref().map(|config| config.deciding);
        if let (Some(perception), Some(tactile::Deciding::Together)) =
            (module.perception(), together)
        {
            if let Some(decision) = decided.or(self.decision.take()) {
                self.deciding
                    .decided(tick.wrapping_add(self.times.delay.into()));
                say(Message::Decision {
                    class: decision.class().map(|class| class as u8),
                    posterior: (decision.posterior().q32() >> 17) as u16,
                    samples: decision.samples(),
                });
            } else if self.members.leader_of_time(self.is_joined) != Some(number) {
                self.deciding.say(perception.classifier(), &mut say);
            }
        }
    }

    fn say_contact<R: Number, H: Hardware>(
        &mut self,
        is_turn: bool,
        module: &Module<R, H>,
        say: &mut impl FnMut(Message),
    ) {
        self.since_said = self.since_said.saturating_add(1);
        // It listens first, so that of two with one number it is the second that is silent.
        if !self.is_joined && self.alone <= self.times.contact {
            return;
        }
        let pi = module
            .contact()
            .map(|pi| (pi.to_q24() >> 9).clamp(0, u16::MAX.into()) as u16);
        let mut rises = pi.iter().zip(self.said.pi);
        let has_risen = rises.any(|(now, said)| *now >= said.saturating_add(RISE));
        if is_turn || has_risen && self.since_said >= self.times.rise {
            self.since_said = 0;
            self.said = Contact {
                pi,
                is_joined: self.is_joined,
                is_armed: module.is_armed(),
                // After its tick.
                round: Contact::round(self.tick.wrapping_sub(1)),
            };
            say(Message::Contact(self.said));
        }
    }
}
