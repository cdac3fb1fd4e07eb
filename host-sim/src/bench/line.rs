//! The link of a simulated module to whoever runs it, which has room for every packet.

use firmware::{
    About, BoardCode, Config, ConfigBytes, Event, Link, ModelState, Module, Notes, PacketSink,
    PacketSlot, Prepared, Tuning, answer, applied, encode, take_over,
};
use whisking::Real;
use wire::{Command, CommandStatus, Packet, TaggedCommand};

use super::mock::Mock;

/// A module's end of the link.
pub(super) struct Line {
    link: Link,
    notes: Notes,
    tuning: Tuning<ConfigBytes>,
    ticks: u32,
    sent: Sent,
    model: ModelState,
}

/// Packets on their way.
#[derive(Default)]
struct Sent(Vec<Packet>);

impl PacketSink for Sent {
    fn put(&mut self, fill: impl FnOnce(&PacketSlot)) -> bool {
        let slot = PacketSlot::new();
        fill(&slot);
        self.0.push(Packet::from_words(slot.get()));
        true
    }
}

impl Line {
    /// Before the first tick of a module, which decides by this model.
    pub(super) fn new<R: Real>(config: &Config<R>, model: ModelState) -> Self {
        // A simulation has room for any scene; without the bytes only `get` says less.
        let bytes = encode(config, BoardCode::Simulation).unwrap_or_default();
        Self {
            link: Link::new(),
            notes: Notes::new(),
            tuning: Tuning::new(BoardCode::Simulation, bytes),
            ticks: 0,
            sent: Sent::default(),
            model,
        }
    }

    /// Begins again.
    pub(super) fn restart(&mut self) {
        self.link = Link::new();
        self.notes = Notes::new();
        self.tuning.restart();
        self.ticks = 0;
        self.sent.0.clear();
    }

    /// Notes an event of a tick.
    pub(super) fn note(&self, event: &Event) {
        self.notes.note(event);
    }

    /// A tick has ended.
    pub(super) fn tick_ends<R: Real>(&mut self, module: &Module<R, Mock>, config: &Config<R>) {
        self.ticks = self.ticks.wrapping_add(1);
        let (notes, sent) = (&self.notes, &mut self.sent);
        self.link.send(module, config, self.ticks, notes, sent);
        self.link.answer(sent);
    }

    /// Carries out a request.
    pub(super) fn carry_out<R: Real>(
        &mut self,
        module: &mut Module<R, Mock>,
        config: &mut Config<R>,
        request: TaggedCommand,
    ) {
        let done = match self.tuning.read::<R>(request.command) {
            None => self.change(module, config, request.command),
            done => done,
        };
        let Some(done) = done else {
            let about = About { model: self.model };
            let link = &mut self.link;
            link.carry_out(module, config, request, about, self.ticks);
            return;
        };
        self.link.reply(answer(request, self.ticks, done));
    }

    /// Has the module go on by another configuration, if the request is about one.
    fn change<R: Real>(
        &mut self,
        module: &mut Module<R, Mock>,
        config: &mut Config<R>,
        command: Command,
    ) -> Option<(CommandStatus, [i32; 2])> {
        let mut next = Config::still();
        match self.tuning.prepare(command, &mut next)? {
            Prepared::Done(status, values) => Some((status, values)),
            Prepared::Next => {
                let taken = take_over(module, config, &next);
                if let (Ok(()), Command::Apply(length)) = (taken, command) {
                    *config = next;
                    self.tuning.has_taken(length);
                }
                Some(applied(taken))
            }
        }
    }

    /// What was sent since the last call.
    pub(super) fn take(&mut self) -> Vec<Packet> {
        std::mem::take(&mut self.sent.0)
    }
}
