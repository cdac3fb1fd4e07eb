//! A terminal with the program in it.

use std::fs::File;
use std::io::{Read, Write};
use std::num::NonZero;
use std::os::fd::OwnedFd;
use std::process::{Child, Command};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, ioctl_tiocgptpeer, openpt, unlockpt};
use rustix::termios::{LocalModes, Termios, Winsize, tcgetattr, tcsetwinsize};
use vt100::Parser;

use crate::common::{Place, words};

const PATIENCE: Duration = Duration::from_secs(30);

pub(crate) struct Terminal {
    program: Child,
    keyboard: File,
    inside: OwnedFd,
    modes: Termios,
    seen: Arc<Mutex<Parser>>,
    reads: Arc<AtomicBool>,
}

impl Terminal {
    pub(crate) fn start(
        place: &Place,
        arguments: &str,
        (columns, rows): (u16, u16),
        environment: &[(&str, &str)],
    ) -> Self {
        let outside = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&outside).unwrap();
        unlockpt(&outside).unwrap();
        let inside = ioctl_tiocgptpeer(&outside, OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        let modes = tcgetattr(&inside).unwrap();
        size(&inside, columns, rows);
        let end = || inside.try_clone().unwrap();
        // The terminal is its own, so that it gets the signal of a new size.
        let program = Command::new("setsid")
            .arg("--ctty")
            .arg(env!("CARGO_BIN_EXE_whisker"))
            .args(words(arguments))
            .env_remove("NO_COLOR")
            .envs(environment.iter().copied())
            .env("TERM", "xterm-256color")
            .current_dir(place.path(""))
            .stdin(end())
            .stdout(end())
            .stderr(end())
            .spawn()
            .unwrap();
        let seen = Arc::new(Mutex::new(Parser::new(some(rows), some(columns), 0)));
        let reads = Arc::new(AtomicBool::new(true));
        let keyboard = File::from(outside);
        let mut screen = keyboard.try_clone().unwrap();
        let (parser, goes_on) = (seen.clone(), reads.clone());
        thread::spawn(move || {
            let mut bytes = [0; 4096];
            while goes_on.load(Ordering::Relaxed) {
                match screen.read(&mut bytes) {
                    Ok(count @ 1..) => parser.lock().unwrap().process(&bytes[..count]),
                    _ => return,
                }
            }
        });
        Self {
            program,
            keyboard,
            inside,
            modes,
            seen,
            reads,
        }
    }

    pub(crate) fn text(&self) -> String {
        format!("\n{}", self.seen.lock().unwrap().screen().contents())
    }

    pub(crate) fn line(&self, word: &str) -> String {
        let text = self.text();
        let line = text.lines().find(|line| line.contains(word));
        line.unwrap_or_else(|| panic!("{word}:\n{text}")).to_owned()
    }

    pub(crate) fn has_colour(&self) -> bool {
        let seen = self.seen.lock().unwrap();
        let (rows, columns) = seen.screen().size();
        let (rows, columns) = (rows.get(), columns.get());
        let mut cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        cells.any(|(row, column)| {
            let cell = seen.screen().cell(row, column).unwrap();
            cell.fgcolor() != vt100::Color::Default || cell.bgcolor() != vt100::Color::Default
        })
    }

    #[track_caller]
    pub(crate) fn wait_until(&mut self, is_so: impl Fn(&str) -> bool) {
        let begun = Instant::now();
        while !is_so(&self.text()) {
            assert!(begun.elapsed() < PATIENCE, "waited in vain:{}", self.text());
            thread::sleep(Duration::from_millis(5));
        }
    }

    #[track_caller]
    pub(crate) fn wait_for(&mut self, word: &str) {
        self.wait_until(|text| text.contains(word));
    }

    pub(crate) fn press(&mut self, keys: &[u8]) {
        self.keyboard.write_all(keys).unwrap();
    }

    pub(crate) fn resize(&mut self, columns: u16, rows: u16) {
        let mut seen = self.seen.lock().unwrap();
        seen.screen_mut().set_size(some(rows), some(columns));
        drop(seen);
        size(&self.inside, columns, rows);
    }

    pub(crate) fn stop_reading(&mut self) {
        self.reads.store(false, Ordering::Relaxed);
    }

    pub(crate) fn signal(&mut self, signal: Signal) {
        kill_process(Pid::from_child(&self.program), signal).unwrap();
    }

    pub(crate) fn ends(&mut self) -> Option<i32> {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.program.try_wait().unwrap() {
                // What it has written last is read.
                thread::sleep(Duration::from_millis(100));
                return status.code();
            }
            assert!(begun.elapsed() < PATIENCE, "it goes on:{}", self.text());
            thread::sleep(Duration::from_millis(5));
        }
    }

    fn now(&self) -> Termios {
        tcgetattr(&self.inside).unwrap()
    }

    /// Whether keys go to the program one by one, unseen.
    pub(crate) fn is_raw(&self) -> bool {
        let cooked = LocalModes::ECHO | LocalModes::ICANON | LocalModes::ISIG;
        !self.now().local_modes.intersects(cooked)
    }

    pub(crate) fn is_restored(&self) -> bool {
        let (now, before) = (self.now(), &self.modes);
        now.local_modes == before.local_modes
            && now.input_modes == before.input_modes
            && now.output_modes == before.output_modes
            && now.control_modes == before.control_modes
    }

    /// Whether the program has a screen of its own, what was there before being kept.
    pub(crate) fn is_alternate(&self) -> bool {
        self.seen.lock().unwrap().screen().alternate_screen()
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // It has ended already, unless a test has failed.
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

fn some(count: u16) -> NonZero<u16> {
    NonZero::new(count).unwrap()
}

fn size(terminal: &OwnedFd, columns: u16, rows: u16) {
    let size = Winsize {
        ws_row: rows,
        ws_col: columns,
        ws_xpixel: 0,
        ws_ypixel: 0,
    };
    tcsetwinsize(terminal, size).unwrap();
}
