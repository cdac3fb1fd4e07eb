//! `whisker board`: an emulated board whose serial port is a pseudo-terminal.

use std::ffi::{CString, OsStr};
use std::io::ErrorKind;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

use clap::Args;
use emulator::session::Session;
use host_sim::loaded::Loaded;
use host_sim::{Error, report};
use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use rustix::pty::OpenptFlags;

use crate::source::{BoardName, Flash, build, texture};
use crate::typed::Typed;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene, whose telemetry has a serial_baud
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// The program's file, which has the scene with it; without it it is built (minutes, the
    /// first time)
    #[arg(long, value_name = "ELF", conflicts_with = "board")]
    program: Option<PathBuf>,
    /// The board whose program is built
    #[arg(long, value_enum, default_value = "nucleo-f446re")]
    board: BoardName,
    /// The scene in whose world the board is: what it meets, for how long, and the seed
    #[arg(long, value_name = "SCENE")]
    world: Option<PathBuf>,
    /// The file that keeps what is deployed to the board, scenes and models, as a board does; made
    /// where there is none
    #[arg(long, value_name = "FILE")]
    flash: Option<PathBuf>,
    /// What befalls it: a file of events, as docs/boards.md lists them
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// A name for the terminal, whose own is another each time: a symbolic link, which replaces
    /// another and nothing else
    #[arg(long, value_name = "PATH")]
    link: Option<PathBuf>,
}

/// Bytes that wait for whoever has the terminal open, at most.
const MOST_WAITING: usize = 1 << 20;

struct Terminal {
    master: OwnedFd,
    path: CString,
    /// What finds no room yet.
    waiting: Vec<u8>,
}

fn wrong(error: Errno) -> Error {
    Error::Work(format!("pseudo-terminal: {error}"))
}

impl Terminal {
    fn open() -> Result<Self, Error> {
        let master = rustix::pty::openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY);
        let master = master.map_err(wrong)?;
        rustix::pty::grantpt(&master).map_err(wrong)?;
        rustix::pty::unlockpt(&master).map_err(wrong)?;
        let path = rustix::pty::ptsname(&master, Vec::new()).map_err(wrong)?;
        rustix::io::ioctl_fionbio(&master, true).map_err(wrong)?;
        // Opened and closed: from now on it says whether somebody is there.
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
        drop(rustix::fs::open(&path, flags, Mode::empty()).map_err(wrong)?);
        Ok(Self {
            master,
            path,
            waiting: Vec::new(),
        })
    }

    /// Has a symbolic link at `link` lead here, in place of one that is there.
    fn link(&self, link: &Path) -> Result<(), Error> {
        let wrong = |error| Error::file(link, error);
        match std::fs::symlink_metadata(link) {
            Ok(there) if there.is_symlink() => std::fs::remove_file(link).map_err(wrong)?,
            Ok(_) => return Err(Error::file(link, "is there, and no symbolic link")),
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(wrong(error)),
        }
        let path = OsStr::from_bytes(self.path.as_bytes());
        std::os::unix::fs::symlink(path, link).map_err(wrong)
    }

    /// Sends what the board says to the port, if it is open, and returns what was written to it.
    fn exchange(&mut self, said: &[u8]) -> Result<Vec<u8>, Error> {
        let mut received = vec![0; 1024];
        match rustix::io::read(&self.master, &mut received) {
            Ok(count) => received.truncate(count),
            Err(Errno::AGAIN) => received.clear(),
            // No program has it open.
            Err(Errno::IO) => {
                self.waiting.clear();
                return Ok(Vec::new());
            }
            Err(error) => return Err(wrong(error)),
        }
        self.waiting.extend(said);
        if self.waiting.len() > MOST_WAITING {
            // Too much for any reader.
            self.waiting.clear();
        }
        match rustix::io::write(&self.master, &self.waiting) {
            Ok(count) => drop(self.waiting.drain(..count)),
            Err(Errno::AGAIN | Errno::IO) => {}
            Err(error) => return Err(wrong(error)),
        }
        Ok(received)
    }
}

pub(crate) fn board(arguments: &Arguments) -> Result<(), Error> {
    let path = &arguments.scene;
    let mut loaded = Loaded::new(path)?;
    if let Some(world) = &arguments.world {
        loaded = loaded.in_world(world)?;
    }
    let scene = &loaded.scene;
    let Some(baud) = scene.telemetry.serial_baud else {
        let fault = "it has no serial port; allowed: [telemetry] serial_baud, such as 115200";
        return Err(Error::file(path, fault));
    };
    let program = match &arguments.program {
        Some(program) => program.clone(),
        None => build(arguments.board, path)?,
    };
    let mut flash = Flash::open(arguments.flash.as_deref())?;
    let mut session = Session::flashed(scene, &program, flash.contents())?;
    if flash.contents().is_empty() {
        flash.store(&session.flash()?)?;
    }
    // Whoever deploys a scene has the board start again.
    session.bear_resets(true);
    if let Some(scenario) = &arguments.scenario {
        session.befall(scenario, scene)?;
    }
    let mut terminal = Terminal::open()?;
    if let Some(link) = &arguments.link {
        terminal.link(link)?;
    }
    report::say(format_args!("{} {baud}", terminal.path.to_string_lossy()));
    report::warn("lines `lay NAME` lay a texture before the whisker; Ctrl-C ends it");
    let commands = Typed::at_standard_input();
    loop {
        session.tick()?;
        if session.was_reset() {
            report::warn("the board was reset");
            flash.store(&session.flash()?)?;
        }
        let received = terminal.exchange(&session.serial_read())?;
        if !received.is_empty() {
            session.serial_write(&received);
        }
        while let Ok(Some(line)) = commands.line() {
            let laid = match line.split_whitespace().collect::<Vec<_>>()[..] {
                ["lay", name] => texture(name, scene, "").map(|found| session.lay(found)),
                [] => Ok(()),
                _ => Err(Error::Input(format!("found {line:?}, allowed: lay NAME"))),
            };
            if let Err(error) = laid {
                report::warn(error);
            }
        }
    }
}
