//! Programming a board's flash.

use std::path::Path;
use std::time::{Duration, Instant};

use host_sim::progress::{Progress, Verbosity};
use host_sim::{Error, report};
use probe_rs::flashing::{
    DownloadOptions, ElfLoader, ElfOptions, FlashProgress, ProgressEvent, ProgressOperation,
    build_loader,
};
use probe_rs::{Core, MemoryInterface, Permissions, Session};
use wire::Command;

use super::behind::Behind;
use super::brown_out::{Level, OPTIONS, Words, is_loaded, raise};
use super::find;
use super::memory::{MemoryPort, chain};
use crate::conversation::Conversation;
use crate::source::{BoardName, Laying};

/// For how long a core may take to halt, and the flash for its option bytes: a few times what it
/// takes to erase a sector of 16 KiB, at most 0.5 s (DS10693, flash memory programming).
const HALT: Duration = Duration::from_millis(100);
const OPTION_BYTES: Duration = Duration::from_secs(3);

/// Stops the motors of what runs there, programs the ELF file, compares it, and resets the chip;
/// before that it raises an F446's brown-out level, unless that is kept.
pub(crate) fn flash(
    selector: &str,
    board: BoardName,
    elf: &Path,
    keeps_brown_out: bool,
    verbosity: Verbosity,
) -> Result<(), Error> {
    MemoryPort::of(find::open(selector)?)?.check(board)?;
    // The core is halted next, and a motor would be driven on meanwhile.
    match Behind::new(find::open(selector)?, board, None, Laying::by(None))
        .and_then(|module| Conversation::new(Box::new(module)).ask(Command::Stop))
    {
        Ok(_) => report::warn("the module that runs has stopped its motors"),
        Err(error) => report::warn(format_args!(
            "no module has stopped its motors ({error}); they are off once the chip is reset"
        )),
    }
    let mut session = program(selector, board, elf, verbosity)?;
    let raises = board == BoardName::NucleoF446re && !keeps_brown_out;
    let level = raises.then(|| brown_out(&mut session)).transpose()?;
    // Last, and by the memory port: letting go of the core halts it once more.
    drop(session);
    let mut memory = MemoryPort::of(find::open(selector)?)?;
    memory.reset()?;
    match level {
        Some(Level::Raised(wanted)) => {
            is_loaded(memory.word(OPTIONS)?, wanted)?;
            report::say("the brown-out level was below what the clock needs, and is level 3 now");
        }
        Some(Level::Kept(why)) => report::warn(format_args!(
            "the brown-out level is below what the clock needs, and stays so: {why}"
        )),
        Some(Level::WasHigh) | None => {}
    }
    report::say(format_args!(
        "{}: programmed, compared and started",
        elf.display()
    ));
    Ok(())
}

fn program(
    selector: &str,
    board: BoardName,
    elf: &Path,
    verbosity: Verbosity,
) -> Result<Session, Error> {
    let failed = |what: &str, error: &dyn std::error::Error| {
        let cause = chain(error);
        Error::Work(format!(
            "{what}: {cause}; the program on the board may be incomplete: flash it again"
        ))
    };
    let probe = find::open(selector)?;
    let session = probe.attach(board.board().chip, Permissions::default());
    let mut session = session.map_err(|error| failed("the core cannot be halted", &error))?;
    let loader = build_loader(&mut session, elf, ElfLoader(ElfOptions::default()), None);
    let loader = loader.map_err(|error| Error::file(elf, chain(&error)))?;
    let mut bars = Bars {
        verbosity,
        totals: [0; 3],
        now: None,
    };
    let mut options = DownloadOptions::new();
    options.verify = true;
    options.progress = FlashProgress::new(|event| bars.take(&event));
    let done = loader.commit(&mut session, options);
    done.map_err(|error| failed("programming", &error))?;
    Ok(session)
}

fn brown_out(session: &mut Session) -> Result<Level, Error> {
    let mut core = session.core(0).map_err(|error| lost(&error))?;
    core.halt(HALT).map_err(|error| lost(&error))?;
    let since = Instant::now();
    raise(&mut core, || since.elapsed() < OPTION_BYTES)
}

fn lost(error: &probe_rs::Error) -> Error {
    let cause = chain(error);
    Error::Work(format!(
        "the brown-out level may be as it was: {cause}; flash again"
    ))
}

impl Words for Core<'_> {
    fn read_word(&mut self, at: u32) -> Result<u32, Error> {
        self.read_word_32(at.into()).map_err(|error| lost(&error))
    }

    fn write_word(&mut self, at: u32, word: u32) -> Result<(), Error> {
        let written = self.write_word_32(at.into(), word);
        written
            .and_then(|()| self.flush())
            .map_err(|error| lost(&error))
    }
}

struct Bars {
    verbosity: Verbosity,
    totals: [u64; 3],
    now: Option<(usize, u64, Progress)>,
}

impl Bars {
    const NAMES: [&str; 3] = ["erasing", "programming", "comparing"];

    const fn step(operation: ProgressOperation) -> Option<usize> {
        match operation {
            ProgressOperation::Erase => Some(0),
            ProgressOperation::Program => Some(1),
            ProgressOperation::Verify => Some(2),
            ProgressOperation::Fill => None,
        }
    }

    fn take(&mut self, event: &ProgressEvent) {
        match event {
            ProgressEvent::AddProgressBar { operation, total } => {
                if let Some(step) = Self::step(*operation) {
                    self.totals[step] += total.unwrap_or(0);
                }
            }
            ProgressEvent::Progress {
                operation, size, ..
            } => {
                if let Some(step) = Self::step(*operation) {
                    self.progressed(step, *size);
                }
            }
            _ => {}
        }
    }

    fn progressed(&mut self, step: usize, size: u64) {
        let goes_on = self.now.take_if(|(at, ..)| *at == step);
        let (_, before, mut progress) = goes_on.unwrap_or_else(|| {
            // The bar of the step before ends first.
            self.now = None;
            let progress = Progress::new(self.verbosity, Self::NAMES[step], self.totals[step]);
            (step, 0, progress)
        });
        progress.set(before + size);
        self.now = Some((step, before + size, progress));
    }
}
