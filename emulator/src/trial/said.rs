//! What the board says: the lines of its log, and its answers on both links.

use std::collections::BTreeMap;

use firmware::Packet;
use host_sim::Error;
use host_sim::received::{Received, Receiver};
use serde::Serialize;
use wire::{Answer, Command, CommandStatus, Load, WhiskerId};

use crate::board::Board;

/// More events than so many are counted, and not listed.
const MOST_LISTED: usize = 100_000;

/// Something that the board has said, or that has happened to it.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(super) struct Listed {
    /// At the end of the tick in which it was read.
    pub(super) t_s: f64,
    /// The first word of its line, if docs/protocol.md has it; otherwise `log`. `answer`: to a
    /// request; `reset`: of the chip.
    pub(super) kind: String,
    /// `left` or `right`; none: of the whole board.
    pub(super) side: Option<String>,
    /// Of a fault or a limit.
    pub(super) number: Option<u8>,
    pub(super) name: Option<String>,
    pub(super) text: String,
}

impl Listed {
    fn new(t_s: f64, kind: &str, text: &str) -> Self {
        let [kind, text] = [kind, text].map(str::to_owned);
        Self {
            t_s,
            kind,
            text,
            ..Self::default()
        }
    }
}

#[derive(Debug, Default)]
pub(super) struct Lister {
    line: Receiver,
    pub(super) listed: Vec<Listed>,
    pub(super) answers: BTreeMap<String, u64>,
    /// Events that are not listed, as there were too many.
    pub(super) unlisted: u64,
}

/// Commands that can be asked for.
const SPOKEN: [Command; 15] = {
    let left = WhiskerId { side: 0, number: 0 };
    [
        Command::Hello,
        Command::Status,
        Command::Stream(true),
        Command::Arm,
        Command::Stop,
        Command::Clear(left),
        Command::Home(left),
        Command::Gain(left, 0),
        Command::Setpoint(left, 0),
        Command::Release(left),
        Command::Zero(left),
        Command::Frame(left),
        Command::Load(Load {
            config: 0,
            model: 0,
        }),
        Command::Restart,
        Command::Apply(0),
    ]
};

fn in_words(answer: &Answer) -> String {
    let mut spoken = SPOKEN.iter();
    let command = spoken.find(|command| command.number() == answer.command);
    let name = command.map_or("?", |command| command.name());
    let refused = firmware::refusal_of(answer.values);
    match (answer.status, refused) {
        (CommandStatus::Done, _) => format!("ok {name}"),
        (_, Some(error)) if name == "apply" => format!("refused apply: {error}"),
        (status, _) => format!("refused {name}: {status}"),
    }
}

impl Lister {
    pub(super) fn list_reset(&mut self, t_s: f64) {
        self.listed.push(Listed::new(t_s, "reset", "reset"));
    }

    /// What a board says that has logged these lines.
    pub(super) fn hear(
        &mut self,
        t_s: f64,
        lines: &[String],
        board: &mut Board,
    ) -> Result<(), Error> {
        for line in lines {
            self.list(of_log(t_s, line));
        }
        let by_probe = board.heard()?.into_iter();
        let bytes = board.machine.chip().serial_read();
        for seen in by_probe.chain(self.line.take(&bytes)) {
            match seen {
                Received::Packet(Packet::Answer(answer)) => self.answered(t_s, in_words(&answer)),
                // What begins with a time is in the log, too.
                Received::Line(line) if !line.starts_with(|c: char| c.is_ascii_digit()) => {
                    self.answered(t_s, line);
                }
                Received::Packet(_) | Received::Line(_) | Received::Garbled => {}
            }
        }
        Ok(())
    }

    /// Counts an answer; those about `stop` and `arm` are events.
    fn answered(&mut self, t_s: f64, text: String) {
        let about = text.split([' ', ':']).nth(1);
        if matches!(about, Some("stop" | "arm")) {
            self.list(Listed::new(t_s, "answer", &text));
        }
        // Behind what is done stand values.
        let counted = match text.strip_prefix("ok ") {
            Some(rest) => format!("ok {}", rest.split(' ').next().unwrap_or_default()),
            None => text,
        };
        *self.answers.entry(counted).or_default() += 1;
    }

    fn list(&mut self, listed: Listed) {
        if self.listed.len() < MOST_LISTED {
            self.listed.push(listed);
        } else {
            self.unlisted += 1;
        }
    }
}

fn of_log(t_s: f64, line: &str) -> Listed {
    // Time and level come first.
    let mut rest = line.splitn(3, ' ').nth(2).unwrap_or(line).trim_start();
    let text = rest.to_owned();
    let mut word = || {
        let (word, after) = rest.split_once(' ').unwrap_or((rest, ""));
        rest = after;
        word.to_owned()
    };
    let kind = word();
    let side = match &*kind {
        "fault" | "frame" | "back" | "retry" | "off" | "touch" | "end" | "decision" | "zero"
        | "self-test" => Some(word()),
        _ => None,
    };
    let number = match &*kind {
        "fault" | "limit" | "not-armed" | "self-test" => word().parse().ok(),
        _ => None,
    };
    // That of a self-test counts frames.
    let fault = number.filter(|_| kind != "self-test");
    let name = fault.map(|_: u8| {
        let (name, _) = rest.split_once(" (").unwrap_or((rest, ""));
        name.to_owned()
    });
    Listed {
        t_s,
        kind: match &*kind {
            "armed" | "back" | "decision" | "end" | "fault" | "frame" | "health" | "limit"
            | "node" | "not-armed" | "off" | "pose" | "retry" | "self-test" | "start"
            | "stopped" | "touch" | "zero" => kind,
            _ => "log".to_owned(),
        },
        side: side.filter(|side| side != "board"),
        number,
        name: name.filter(|name| !name.is_empty()),
        text,
    }
}
