//! Idle's end of what is asked about configurations: their words, and another one for the module
//! that runs. What takes long is done here, and the tick takes over what is ready.

use firmware::{ConfigError, Part, Prepared, Tuning, refusal_code};
use heapless::spsc::{Consumer, Producer};
use static_cell::StaticCell;
use wire::{Command, CommandStatus};

use crate::board::scene::Deployed;
use crate::board::types::{Number, Settings};
use crate::board::{integrity, log, pace, perception};
use crate::here::FACTS;

/// Settings on their way from idle to the tick, which gives back those that they replace, or
/// that it refuses: there is one place for settings more than the tick needs.
pub(crate) type Spare = &'static mut Settings;

type Way = heapless::spsc::Queue<Spare, 2>;

/// There and back.
pub(crate) struct Queue([Way; 2]);

impl Queue {
    pub(crate) const fn new() -> Self {
        Self([Way::new(), Way::new()])
    }

    pub(crate) fn split(&'static mut self) -> (Ways, Ways) {
        let Self([there, back]) = self;
        let (send, taken) = there.split();
        let (give, receive) = back.split();
        (
            Ways { send, receive },
            Ways {
                send: give,
                receive: taken,
            },
        )
    }
}

pub(crate) struct Ways {
    pub(super) send: Producer<'static, Spare>,
    pub(super) receive: Consumer<'static, Spare>,
}

/// How often the log says that settings differ, s.
const AGAIN_S: u32 = 60;

static TUNING: StaticCell<Tuning<&[u8]>> = StaticCell::new();
static SPARE: StaticCell<Settings> = StaticCell::new();

/// Idle's end.
pub(crate) struct Configs {
    tuning: &'static mut Tuning<&'static [u8]>,
    /// Settings that the tick does not read, while it has not got them.
    spare: Option<Spare>,
    tick: Ways,
    /// The contact that samples count from, unless a configuration says it.
    gate: Option<Number>,
    /// Why there is no scene, if there is none.
    none: Option<ConfigError>,
    /// Bytes of what is on its way.
    under_way: Option<u32>,
    /// How often settings were changed when this last looked, and when the log said so.
    changes: u32,
    logged: u32,
}

impl Configs {
    #[inline(never)]
    pub(crate) fn start(
        deployed: Result<Deployed, ConfigError>,
        gate: Option<Number>,
        tick: Ways,
    ) -> Option<Self> {
        let bytes = deployed.map_or(&[][..], |deployed| deployed.bytes);
        let tuning = TUNING.try_init_with(|| Tuning::new(FACTS.code, bytes))?;
        let spare = if Part::Set.is_built() {
            Some(SPARE.try_init_with(Settings::still)?)
        } else {
            None
        };
        Some(Self {
            tuning,
            spare,
            tick,
            gate,
            none: deployed.err(),
            under_way: None,
            changes: 0,
            logged: 0,
        })
    }

    /// Whether the tick has taken over what was on its way.
    fn settle(&mut self) -> bool {
        let changes = integrity::changes();
        if changes == self.changes {
            return false;
        }
        self.changes = changes;
        if let Some(length) = self.under_way.take() {
            self.tuning.has_taken(length);
        }
        true
    }

    /// What idle has found out about a request; `None`: the tick carries it out.
    pub(crate) fn prepare(&mut self, command: Command) -> Option<Prepared> {
        self.settle();
        if let (Command::Scene, Some(error)) = (command, self.none) {
            let [kind, _] = refusal_code(error);
            return Some(Prepared::Done(CommandStatus::Done, [0, -kind]));
        }
        if let Some((status, values)) = self.tuning.read::<Number>(command) {
            return Some(Prepared::Done(status, values));
        }
        if !Part::Set.is_built() {
            return None;
        }
        let spare = match self.spare.take() {
            None => self.tick.receive.dequeue(),
            spare => spare,
        };
        // The tick gives it back before it takes another request.
        let spare = spare?;
        let prepared = self.tuning.prepare(command, spare);
        if let (Some(Prepared::Next), Command::Apply(length)) = (prepared, command) {
            perception::adapt(spare, self.gate);
            self.under_way = Some(length);
            // There is room for one.
            self.spare = self.tick.send.enqueue(spare).err();
        } else {
            self.spare = Some(spare);
        }
        prepared
    }

    /// After every change, and once a minute while settings differ from the scene's.
    pub(crate) fn log_changes(&mut self, now: u32) {
        if !Part::Set.is_built() {
            return;
        }
        let has_changed = self.settle();
        let again = AGAIN_S.wrapping_mul(pace::tick_hz());
        let is_due = self.changes != 0 && now.wrapping_sub(self.logged) >= again;
        if has_changed || is_due {
            self.logged = now;
            let differs = self.tuning.has_changed();
            if differs || has_changed {
                log::tuned(differs);
            }
        }
    }
}
