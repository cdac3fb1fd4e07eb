//! The terminal: taken, and given back whatever happens.

use std::io::{self, Stdout, Write};

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use crossterm::{cursor, execute, terminal};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;

use super::view::Key;

pub(crate) type Window = Terminal<CrosstermBackend<Stdout>>;

/// The terminal, for as long as this lives.
pub(crate) struct Screen;

impl Screen {
    /// Takes it; a panic anywhere gives it back before it is told.
    pub(crate) fn take() -> io::Result<(Self, Window)> {
        let told = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            give_back();
            told(panic);
        }));
        terminal::enable_raw_mode()?;
        let screen = Self;
        execute!(io::stdout(), terminal::EnterAlternateScreen, cursor::Hide)?;
        let window = Terminal::new(CrosstermBackend::new(io::stdout()))?;
        Ok((screen, window))
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        give_back();
    }
}

/// The modes first: to write may wait for a terminal that takes nothing.
fn give_back() {
    restore_modes();
    // Nothing can be done about a terminal that is gone.
    let _ = execute!(io::stdout(), terminal::LeaveAlternateScreen, cursor::Show);
    let _ = io::stdout().flush();
}

/// Echo and lines as they were; writes nothing.
pub(crate) fn restore_modes() {
    let _ = terminal::disable_raw_mode();
}

pub(crate) fn key(event: &KeyEvent) -> Option<Key> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let has_control = event.modifiers.contains(KeyModifiers::CONTROL);
    Some(match event.code {
        KeyCode::Char(letter) if has_control => Key::Control(letter.to_ascii_lowercase()),
        KeyCode::Char(letter) => Key::Letter(letter),
        KeyCode::Tab => Key::Tab,
        KeyCode::Esc => Key::Escape,
        KeyCode::Left => Key::Back,
        KeyCode::Right => Key::Forward,
        KeyCode::PageUp => Key::PageBack,
        KeyCode::PageDown => Key::PageForward,
        KeyCode::Home => Key::First,
        KeyCode::End => Key::Last,
        _ => return None,
    })
}
