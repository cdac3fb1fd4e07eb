//! What somebody types, line by line, read beside the work: the module goes on meanwhile, and what
//! it tells must be fetched.

use std::io::{self, BufRead};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;

#[derive(Debug)]
pub(crate) struct Typed(Receiver<io::Result<String>>);

impl Typed {
    pub(crate) fn at_standard_input() -> Self {
        Self::of(|| Box::new(io::stdin().lock()))
    }

    pub(crate) fn of(input: impl FnOnce() -> Box<dyn BufRead> + Send + 'static) -> Self {
        let (say, typed) = mpsc::channel();
        thread::spawn(move || {
            // Until the end of the input, or of whoever listens.
            for line in input().lines() {
                if say.send(line).is_err() {
                    break;
                }
            }
        });
        Self(typed)
    }

    /// The next line, if it has come by now; or what has become of the input.
    pub(crate) fn line(&self) -> Result<Option<String>, String> {
        match self.0.try_recv() {
            Ok(Ok(line)) => Ok(Some(line)),
            Ok(Err(error)) => Err(format!("failed ({error})")),
            Err(TryRecvError::Disconnected) => Err("was closed".to_owned()),
            Err(TryRecvError::Empty) => Ok(None),
        }
    }
}
