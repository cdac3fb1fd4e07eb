//! Looks at all whiskers of a head in turn, by way of the board that is talked with.

use host_sim::Error;
use host_sim::array::{Array, Stand};
use host_sim::decisions::UNKNOWN;
use host_sim::loaded::Loaded;
use wire::{Answer, Command, CommandStatus, Looked, WhiskerId, degrees, unit};

use crate::configuration::Running;
use crate::conversation::{Conversation, answer_of};
use crate::source::{Incoming, SourceChoice};

/// After how long without an answer the next one is looked at, s; a board says by itself that
/// another one is silent.
const PATIENCE_S: f64 = 1.0;
/// After how long a board that was silent is asked again, s.
const SILENCE_S: f64 = 2.0;

/// A whisker of a head, as somebody sees it who looks at that from above.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Hair {
    pub(crate) stand: Stand,
    /// In how many columns the whiskers of its side stand.
    pub(crate) columns: usize,
    pub(crate) angle_deg: f64,
    pub(crate) contact: f64,
    /// What it has decided within the last second; empty: nothing.
    pub(crate) said: String,
}

#[derive(Debug)]
pub(crate) struct Looking {
    array: Array,
    looked: Vec<Option<Looked>>,
    /// When it was silent last, s.
    silent_s: Vec<Option<f64>>,
    /// The tag of the request, when it was sent, s, and of which whisker it is.
    asked: Option<(u16, f64, usize)>,
    next: usize,
}

impl Looking {
    /// None where the module is of no head.
    pub(crate) fn of(
        module: &mut Conversation,
        choice: &SourceChoice,
    ) -> Result<Option<Self>, Error> {
        let array = match choice.scene() {
            Some(path) => {
                let scene = Loaded::new(path)?.scene;
                scene.head.nodes.map(|_| Array::new(&scene))
            }
            None if module.is_of_head()? => {
                let head = Running::ask(module)?.head;
                let boards = head.bus.map(|bus| usize::from(bus.nodes));
                let whiskers = [head.sides, head.whiskers_per_side].map(usize::from);
                boards.map(|boards| Array::of(whiskers, 1, Some(boards)))
            }
            None => None,
        };
        Ok(array.map(Self::at))
    }

    fn at(array: Array) -> Self {
        let whiskers = array.stands().len();
        Self {
            array,
            looked: vec![None; whiskers],
            silent_s: vec![None; whiskers],
            asked: None,
            next: 0,
        }
    }

    /// Asks for the next whisker once the one before is known; does not wait.
    pub(crate) fn ask(&mut self, module: &mut Conversation) -> Result<(), Error> {
        let now_s = module.now_s();
        if self
            .asked
            .is_some_and(|(_, at_s, _)| now_s - at_s < PATIENCE_S)
        {
            return Ok(());
        }
        let whiskers = self.looked.len();
        let is_due = |n: &usize| self.silent_s[*n].is_none_or(|at_s| now_s - at_s > SILENCE_S);
        let mut all = (0..whiskers).map(|n| (self.next + n) % whiskers);
        let Some(hair) = all.find(is_due) else {
            return Ok(());
        };
        let stand = self.array.stands()[hair];
        let each = whiskers / self.array.sides().max(1);
        let whisker = WhiskerId {
            side: stand.side as u8,
            number: (hair % each) as u8,
        };
        let board = stand.board.unwrap_or(0) as u8;
        let tag = module.send_to(Some(board), Command::Look(whisker))?;
        self.next = (hair + 1) % whiskers;
        self.asked = Some((tag, now_s, hair));
        Ok(())
    }

    /// Takes the answer that it waits for from among what has come; `classes` are the module's.
    pub(crate) fn take(&mut self, incoming: &mut Incoming, classes: &[String], now_s: f64) {
        if let Some((tag, _, hair)) = self.asked
            && let Some(answer) = answer_of(incoming, tag)
        {
            self.asked = None;
            self.answered(hair, &answer, classes, now_s);
        }
    }

    fn answered(&mut self, hair: usize, answer: &Answer, classes: &[String], now_s: f64) {
        if answer.status != CommandStatus::Done {
            self.silent_s[hair] = Some(now_s);
            return;
        }
        let looked = Looked::of(answer.values);
        self.silent_s[hair] = None;
        let before = self.looked[hair].replace(looked);
        if before.is_some_and(|before| before.decisions != looked.decisions) {
            let named = looked.class.map(usize::from);
            let named = named.and_then(|class| classes.get(class).map(String::as_str));
            let said = named.unwrap_or(UNKNOWN);
            self.array.say(hair, now_s, said.to_owned());
        }
    }

