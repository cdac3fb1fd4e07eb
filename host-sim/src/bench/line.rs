//! The link of a simulated module to whoever runs it, which has room for every packet.

use firmware::{
    About, Clock, Config, Event, Link, ModelState, Module, Motion, MotorControl, Notes, PacketSink,
    PacketSlot, Perception, Tunable, Tuning, WordSource,
};
use scene::Scene;
use whisking::{Optional, Real, filter};
use wire::{Packet, TaggedCommand};

/// A module's end of the link.
pub(super) struct Line {
    link: Link,
    notes: Notes,
    tuning: Tuning,
    ticks: u32,
    sent: Sent,
    name: String,
    tick_hz: u32,
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
    /// Before the first tick of `scene`, whose module decides by this model.
    pub(super) fn new(scene: &Scene, model: ModelState) -> Self {
        Self {
            link: Link::new(),
            notes: Notes::new(),
            tuning: Tuning::new(),
            ticks: 0,
            sent: Sent::default(),
            name: scene.name.clone(),
            tick_hz: scene.tick_hz,
            model,
        }
    }

    /// Begins anew.
    pub(super) fn restart(&mut self) {
        self.link = Link::new();
        self.notes = Notes::new();
        self.tuning = Tuning::new();
        self.ticks = 0;
        self.sent.0.clear();
    }

    /// Notes an event of a tick.
    pub(super) fn note(&self, event: &Event) {
        self.notes.note(event);
    }

    /// A tick has ended.
    pub(super) fn tick_ends<R, F, M, P, C, MC, PC, H, const S: usize, const N: usize>(
        &mut self,
        module: &Module<R, F, M, P, C, S, N>,
        config: &Config<MC, PC, H>,
    ) where
        R: Real,
        F: WordSource,
        M: Motion<R, MC, S, N>,
        C: Clock,
        H: Optional<filter::Config<R>>,
    {
        self.ticks = self.ticks.wrapping_add(1);
        let (notes, sent) = (&self.notes, &mut self.sent);
        self.link.send(module, config, self.ticks, notes, sent);
        self.link.answer(sent);
    }

    /// Carries out a request.
    pub(super) fn carry_out<R, F, M, P, C, MC, PC, H, const S: usize, const N: usize>(
        &mut self,
        module: &mut Module<R, F, M, P, C, S, N>,
        config: &mut Config<MC, PC, H>,
        request: TaggedCommand,
    ) where
        R: Real,
        F: WordSource,
        M: Motion<R, MC, S, N> + MotorControl<R>,
        P: Perception<R, PC, S, N>,
        C: Clock,
        Config<MC, PC, H>: Tunable<R>,
    {
        let tuned = self.tuning.carry_out(module, config, request, self.ticks);
        if let Some(answer) = tuned {
            self.link.reply(answer);
            return;
        }
        let about = About {
            name: &self.name,
            tick_hz: self.tick_hz,
            model: self.model,
        };
        let link = &mut self.link;
        link.carry_out(module, config, request, about, self.ticks);
    }

    /// What was sent since the last call.
    pub(super) fn take(&mut self) -> Vec<Packet> {
        std::mem::take(&mut self.sent.0)
    }
}
