//! Who lays samples before the whisker of a real bench: a person, or a command of theirs that
//! moves a stage.

use std::process::{Child, Command};

use host_sim::{Error, report};

use super::person::Person;

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

#[cfg(all(test, unix))]
mod tests {
    use std::time::{Duration, Instant};

    use host_sim::Error;

    use super::Laying;

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

    #[test]
    fn a_command_is_given_the_sample_and_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("laid");
        let line = format!("sleep 0.05; printf %s \"$SAMPLE\" > {}", file.display());
        laid(&line, "felt; of wool").unwrap();
        assert_eq!(std::fs::read_to_string(file).unwrap(), "felt; of wool");
    }

    #[test]
    fn a_command_that_fails_is_reported() {
        let failure = laid("exit 3", "felt").unwrap_err().to_string();
        assert!(
            failure.starts_with("--lay-by exit 3, for felt: exit status: 3"),
            "{failure}"
        );
    }
}
