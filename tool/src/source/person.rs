//! Whoever is at the bench, who lays samples before the whisker when asked to.

use std::io::{self, BufRead, IsTerminal};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;

use host_sim::{Error, report};

/// A person before a keyboard. Their answers are read beside the work: the module goes on while
/// a sample is exchanged, and what it tells must be fetched.
#[derive(Debug)]
pub(crate) struct Person {
    answers: Receiver<io::Result<()>>,
    /// Whether answers that come before they are asked for are a key pressed once too often;
    /// otherwise they were written down beforehand.
    forgets: bool,
    /// The sample that they were asked for, until they have answered.
    asked: Option<String>,
}

impl Person {
    pub(crate) fn at_standard_input() -> Self {
        Self::new(|| Box::new(io::stdin().lock()), io::stdin().is_terminal())
    }

    fn new(input: impl FnOnce() -> Box<dyn BufRead> + Send + 'static, forgets: bool) -> Self {
        let (answer, answers) = mpsc::channel();
        thread::spawn(move || {
            // Until the end of the input, or of whoever listens.
            for line in input().lines() {
                if answer.send(line.map(drop)).is_err() {
                    break;
                }
            }
        });
        Self {
            answers,
            forgets,
            asked: None,
        }
    }

    pub(crate) fn lay(&mut self, sample: &str) {
        if self.forgets {
            // All that has come by now; a closed input is reported when it counts.
            while let Ok(Ok(())) = self.answers.try_recv() {}
        }
        report::warn(format_args!(
            "lay {sample} before the whisker, within its reach, and press Enter"
        ));
        self.asked = Some(sample.to_owned());
    }

    pub(crate) fn is_laid(&mut self) -> Result<bool, Error> {
        let Some(sample) = &self.asked else {
            return Ok(true);
        };
        let gone = |why: &str| {
            Error::Work(format!(
                "{sample}: standard input {why} before somebody said that the sample lies there; \
                 run this in a terminal, or give it a line for each sample"
            ))
        };
        match self.answers.try_recv() {
            Ok(Ok(())) => self.asked = None,
            Ok(Err(error)) => return Err(gone(&format!("failed ({error})"))),
            Err(TryRecvError::Disconnected) => return Err(gone("was closed")),
            Err(TryRecvError::Empty) => {}
        }
        Ok(self.asked.is_none())
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufReader, Read};
    use std::sync::mpsc::{self, Receiver, Sender};
    use std::time::{Duration, Instant};

    use super::Person;

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
        let person = Person::new(|| Box::new(BufReader::new(Keys(keys))), forgets);
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
    fn a_sample_is_laid_once_enter_is_pressed() {
        let (press, mut person) = at_keys(true);
        assert!(person.is_laid().unwrap(), "nothing was asked for");
        person.lay("felt");
        assert!(!person.is_laid().unwrap());
        press.send(b'\n').unwrap();
        assert_eq!(waited(&mut person), Ok(true));
        person.lay("carpet");
        assert!(!person.is_laid().unwrap());
    }

    #[test]
    fn at_a_terminal_a_key_pressed_too_early_is_no_answer() {
        for (forgets, laid) in [(true, false), (false, true)] {
            let (press, mut person) = at_keys(forgets);
            person.lay("felt");
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
