//! A board at the other end of a serial port.

use std::io::ErrorKind;
use std::path::Path;
use std::time::{Duration, Instant};

use firmware::{Links, Packet};
use host_sim::Error;
use host_sim::origin::Origin;
use host_sim::received::{Received, Receiver};
use serial2::SerialPort;
use wire::{Answer, Command, CommandStatus, TaggedCommand};

use super::laying::Laying;
use super::{Incoming, Source, framed};

const WAIT: Duration = Duration::from_millis(50);

/// For how long nothing may come. A board says how it fares every second of its time, of which
/// an emulated one may take some.
const SILENCE: Duration = Duration::from_secs(20);

/// When an unanswered [`HELLO`] is sent again.
const ASK_AGAIN: Duration = Duration::from_secs(1);
/// Its tag, by which conversations do not begin.
const TAG: u16 = 0;
const HELLO: TaggedCommand = TaggedCommand {
    tag: TAG,
    command: Command::Hello,
};

/// Most that a line comes behind its time, s.
const LATE_S: f64 = 1.0;

/// The board's time, from when something has come first.
#[derive(Debug, Clone, Copy, Default)]
struct BoardTime {
    elapsed_s: f64,
    last_s: Option<f64>,
}

impl BoardTime {
    /// It says that so much has passed since its start; whether that is a new one. A line may be
    /// older than a record before it.
    fn is(&mut self, t_s: f64) -> bool {
        let since = self.last_s.map_or(0.0, |last_s| t_s - last_s);
        let is_late = (-LATE_S..0.0).contains(&since);
        if !is_late {
            self.elapsed_s += since.max(0.0);
            self.last_s = Some(t_s);
        }
        since < -LATE_S
    }
}

pub(super) struct Port {
    line: SerialPort,
    name: String,
    receiver: Receiver,
    laying: Laying,
    last: Instant,
    time: BoardTime,
    tick_hz: Option<u32>,
    /// The tag of what another board was asked for last, whose ticks are its own.
    elsewhere: Option<u16>,
}

/// Asks the board on a port to stop, before anything else and whatever becomes of it: who asks
/// properly does so after it.
pub(super) fn stop(path: &Path, baud: u32) {
    let command = Command::Stop;
    if let Ok(line) = SerialPort::open(path, baud) {
        let tag = u16::MAX;
        let _ = line.write_all(&framed(None, TaggedCommand { tag, command }));
        let _ = line.flush();
    }
}

impl Port {
    pub(super) fn open(path: &Path, baud: u32, laying: Laying) -> Result<Self, Error> {
        let wrong = |error: std::io::Error| Error::file(path, error);
        let mut line = SerialPort::open(path, baud).map_err(wrong)?;
        line.set_read_timeout(WAIT).map_err(wrong)?;
        line.discard_buffers().map_err(wrong)?;
        let mut port = Self {
            line,
            name: path.display().to_string(),
            receiver: Receiver::default(),
            laying,
            last: Instant::now(),
            time: BoardTime::default(),
            tick_hz: None,
            elsewhere: None,
        };
        port.greet().map_err(|error| {
            Error::Work(format!(
                "{error}; is it a board whose scene has telemetry.serial_baud = {baud}?"
            ))
        })?;
        Ok(port)
    }

    fn greet(&mut self) -> Result<(), Error> {
        let begun = Instant::now();
        let mut asked = None;
        // A board that waits for more of a scene refuses, and gives it up once no request comes.
        let mut is_loading = false;
        while self.tick_hz.is_none() {
            if !is_loading && asked.is_none_or(|asked: Instant| asked.elapsed() > ASK_AGAIN) {
                self.request(None, HELLO)?;
                asked = Some(Instant::now());
            }
            let incoming = self.next()?;
            is_loading &= incoming.lines.is_empty();
            for packet in incoming.packets {
                match packet {
                    Packet::Answer(Answer {
                        tag: TAG,
                        status: CommandStatus::Done,
                        values: [tick_hz @ 1..=i32::MAX, _],
                        ..
                    }) => self.tick_hz = Some(tick_hz.cast_unsigned()),
                    Packet::Answer(Answer { tag: TAG, .. }) => is_loading = true,
                    _ => {}
                }
            }
            if begun.elapsed() > SILENCE {
                let fault = format!("{}: `hello` is not answered", self.name);
                return Err(Error::Work(fault));
            }
        }
        Ok(())
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let written = self.line.write_all(bytes);
        written.map_err(|error| Error::Work(format!("{}: {error}", self.name)))
    }

