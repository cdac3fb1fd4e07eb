//! Listening to a module, apart from all drawing: what comes is taken, kept and recorded, and
//! wishes reach the module between two ticks, whatever the window does meanwhile.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use host_sim::Error;
use wire::{Answer, Command, Flags};

use super::history::{History, LOOKS_HZ};
use super::looking::Looking;
use crate::conversation::Conversation;
use crate::record_file::RecordFile;
use crate::script::Script;
use crate::source::Incoming;

/// After how long without an answer the motors are asked to stop again, s.
const AGAIN_S: f64 = 0.1;
const PATIENCE_S: f64 = 2.0;
/// For how long a stopped module is listened to, so that what is recorded shows that its motors
/// are off, s.
const AFTER_S: f64 = 0.05;

/// How far a simulation may run ahead of its time before it waits.
const AHEAD: Duration = Duration::from_millis(4);

pub(crate) struct Shared {
    pub(crate) history: History,
    /// What is said at the bottom, and the tick by then.
    pub(crate) message: Option<(u64, String)>,
    pub(crate) has_ended: bool,
    /// Files that are being written; each says at its end what became of it.
    pub(crate) saving: Vec<JoinHandle<String>>,
}

impl Shared {
    pub(crate) fn say(&mut self, line: String) {
        self.message = Some((self.history.now(), line));
    }
}

