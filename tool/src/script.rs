//! Commands at their times: lines `TIME COMMAND [SIDE [VALUE]]`, or `TIME set KEY VALUE`.

use std::collections::VecDeque;
use std::path::Path;

use firmware::Packet;
use host_sim::Error;
use scene::{Override, file};
use wire::text::{self, Spoken};
use wire::{Command, CommandStatus};

use crate::conversation::Conversation;
use crate::source::SourceChoice;
use crate::tuning::{Tuner, live_key};

#[derive(Debug, Clone, PartialEq)]
struct Entry {
    /// s since the script began.
    at_s: f64,
    text: String,
    action: Action,
}

#[derive(Debug, Clone, PartialEq)]
enum Action {
    Give(Command),
    Set(Override),
}

/// Commands that are still to be given, and what became of the others.
#[derive(Debug, Default)]
pub(crate) struct Script {
    entries: VecDeque<Entry>,
    begun_s: Option<f64>,
    /// The command that is not answered yet, and the tag of its request.
    pending: Option<(u16, String)>,
    refused: u32,
    tuner: Option<Tuner>,
}

impl Script {
    /// Fails for a key that cannot be set in the module of this choice.
    pub(crate) fn of(path: Option<&Path>, source: &SourceChoice) -> Result<Self, Error> {
        let Some(path) = path else {
            return Ok(Self::default());
        };
        let text = file::read_text(path).map_err(|error| Error::file(path, error))?;
        let mut script = Self::parse(&text).map_err(|fault| Error::file(path, fault))?;
        let keys = script
            .entries
            .iter()
            .filter_map(|entry| match &entry.action {
                Action::Set(set) => Some(set.key()),
                Action::Give(_) => None,
            });
        let keys: Vec<&str> = keys.collect();
        if keys.is_empty() {
            return Ok(script);
        }
        let fault = "set: nothing says which scene the module runs";
        let none = || Error::Input(fault.to_owned());
        let tuner = Tuner::open(source.scene().ok_or_else(none)?, source)?;
        for key in keys {
            live_key(key, tuner.scene()).map_err(Error::Input)?;
        }
        script.tuner = Some(tuner);
        Ok(script)
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut entries: VecDeque<Entry> = VecDeque::new();
        let text = text.trim_start_matches('\u{feff}');
        for (n, line) in (1..).zip(text.lines()) {
            let words = line.split('#').next().unwrap_or_default();
            if words.trim().is_empty() {
                continue;
            }
            let entry = entry(words).map_err(|fault| format!("line {n}: {fault}"))?;
            if entries.back().is_some_and(|last| last.at_s > entry.at_s) {
                let fault = "its time is before that of the last command";
                return Err(format!("line {n}: {fault}"));
            }
            entries.push_back(entry);
        }
        Ok(Self {
            entries,
            ..Self::default()
        })
    }

    /// Returns the line of a key that was set, or was refused.
    pub(crate) fn play(&mut self, module: &mut Conversation) -> Result<Option<String>, Error> {
        let now_s = module.now_s();
        let begun_s = *self.begun_s.get_or_insert(now_s);
        let is_due = |entry: &Entry| now_s - begun_s >= entry.at_s;
        if self.pending.is_none()
            && self.entries.front().is_some_and(is_due)
            && let Some(entry) = self.entries.pop_front()
        {
            let Entry { text, action, .. } = entry;
            match action {
                Action::Give(command) => self.pending = Some((module.send(command)?, text)),
                Action::Set(set) => return self.set(module, set, &text).map(Some),
            }
        }
        Ok(None)
    }

    fn set(
        &mut self,
        module: &mut Conversation,
        set: Override,
        text: &str,
    ) -> Result<String, Error> {
        let done = match &self.tuner {
            Some(tuner) => tuner.set(module, &[set]),
            None => Err(Error::Input("nothing says of which scene".to_owned())),
        };
        let t_s = module.now_s();
        let became = match done {
            Ok(Ok(_)) => "done".to_owned(),
            // What comes later in the script, such as a stop, is given all the same.
            Ok(Err(fault)) | Err(Error::Input(fault)) => {
                self.refused += 1;
                fault
            }
            Err(error) => return Err(error),
        };
        Ok(format!("{t_s:.3} {text}: {became}"))
    }

    /// The line of an answer, at so many ticks a second, if the packet is one to the script.
    pub(crate) fn answered(&mut self, packet: &Packet, tick_hz: u32) -> Option<String> {
        let Packet::Answer(answer) = packet else {
            return None;
        };
        let (_, text) = self.pending.take_if(|(tag, _)| *tag == answer.tag)?;
        self.refused += u32::from(answer.status != CommandStatus::Done);
        let t_s = f64::from(answer.sequence) / f64::from(tick_hz);
        Some(format!("{t_s:.3} {text}: {}", answer.status))
    }

    /// Fails if a command was refused, or was not answered.
    pub(crate) fn end(&self) -> Result<(), Error> {
        let left = self.entries.len() + usize::from(self.pending.is_some());
        match (self.refused, left) {
            (0, 0) => Ok(()),
            (refused, 0) => Err(format!("commands that were refused: {refused}")),
            (_, left) => Err(format!(
                "commands without an answer at the end: {left}; a longer time is --seconds"
            )),
        }
        .map_err(Error::Work)
    }
}

fn entry(words: &str) -> Result<Entry, String> {
    let words: Vec<&str> = words.split_whitespace().collect();
    let (time, said) = words.split_first().unwrap_or((&"", &[]));
    let at_s = time.parse().ok();
    let at_s = at_s.filter(|at_s: &f64| *at_s >= 0.0 && *at_s <= 1e6);
    let at_s = at_s.ok_or_else(|| format!("found the time {time:?}, allowed: 0 to 1000000 s"))?;
    let text = said.join(" ");
    if let ["set", key, value @ ..] = said {
        // A table or a list may hold blanks.
        let value = match value {
            [value] => (*value).to_owned(),
            [first, ..] if first.starts_with(['{', '[']) => value.join(" "),
            _ => return Err(format!("found {text:?}, allowed: set KEY VALUE")),
        };
        let action = Action::Set(Override::new(text.clone(), key, &value));
        return Ok(Entry { at_s, text, action });
    }
    let why = match text::parse(text.as_bytes()) {
        Ok(Spoken::Command(command)) => {
            let action = Action::Give(command);
            return Ok(Entry { at_s, text, action });
        }
        Ok(Spoken::Nothing | Spoken::Help) => "no command".to_owned(),
        Err((_, fault)) => fault.to_string(),
    };
    let allowed = text::ALLOWED;
    Err(format!(
        "found {text:?}, {why}; allowed: {allowed}, set KEY VALUE"
    ))
}

#[cfg(test)]
mod tests {
    use super::Script;

    #[test]
    fn faults_name_their_line() {
        let fault = |text: &str| Script::parse(text).unwrap_err();
        assert!(fault("0 arm\nsoon stop").starts_with("line 2: found the time \"soon\""));
        // What Windows writes first changes nothing.
        assert!(Script::parse("\u{feff}0 arm\r\n").is_ok());
        assert!(Script::parse("0 set classifier.prior { smooth = 0.9 }").is_ok());
        assert!(fault("1 stop\n0 arm").starts_with("line 2: its time is before"));
        for text in ["0 clear front", "0 set motor.kp", "0 set motor.kp 1 2"] {
            assert!(fault(text).starts_with("line 1: found"), "{text}");
        }
    }
}
