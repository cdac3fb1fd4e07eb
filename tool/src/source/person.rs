//! Whoever is at the bench, who lays samples before the whisker when asked to.

use std::io::{self, IsTerminal};

use host_sim::{Error, report};

use crate::typed::Typed;

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
    pub(crate) fn at_standard_input() -> Self {
        Self::new(Typed::at_standard_input(), io::stdin().is_terminal())
    }

    const fn new(answers: Typed, forgets: bool) -> Self {
        Self {
            answers,
            forgets,
            asked: None,
        }
    }

    pub(crate) fn lay(&mut self, sample: &str) {
        if self.forgets {
            // All that has come by now; a closed input is reported when it counts.
            while let Ok(Some(_)) = self.answers.line() {}
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

    use super::{Person, Typed};

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