/// Whoever holds it has it whole: no step leaves it half done.
pub(crate) fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(crate) fn joined(listener: JoinHandle<Result<(), Error>>) -> Result<(), Error> {
    let failed = |_| Err(Error::Work("whoever listens has failed".to_owned()));
    listener.join().unwrap_or_else(failed)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wish {
    Arm,
    Stop,
    End,
    StopAndEnd,
}

pub(crate) struct Watching {
    pub(crate) module: Conversation,
    pub(crate) script: Script,
    pub(crate) tick_hz: u32,
    pub(crate) files: Vec<RecordFile>,
    pub(crate) shared: Arc<Mutex<Shared>>,
    pub(crate) wishes: Receiver<Wish>,
    /// Seconds of the module in a second; none: as fast as it goes.
    pub(crate) speed: Option<f64>,
    pub(crate) begun_s: f64,
    /// At the whiskers of a head, and when they were shown last, s.
    pub(crate) looking: Option<Looking>,
    pub(crate) looked_s: f64,
    /// How long to listen, s of the module; none: until it is ended.
    pub(crate) most_s: Option<f64>,
}

#[derive(Debug, Default)]
struct Stopping {
    tags: Vec<u16>,
    /// When the first and the last was sent, s; none: not yet.
    first_s: Option<f64>,
    last_s: f64,
}

impl Watching {
    /// Listens until it is ended. Whatever ends it but [`Wish::End`] and time stops the motors
    /// first, and what was recorded until then is kept.
    pub(crate) fn run(mut self) -> Result<(), Error> {
        let mut done = self.watch();
        if done.is_err() {
            // It may still take a request.
            let _ = self.module.send(Command::Stop);
        }
        for file in std::mem::take(&mut self.files) {
            let finished = file.finish();
            done = done.and(finished);
        }
        lock(&self.shared).has_ended = true;
        done
    }

    fn watch(&mut self) -> Result<(), Error> {
        let mut pace = Pace::new(self.speed, self.module.now_s());
        let mut stopping: Option<Stopping> = None;
        let mut ends_at_s: Option<f64> = None;
        let mut is_ending = false;
        loop {
            let now_s = self.module.now_s();
            // Waits for what is wanted, not for time alone.
            let wish = match self.wishes.recv_timeout(pace.ahead(now_s)) {
                Ok(wish) => Some(wish),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => Some(Wish::StopAndEnd),
            };
            match wish {
                Some(Wish::End) => return Ok(()),
                Some(Wish::StopAndEnd) if !is_ending => {
                    is_ending = true;
                    stopping = Some(Stopping::default());
                }
                Some(Wish::Stop) if !is_ending => stopping = Some(Stopping::default()),
                // What is being stopped is not armed.
                Some(Wish::Arm) if stopping.is_none() => {
                    self.module.send(Command::Arm)?;
                }
                _ => {}
            }
            if let Some(stopping) = &mut stopping {
                self.stop(stopping, now_s)?;
            }

            // What is being stopped goes on with no script.
            if stopping.is_none()
                && let Some(line) = self.script.play(&mut self.module)?
            {
                self.say(line);
            }
            let incoming = self.receive()?;
            let answers = self.take(&incoming)?;
            for answer in &answers {
                self.tell(answer);
            }
            let is_done = |stopping: &mut Stopping| {
                let mut tags = answers.iter().map(|answer| answer.tag);
                tags.any(|tag| stopping.tags.contains(&tag))
            };
            let now_s = self.module.now_s();
            if stopping.take_if(is_done).is_some() && is_ending {
                ends_at_s = Some(now_s + AFTER_S);
            }
            let is_off = ends_at_s.is_some() && is_unarmed(&incoming);
            if is_off || ends_at_s.is_some_and(|end_s| now_s >= end_s) {
                return Ok(());
            }
            let most_s = self.most_s.filter(|_| !is_ending);
            if most_s.is_some_and(|most_s| now_s - self.begun_s >= most_s) {
                return Ok(());
            }
        }
    }

    /// What comes next, without what is looked at.
    fn receive(&mut self) -> Result<Incoming, Error> {
        let Some(looking) = &mut self.looking else {
            return self.module.receive();
        };
        looking.ask(&mut self.module)?;
        let mut incoming = self.module.receive()?;
        let now_s = self.module.now_s();
        let history = &mut lock(&self.shared).history;
        looking.take(&mut incoming, &history.module_classes, now_s);
        if now_s - self.looked_s >= 1.0 / f64::from(LOOKS_HZ) {
            self.looked_s = now_s;
            history.see(looking.hairs(now_s));
        }
        Ok(incoming)
    }

    /// Tells the module to stop, again and again until it has answered.
    fn stop(&mut self, stopping: &mut Stopping, now_s: f64) -> Result<(), Error> {
        let first_s = *stopping.first_s.get_or_insert(now_s);
        let is_due = stopping.tags.is_empty() || now_s - stopping.last_s >= AGAIN_S;
        if !is_due {
            return Ok(());
        }
        let waited = now_s - first_s >= PATIENCE_S;
        match self.module.send(Command::Stop) {
            Ok(tag) if !waited => {
                stopping.tags.push(tag);
                stopping.last_s = now_s;
                Ok(())
            }
            Err(_) if !waited => Ok(()),
            _ => Err(Error::Work(format!(
                "the module has not answered in {PATIENCE_S} s that its motors are stopped: \
                 switch their supply off"
            ))),
        }
    }

    fn take(&mut self, incoming: &Incoming) -> Result<Vec<Answer>, Error> {
        let answers = lock(&self.shared).history.take(incoming);
        for packet in &incoming.packets {
            if let Some(line) = self.script.answered(packet, self.tick_hz) {
                self.say(line);
            }
        }
        for file in &mut self.files {
            file.packets(&incoming.packets)?;
            for line in &incoming.lines {
                file.line(line)?;
            }
        }
        Ok(answers)
    }

    fn say(&self, line: String) {
        lock(&self.shared).say(line);
    }

    fn tell(&self, answer: &Answer) {
        let mut told = [Command::Arm, Command::Stop].into_iter();
        if let Some(command) = told.find(|one| one.number() == answer.command) {
            self.say(format!("{}: {}", command.name(), answer.status));
        }
    }
}

fn is_unarmed(incoming: &Incoming) -> bool {
    let mut records = incoming.records();
    let has_come = records.clone().next().is_some();
    has_come && !records.any(|record| record.flags.contains(Flags::ARMED))
}

struct Pace {
    speed: Option<f64>,
    since: Instant,
    since_s: f64,
}

impl Pace {
    fn new(speed: Option<f64>, now_s: f64) -> Self {
        Self {
            speed,
            since: Instant::now(),
            since_s: now_s,
        }
    }

    fn ahead(&mut self, now_s: f64) -> Duration {
        let Some(speed) = self.speed else {
            return Duration::ZERO;
        };
        let due = Duration::try_from_secs_f64((now_s - self.since_s) / speed).unwrap_or_default();
        let passed = self.since.elapsed();
        if passed > due + Duration::from_millis(500) {
            // A PC that cannot keep up does not hurry afterwards.
            (self.since, self.since_s) = (Instant::now(), now_s);
        }
        let ahead = due.saturating_sub(passed);
        if ahead > AHEAD { ahead } else { Duration::ZERO }
    }
}
