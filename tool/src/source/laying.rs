//! Who lays samples before the whisker of a real bench: a person when asked to, or a command of
//! theirs that moves a stage.

use std::io::{self, IsTerminal};
use std::process::{Child, Command};

use host_sim::{Error, report};

use crate::typed::Typed;

const SAMPLE: &str = "SAMPLE";

/// Who is asked for samples, one at a time.
#[derive(Debug)]
pub(crate) enum Laying {
    /// Nobody, until they are asked first: until then the keyboard is somebody else's, such as the
    /// window's, whose keys stop motors.
    Person(Option<Person>),
    Command {
        /// For the shell.
        line: String,
        /// For which sample it runs.
        running: Option<(String, Child)>,
    },
}

impl Laying {
    pub(crate) fn by(line: Option<&str>) -> Self {
        match line {
            None => Self::Person(None),
            Some(line) => Self::Command {
                line: line.to_owned(),
                running: None,
            },
        }
    }

    pub(super) fn lay(&mut self, sample: &str) -> Result<(), Error> {
        match self {
            Self::Person(person) => {
                let person = person.get_or_insert_with(Person::at_standard_input);
                person.lay(sample);
            }
            Self::Command { line, running } => {
                report::warn(format_args!("{sample}: laid by {line}"));
                let child = shell(line).env(SAMPLE, sample).spawn();
                let child = child.map_err(|error| failed(line, sample, &error.to_string()))?;
                *running = Some((sample.to_owned(), child));
            }
        }
        Ok(())
    }

    /// Whether it lies there. Does not wait.
    pub(super) fn is_laid(&mut self) -> Result<bool, Error> {
        let (line, running) = match self {
            Self::Person(person) => return person.as_mut().map_or(Ok(true), Person::is_laid),
            Self::Command { line, running } => (line, running),
        };
        let Some((sample, child)) = running else {
            return Ok(true);
        };
        match child.try_wait() {
            Ok(None) => return Ok(false),
            Ok(Some(status)) if status.success() => {}
            Ok(Some(status)) => return Err(failed(line, sample, &status.to_string())),
            Err(error) => return Err(failed(line, sample, &error.to_string())),
        }
        *running = None;
        Ok(true)
    }
}

fn shell(line: &str) -> Command {
    let [shell, option] = if cfg!(windows) {
        ["cmd", "/C"]
    } else {
        ["sh", "-c"]
    };
    let mut command = Command::new(shell);
    command.args([option, line]);
    command
}

fn failed(line: &str, sample: &str, why: &str) -> Error {
    Error::Work(format!("--lay-by {line}, for {sample}: {why}"))
}

/// A person before a keyboard.
#[derive(Debug)]
pub(crate) struct Person {
    answers: Typed,
    /// Whether answers that come before they are asked for are a key pressed once too often;
    /// otherwise they were written down beforehand.
    forgets: bool,
    /// The sample that they were asked for, until they have answered.
    asked: Option<String>,
}

impl Person {
    fn at_standard_input() -> Self {
        Self::new(Typed::at_standard_input(), io::stdin().is_terminal())
    }

    const fn new(answers: Typed, forgets: bool) -> Self {
        Self {
            answers,
            forgets,
            asked: None,
        }
    }

    fn lay(&mut self, sample: &str) {
        if self.forgets {
            // All that has come by now; a closed input is reported when it counts.
            while let Ok(Some(_)) = self.answers.line() {}
        }
        report::warn(format_args!(
            "lay {sample} before the whisker, within its reach, and press Enter"
        ));
        self.asked = Some(sample.to_owned());
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        let Some(sample) = &self.asked else {
            return Ok(true);
        };
        let gone = |why: String| {
            Error::Work(format!(
                "{sample}: standard input {why} before somebody said that the sample lies there; \
                 run this in a terminal, or give it a line for each sample"
            ))
        };
        let is_laid = self.answers.line().map_err(gone)?.is_some();
        if is_laid {
            self.asked = None;
        }
        Ok(is_laid)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufReader, Read};
    use std::sync::mpsc::{self, Receiver, Sender};
    use std::time::{Duration, Instant};

    use super::*;

    #[cfg(unix)]
    fn laid(line: &str, sample: &str) -> Result<(), Error> {
        let mut laying = Laying::by(Some(line));
        assert!(laying.is_laid()?, "nothing was asked for");
        laying.lay(sample)?;
        let begun = Instant::now();
        while !laying.is_laid()? {
            assert!(begun.elapsed() < Duration::from_secs(20));
            std::thread::yield_now();
        }
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn a_command_is_given_the_sample_and_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("laid");
        let line = format!("sleep 0.05; printf %s \"$SAMPLE\" > {}", file.display());
        laid(&line, "felt; of wool").unwrap();
        assert_eq!(std::fs::read_to_string(file).unwrap(), "felt; of wool");
    }

    #[cfg(unix)]
    #[test]
    fn a_command_that_fails_is_reported() {
        let failure = laid("exit 3", "felt").unwrap_err().to_string();
        let says = "--lay-by exit 3, for felt: exit status: 3";
        assert!(failure.starts_with(says), "{failure}");
    }

    struct Keys(Receiver<u8>);

    impl Read for Keys {
        fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
            let key = self.0.recv();
            Ok(key.map_or(0, |key| {
                into[0] = key;
                1
            }))
        }
    }

    fn at_keys(forgets: bool) -> (Sender<u8>, Person) {
        let (press, keys) = mpsc::channel();
        let answers = Typed::of(|| Box::new(BufReader::new(Keys(keys))));
        let person = Person::new(answers, forgets);
        (press, person)
    }

    /// Whether it is laid, once that is known.
    fn waited(person: &mut Person) -> Result<bool, String> {
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(5) {
            match person.is_laid() {
                Ok(false) => std::thread::yield_now(),
                done => return done.map_err(|error| error.to_string()),
            }
        }
        Ok(false)
    }

    #[test]
    fn a_sample_is_laid_once_enter_is_pressed_and_at_a_terminal_not_by_a_key_from_before() {
        for (forgets, laid) in [(true, false), (false, true)] {
            let (press, mut person) = at_keys(forgets);
            assert!(person.is_laid().unwrap(), "nothing was asked for");
            person.lay("felt");
            assert!(!person.is_laid().unwrap());
            press.send(b'\n').unwrap();
            assert_eq!(waited(&mut person), Ok(true));
            press.send(b'\n').unwrap();
            // Until the thread has passed it on.
            std::thread::sleep(Duration::from_millis(100));
            person.lay("carpet");
            assert_eq!(person.is_laid().unwrap(), laid);
        }
    }
}
