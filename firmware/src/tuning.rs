//! Constants that a PC reads and changes between two ticks.
//!
//! Those that belong together are put aside one by one, and take effect all at once, if the PC's
//! sum says that they are all there, and if each is within its bounds. What was put aside stays
//! until it is forgotten, so that a request whose answer was lost can be repeated.

use whisking::{AsWords, Bound, Real, WordRow};
use wire::{Answer, Command, CommandStatus, SECOND_WORD, SETTINGS_DIFFER, TaggedCommand, word_sum};

use crate::tunable::{TUNABLE_COUNT, Tunable, Visitor};
use crate::{Clock, Config, Module, Perception, WordSource};

/// AsWords that were put aside.
#[derive(Debug)]
struct Staged {
    words: [[u32; 2]; TUNABLE_COUNT],
    /// Which of a constant's two there are: its lowest two bits.
    there: [u8; TUNABLE_COUNT],
}

impl Staged {
    const fn new() -> Self {
        Self {
            words: [[0; 2]; TUNABLE_COUNT],
            there: [0; TUNABLE_COUNT],
        }
    }

    fn put(&mut self, number: u8, word: u32) {
        let (constant, half) = (number & !SECOND_WORD, usize::from(number / SECOND_WORD));
        let at = usize::from(constant);
        let words = self.words.get_mut(at);
        let place = words.and_then(|words| words.get_mut(half));
        if let (Some(place), Some(there)) = (place, self.there.get_mut(at)) {
            *place = word;
            *there |= 1 << half;
        }
    }

    /// The words of a constant that has `now`; none if nothing is there for it.
    fn instead(&self, constant: u8, now: [u32; 2]) -> Option<[u32; 2]> {
        let at = usize::from(constant);
        let ([first, second], there) = (self.words.get(at)?, self.there.get(at)?);
        Some(match there & 3 {
            1 => [*first, now[1]],
            2 => [now[0], *second],
            3 => [*first, *second],
            _ => return None,
        })
    }

    /// The sum of all, in the order of their numbers: of each constant the first word, then the
    /// second.
    fn sum(&self) -> u32 {
        let words = (0..).zip(&self.words).zip(&self.there);
        let words = words.flat_map(|((constant, words), there)| {
            let halves = [
                (constant, 1, words[0]),
                (constant | SECOND_WORD, 2, words[1]),
            ];
            let halves = halves
                .into_iter()
                .filter(move |(_, bit, _)| there & bit != 0);
            halves.map(|(number, _, word)| (number, word))
        });
        word_sum(words)
    }
}

/// What is done with every constant.
enum Task<'s> {
    /// One is read.
    Read(u8, Option<[u32; 2]>),
    /// All are summed up.
    Sum(u32),
    /// What was put aside is looked at: the first that is none, or out of bounds.
    Check(&'s Staged, Option<u8>),
    /// It takes effect.
    Write(&'s Staged),
}

impl Task<'_> {
    /// What takes a constant's place, if anything does.
    // Apart: there are many constants.
    #[inline(never)]
    fn meet(&mut self, constant: u8, now: [u32; 2]) -> Option<[u32; 2]> {
        match self {
            Self::Read(asked, found) => {
                if *asked == constant {
                    *found = Some(now);
                }
                None
            }
            Self::Sum(sum) => {
                let [first, second] = now;
                let words = [(constant, first), (constant | SECOND_WORD, second)];
                *sum = sum.rotate_left(1) ^ word_sum(words.into_iter());
                None
            }
            Self::Check(staged, _) | Self::Write(staged) => staged.instead(constant, now),
        }
    }

    /// A constant has another value now, by `place`; or it is none.
    #[inline]
    fn settle<T: Copy>(&mut self, constant: u8, place: &mut T, value: Option<T>) {
        match (self, value) {
            (Self::Write(_), Some(value)) => *place = value,
            (Self::Check(_, wrong), None) => *wrong = wrong.or(Some(constant)),
            _ => {}
        }
    }
}

impl Visitor for Task<'_> {
    #[inline(never)]
    fn constant<T: AsWords>(&mut self, number: u8, place: &mut T, bound: Bound) {
        if let Some(words) = self.meet(number, place.words()) {
            self.settle(number, place, T::from_words(words, bound));
        }
    }

    #[inline(never)]
    fn in_row<T: WordRow>(&mut self, number: u8, row: &mut T, n: usize, bound: Bound) {
        if let Some(words) = self.meet(number, row.words(n)) {
            let mut changed = *row;
            let is_sound = changed.set_words(n, words, bound);
            self.settle(number, row, is_sound.then_some(changed));
        }
    }
}

