//! The link of a simulated module to whoever runs it, which has room for every packet.

use firmware::{
    About, BoardCode, Config, ConfigBytes, Event, EventRecord, Link, ModelState, Module, Packet,
    Prepared, Tuning, answer, applied, encode, letters, take_over,
};
use whisking::Real;
use wire::{Command, CommandStatus, TaggedCommand};

use super::board::Mock;

pub(super) struct Line {
    link: Link,
    tuning: Tuning<ConfigBytes>,
    ticks: u32,
    /// Since it was last taken.
    pub(super) sent: Vec<Packet>,
    model: ModelState,
    classes: Vec<String>,
}

impl Line {
    pub(super) fn new<R: Real>(
        config: &Config<R>,
        model: ModelState,
        classes: Vec<String>,
    ) -> Self {
        // A simulation has room for any scene; without the bytes only `get` says less.
        let bytes = encode(config, BoardCode::Simulation).unwrap_or_default();
        Self {
            link: Link::new(),
            tuning: Tuning::new(BoardCode::Simulation, bytes),
            ticks: 0,
            sent: Vec::new(),
            model,
            classes,
        }
    }

    pub(super) fn restart(&mut self) {
        self.link = Link::new();
        self.tuning.restart();
        self.ticks = 0;
        self.sent.clear();
    }

    pub(super) fn note(&mut self, event: &Event) {
        self.link.note(event);
        if self.link.streams() {
            let (sequence, event) = (self.ticks.wrapping_add(1), *event);
            self.sent
                .push(Packet::Event(EventRecord { sequence, event }));
        }
    }

    pub(super) fn tick_ends<R: Real>(&mut self, module: &Module<R, Mock>, config: &Config<R>) {
        self.ticks = self.ticks.wrapping_add(1);
        let sent = &mut self.sent;
        self.link.send(module, config, self.ticks, &mut |record| {
            sent.push(Packet::Record(record));
            true
        });
    }

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
        let done = done.or_else(|| self.class_letters(request.command));
        let answer = if let Some(done) = done {
            answer(request, self.ticks, done)
        } else {
            let about = About { model: self.model };
            let link = &mut self.link;
            link.carry_out(module, config, request, about, self.ticks)
        };
        self.sent.push(Packet::Answer(answer));
    }

    fn class_letters(&self, command: Command) -> Option<(CommandStatus, [i32; 2])> {
        let Command::Class(class, from) = command else {
            return None;
        };
        Some(match self.classes.get(usize::from(class)) {
            Some(name) => (CommandStatus::Done, letters(name, from)),
            None => (CommandStatus::OutOfRange, [0; 2]),
        })
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
}