    /// The board's time by something that has come, s since its start.
    fn time_s(&self, received: &Received) -> Option<f64> {
        let sequence = match received {
            Received::Line(line) => {
                let (time, _) = line.split_once(' ')?;
                return time.parse().ok().filter(|t_s: &f64| t_s.is_finite());
            }
            Received::Packet(Packet::Record(record)) => record.sequence,
            Received::Packet(Packet::Answer(answer)) => {
                let is_own = self.elsewhere != Some(answer.tag);
                is_own.then_some(answer.sequence)?
            }
            Received::Packet(Packet::Event(event)) => event.sequence,
            Received::Garbled => return None,
        };
        Some(f64::from(sequence) / f64::from(self.tick_hz?))
    }
}

impl Source for Port {
    fn next(&mut self) -> Result<Incoming, Error> {
        let mut incoming = Incoming::default();
        let mut bytes = [0; 4096];
        let count = match self.line.read(&mut bytes) {
            // What waits before it reads has something, or is gone.
            Ok(0) if cfg!(unix) => {
                return Err(Error::Work(format!("{}: is gone", self.name)));
            }
            Ok(count) => count,
            Err(error) => match error.kind() {
                // Another program may have been faster, or a signal.
                ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => 0,
                _ => return Err(Error::Work(format!("{}: {error}", self.name))),
            },
        };
        let now = Instant::now();
        if count > 0 {
            self.last = now;
        } else if now - self.last > SILENCE {
            let (name, seconds) = (&self.name, SILENCE.as_secs());
            let fault = format!("{name}: nothing has come for {seconds} s");
            return Err(Error::Work(fault));
        }
        for received in self.receiver.take(bytes.get(..count).unwrap_or_default()) {
            if let Some(t_s) = self.time_s(&received) {
                incoming.has_restarted |= self.time.is(t_s);
            }
            match received {
                Received::Line(line) => incoming.lines.push(line),
                Received::Packet(packet) => incoming.packets.push(packet),
                // Of the first line, which was under way as the port was opened, or lost.
                Received::Garbled => {}
            }
        }
        Ok(incoming)
    }

    fn request(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<(), Error> {
        if node.is_some() {
            self.elsewhere = Some(request.tag);
        }
        self.write(&framed(node, request))
    }

    fn laying(&mut self) -> Option<&mut Laying> {
        Some(&mut self.laying)
    }

    fn now_s(&mut self) -> f64 {
        self.time.elapsed_s
    }

    fn has_clock(&self) -> bool {
        // An emulated board takes its time.
        false
    }

    fn would_answer(&self, links: Links) -> Result<(), Error> {
        let fault = "telemetry.serial_baud: found none; allowed for a scene that is deployed by \
                     the serial port: a baud, or else the board could not be asked any more";
        let can = links.serial_baud.map(drop);
        can.ok_or_else(|| Error::Input(fault.to_owned()))
    }

    fn speaks(&mut self, links: Links) -> Result<(), Error> {
        let wrong = |error: std::io::Error| Error::Work(format!("{}: {error}", self.name));
        let Some(baud) = links.serial_baud else {
            return Ok(());
        };
        let mut settings = self.line.get_configuration().map_err(wrong)?;
        settings.set_baud_rate(baud).map_err(wrong)?;
        self.line.set_configuration(&settings).map_err(wrong)
    }

    fn origin(&self) -> Origin {
        Origin::default().with("board", format_args!("at {}", self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::BoardTime;

    #[test]
    fn time_goes_on_through_late_lines_and_a_new_start() {
        let mut time = BoardTime::default();
        for (t_s, elapsed_s) in [
            (5.0, 0.0),
            (6.0, 1.0),
            // A line that is older than the last record.
            (5.5, 1.0),
            (6.5, 1.5),
            // It has started again.
            (0.5, 1.5),
            (1.0, 2.0),
        ] {
            assert_eq!(time.is(t_s), t_s == 0.5);
            assert_eq!(time.elapsed_s, elapsed_s, "{t_s}");
        }
    }
}
