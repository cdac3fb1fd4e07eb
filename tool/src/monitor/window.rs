//! Who does what while a window is open: one listens, one reads the keyboard, one draws, and
//! one waits for signals. None waits for another's work: a terminal that takes no more
//! characters stops the drawing and nothing else.

use std::path::PathBuf;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossterm::event::{self, Event};
use crossterm::terminal;
use host_sim::origin::Origin;
use host_sim::{Error, report};
use ratatui::DefaultTerminal;

use super::draw::draw;
use super::save::Held;
use super::view::{View, saves, wish};
use super::watching::{Shared, Wish, joined, lock};
use crate::interrupt::on_signal;

const PICTURE: Duration = Duration::from_millis(50);

/// For how long the last picture may take, once all else has ended.
const LAST: Duration = Duration::from_millis(500);

/// For how long a message stays at the bottom, s.
const MESSAGE_S: f64 = 4.0;

pub(crate) struct About {
    pub(crate) title: String,
    pub(crate) origin: Origin,
    pub(crate) save: PathBuf,
}

/// Opens a window on what `listener` hears, until that has ended; `wishes` reach it.
pub(crate) fn open(
    shared: &Arc<Mutex<Shared>>,
    about: About,
    listener: JoinHandle<Result<(), Error>>,
    wishes: &Sender<Wish>,
) -> Result<(), Error> {
    let failed = |error: std::io::Error| Error::Work(format!("terminal: {error}"));
    // A panic anywhere gives the terminal back before it is said.
    let window = match ratatui::try_init() {
        Ok(window) => window,
        Err(error) => {
            let _ = ratatui::try_restore();
            // Who cannot see must not leave motors running.
            let _ = wishes.send(Wish::StopAndEnd);
            let _ = listener.join();
            return Err(failed(error));
        }
    };
    let signal = Arc::new(AtomicI32::new(0));
    let (come, stops) = (signal.clone(), wishes.clone());
    let waits = on_signal(move |number| {
        come.store(number, Ordering::Relaxed);
        let _ = stops.send(Wish::StopAndEnd);
    });
    let (look, looks) = mpsc::channel();
    let keys_wishes = wishes.clone();
    let ends = shared.clone();
    let watch = move || keyboard(&look, &keys_wishes, &ends);
    let keyboard = thread::Builder::new().name("keyboard".to_owned());
    let watched = keyboard.spawn(watch).map_err(failed);

    let (ended, drawing_ends) = mpsc::channel();
    let (drawn, draws_wishes) = (shared.clone(), wishes.clone());
    let drawing = thread::Builder::new()
        .name("drawing".to_owned())
        .spawn(move || {
            let done = pictures(window, &drawn, &about, &looks);
            if done.is_err() {
                let _ = draws_wishes.send(Wish::StopAndEnd);
            }
            // The receiver may be gone.
            let _ = ended.send(done);
        });
    let drawing = drawing.map_err(failed);
    if waits.is_err() || watched.is_err() || drawing.is_err() {
        let _ = wishes.send(Wish::StopAndEnd);
    }

    let ended = joined(listener);
    lock(shared).has_ended = true;
    let drawn = match drawing_ends.recv_timeout(LAST) {
        Ok(done) => done.map_err(failed),
        Err(RecvTimeoutError::Disconnected) => Err(Error::Work("drawing has failed".to_owned())),
        Err(RecvTimeoutError::Timeout) => {
            // The terminal takes nothing, so there is no way to say it.
            let _ = terminal::disable_raw_mode();
            std::process::exit(1);
        }
    };
    // Nothing can be done about a terminal that is gone.
    let _ = ratatui::try_restore();
    saved(shared);
    let ended_by = match signal.load(Ordering::Relaxed) {
        0 => Ok(()),
        signal => Err(format!("ended by signal {signal}; the motors were stopped")),
    };
    let ended = ended.and(waits).and(ended_by.map_err(Error::Work));
    ended.and(drawn).and(watched.and(drawing).map(drop))
}

/// Reads the keyboard; stopping does not wait for a picture.
fn keyboard(look: &Sender<Event>, wishes: &Sender<Wish>, shared: &Mutex<Shared>) {
    loop {
        let event = match event::poll(PICTURE) {
            Ok(false) => {
                if lock(shared).has_ended {
                    return;
                }
                continue;
            }
            Ok(true) => event::read(),
            Err(error) => Err(error),
        };
        let Ok(event) = event else {
            // No key can stop the motors any more.
            let _ = wishes.send(Wish::StopAndEnd);
            return;
        };
        if event.is_key_release() {
            continue;
        }
        if let Some(wish) = event.as_key_event().and_then(wish) {
            // Whoever listens no longer has stopped what was to be stopped.
            let _ = wishes.send(wish);
        }
        if look.send(event).is_err() {
            return;
        }
    }
}

fn pictures(
    mut window: DefaultTerminal,
    shared: &Arc<Mutex<Shared>>,
    about: &About,
    looks: &Receiver<Event>,
) -> std::io::Result<()> {
    let mut view = View::new(lock(shared).history.extent());
    loop {
        let begun = Instant::now();
        let (shown, has_ended) = {
            let shared = lock(shared);
            let now = shared.history.now();
            let lasts = shared.history.ticks_of(MESSAGE_S);
            let message = shared.message.as_ref();
            let message = message.filter(|(since, _)| now <= since + lasts);
            let message = message.map_or(String::new(), |(_, text)| text.clone());
            let shown = shared.history.shown(&view, &about.title, message);
            (shown, shared.has_ended)
        };
        window.draw(|frame| draw(frame, &shown))?;
        if has_ended {
            return Ok(());
        }
        // Keys are answered at once, and a picture is drawn in time without any.
        while let Ok(look) = looks.recv_timeout(PICTURE.saturating_sub(begun.elapsed())) {
            let Event::Key(key) = look else {
                break;
            };
            let extent = lock(shared).history.extent();
            view.press(key, extent);
            if saves(key) {
                save(shared, about);
            }
            if begun.elapsed() >= PICTURE / 2 {
                break;
            }
        }
        // A keyboard that is gone leaves its channel closed, which waits for nothing.
        thread::sleep((PICTURE / 2).saturating_sub(begun.elapsed()));
    }
}

fn save(shared: &Arc<Mutex<Shared>>, about: &About) {
    let held = Held::of(&lock(shared).history);
    let (path, origin, said) = (about.save.clone(), about.origin.clone(), shared.clone());
    let saving = thread::spawn(move || {
        let message = match held.write(&path, &origin) {
            Ok((path, records)) => format!("saved {}: {records} records", path.display()),
            Err(error) => format!("not saved: {error}"),
        };
        lock(&said).say(message.clone());
        message
    });
    lock(shared).saving.push(saving);
}

/// Waits for files that are still being written, and says what became of them.
fn saved(shared: &Mutex<Shared>) {
    let mut saving = std::mem::take(&mut lock(shared).saving);
    saving.retain(|saving| !saving.is_finished());
    for saving in saving {
        report::warn("a file is being saved: please wait");
        let failed = |_| "not saved".to_owned();
        report::warn(saving.join().unwrap_or_else(failed));
    }
}