/// The module's end of tuning.
#[derive(Debug)]
pub struct Tuning {
    staged: Staged,
    /// The sum of the constants that the program was built with, once one was changed.
    built_with: Option<u32>,
    differs: bool,
}

impl Default for Tuning {
    fn default() -> Self {
        Self::new()
    }
}

impl Tuning {
    /// Nothing was put aside, and nothing changed.
    pub const fn new() -> Self {
        Self {
            staged: Staged::new(),
            built_with: None,
            differs: false,
        }
    }

    /// Whether constants differ from those that the program was built with.
    pub const fn differs(&self) -> bool {
        self.differs
    }

    /// Carries out a request between two ticks, after the `sequence`-th, if it is one about
    /// constants. They have changed if its [`Command::Apply`] is [done](CommandStatus::Done).
    #[cold]
    #[inline(never)]
    pub fn carry_out<R, F, M, P, C, MC, PC, H, const S: usize, const N: usize>(
        &mut self,
        module: &mut Module<R, F, M, P, C, S, N>,
        config: &mut Config<MC, PC, H>,
        request: TaggedCommand,
        sequence: u32,
    ) -> Option<Answer>
    where
        R: Real,
        F: WordSource,
        P: Perception<R, PC, S, N>,
        C: Clock,
        Config<MC, PC, H>: Tunable<R>,
    {
        let done = match request.command {
            Command::Constant(0) => {
                let differs = if self.differs { SETTINGS_DIFFER } else { 0 };
                let format = R::FORMAT as u32 | differs;
                Ok([format, sum::<R, _>(config)])
            }
            Command::Constant(constant) => {
                read::<R, _>(config, constant).ok_or((CommandStatus::NotHere, 0))
            }
            Command::Stage(number, word) => {
                let constant = number & !SECOND_WORD;
                match read::<R, _>(config, constant) {
                    Some(_) => {
                        self.staged.put(number, word);
                        Ok([0; 2])
                    }
                    None => Err((CommandStatus::NotHere, constant)),
                }
            }
            Command::Apply(sum) => self.apply::<R, _>(config, sum).map(|()| {
                module.perception_mut().retune(&config.perception);
                [0; 2]
            }),
            Command::Forget => {
                self.staged.there = [0; TUNABLE_COUNT];
                Ok([0; 2])
            }
            _ => return None,
        };
        let (status, values) = match done {
            Ok(values) => (CommandStatus::Done, values),
            Err((status, constant)) => (status, [constant.into(), 0]),
        };
        Some(Answer {
            sequence,
            tag: request.tag,
            command: request.command.number(),
            status,
            values: values.map(u32::cast_signed),
        })
    }

    /// What was put aside takes effect, if it has this sum and is sound; otherwise says which
    /// constant is not, or 0 where the sum is not.
    fn apply<R, T: Tunable<R>>(
        &mut self,
        config: &mut T,
        asked: u32,
    ) -> Result<(), (CommandStatus, u8)> {
        if self.staged.sum() != asked {
            return Err((CommandStatus::OutOfRange, 0));
        }
        let mut check = Task::Check(&self.staged, None);
        walk::<R, _>(config, &mut check);
        if let Task::Check(_, Some(constant)) = check {
            return Err((CommandStatus::OutOfRange, constant));
        }
        let built_with = match self.built_with {
            Some(sum) => sum,
            None => sum::<R, _>(config),
        };
        self.built_with = Some(built_with);
        walk::<R, _>(config, &mut Task::Write(&self.staged));
        self.differs = sum::<R, _>(config) != built_with;
        Ok(())
    }
}

/// Does a task for every constant.
// Apart: it is the larger part of all this, and there are several tasks.
#[inline(never)]
fn walk<R, T: Tunable<R>>(config: &mut T, task: &mut Task<'_>) {
    config.visit(task);
}

fn read<R, T: Tunable<R>>(config: &mut T, constant: u8) -> Option<[u32; 2]> {
    let mut read = Task::Read(constant, None);
    walk::<R, _>(config, &mut read);
    match read {
        Task::Read(_, found) => found,
        _ => None,
    }
}

fn sum<R, T: Tunable<R>>(config: &mut T) -> u32 {
    let mut sum = Task::Sum(0);
    walk::<R, _>(config, &mut sum);
    match sum {
        Task::Sum(sum) => sum,
        _ => 0,
    }
}