    /// What was seen of each, left side first; empty until all were looked at.
    pub(crate) fn hairs(&self, now_s: f64) -> Vec<Hair> {
        let is_known = |n: usize| self.looked[n].is_some() || self.silent_s[n].is_some();
        if !(0..self.looked.len()).all(is_known) {
            return Vec::new();
        }
        let stands = self.array.stands().iter().enumerate();
        let hair = |(n, stand): (usize, &Stand)| {
            let looked = self.looked[n].unwrap_or_default();
            let said = match self.silent_s[n] {
                Some(_) => "silent",
                None => self.array.said(n, now_s),
            };
            Hair {
                stand: *stand,
                columns: self.array.columns(),
                angle_deg: degrees(looked.measured).into(),
                contact: unit(looked.contact).into(),
                said: said.to_owned(),
            }
        };
        stands.map(hair).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::rc::Rc;

    use host_sim::array::Array;
    use wire::{Command, CommandStatus, Flags, Looked, WhiskerId};

    use super::{Hair, Looking};
    use crate::conversation::Conversation;
    use crate::source::{Scripted, chosen};

    /// Of a board on a port no scene is known: it says by which it runs.
    #[test]
    fn a_board_says_itself_which_head_it_is_of() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("head.toml");
        let cia = include_str!("../../../scenes/cia.toml");
        let [one, each] = ["whiskers_per_side = 1", "whiskers_per_side = 3\nnodes = 6"];
        let port = chosen(&["--port", "nowhere"]);
        std::fs::write(&path, cia.replace(one, each)).unwrap();
        let mut module = chosen(&["--sim", path.to_str().unwrap()]).module().unwrap();
        let looking = Looking::of(&mut module, &port).unwrap().unwrap();
        let stands = looking.array.stands();
        let last = stands.last().unwrap();
        assert_eq!((stands.len(), last.side, last.board), (6, 1, Some(5)));
        let answering = |_| Some((CommandStatus::NoBoard, [0; 2]));
        let mut alone = Conversation::new(Box::new(Scripted::new(answering)));
        assert!(Looking::of(&mut alone, &port).unwrap().is_none());
    }

    #[test]
    fn whiskers_are_looked_at_in_turn_and_say_what_they_decide() {
        let count = Rc::new(Cell::new(0_u8));
        let decisions = count.clone();
        // The second board of the left does not answer.
        let none = Some((CommandStatus::NoBoard, [0; 2]));
        let answering = move |command| match command {
            Command::Look(WhiskerId { side: 0, number: 1 }) => none,
            Command::Look(WhiskerId { side, number }) => {
                let looked = Looked {
                    measured: 819 * i16::from(2 * side + number),
                    contact: 4096 * i16::from(side),
                    flags: Flags::VALID,
                    decisions: decisions.get() * side,
                    class: Some(number),
                };
                Some((CommandStatus::Done, looked.values()))
            }
            _ => None,
        };
        let mut module = Conversation::new(Box::new(Scripted::new(answering)));
        let mut looking = Looking::at(Array::of([2, 2], 1, Some(4)));
        let classes = ["loam", "ice"].map(str::to_owned);
        let mut look = || -> Vec<Hair> {
            for _ in 0..5 {
                looking.ask(&mut module).unwrap();
                let mut incoming = module.receive().unwrap();
                looking.take(&mut incoming, &classes, module.now_s());
                assert_eq!(incoming.packets, []);
            }
            looking.hairs(module.now_s())
        };
        let said = |hairs: &[Hair]| -> Vec<String> {
            hairs.iter().map(|hair| hair.said.clone()).collect()
        };
        let hairs = look();
        assert_eq!(said(&hairs), ["", "silent", "", ""]);
        let boards: Vec<_> = hairs.iter().map(|hair| hair.stand.board).collect();
        assert_eq!(boards, [0, 1, 2, 3].map(Some));
        let near = |found: f64, expected: f64| (found - expected).abs() < 0.02;
        assert!(near(hairs[3].angle_deg, 80.0) && near(hairs[0].angle_deg, 50.0));
        assert_eq!((hairs[2].contact, hairs[0].contact), (0.5, 0.0));
        count.set(1);
        assert_eq!(said(&look()), ["", "silent", "loam", "ice"]);
        (0..3).for_each(|_| drop(look()));
        assert_eq!(said(&look()), ["", "silent", "", ""]);
    }
}
