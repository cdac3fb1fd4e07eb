//! Programming a board's flash.

use std::path::Path;

use host_sim::progress::{Progress, Verbosity};
use host_sim::{Error, report};
use probe_rs::Permissions;
use probe_rs::flashing::{
    DownloadOptions, ElfLoader, ElfOptions, FlashProgress, ProgressEvent, ProgressOperation,
    build_loader,
};
use wire::Command;

use super::behind::Behind;
use super::find;
use super::memory::{MemoryPort, chain};
use crate::conversation::Conversation;
use crate::source::{BoardName, Laying};

/// Stops the motors of what runs there, programs the ELF file, compares it, and resets the chip.
pub(crate) fn flash(
    selector: &str,
    board: BoardName,
    elf: &Path,
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
    program(selector, board, elf, verbosity)?;
    // Last, and by the memory port: letting go of the core halts it once more.
    MemoryPort::of(find::open(selector)?)?.reset()?;
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
) -> Result<(), Error> {
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
    let mut bars = Bars::new(verbosity);
    let mut options = DownloadOptions::new();
    options.verify = true;
    options.progress = FlashProgress::new(|event| bars.take(&event));
    let done = loader.commit(&mut session, options);
    done.map_err(|error| failed("programming", &error))
}

struct Bars {
    verbosity: Verbosity,
    totals: [u64; 3],
    now: Option<(usize, u64, Progress)>,
}

impl Bars {
    const NAMES: [&str; 3] = ["erasing", "programming", "comparing"];

    const fn new(verbosity: Verbosity) -> Self {
        Self {
            verbosity,
            totals: [0; 3],
            now: None,
        }
    }

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
