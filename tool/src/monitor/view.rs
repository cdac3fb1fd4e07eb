//! What of the history is looked at, and what each key does.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::watching::Wish;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shows {
    Left,
    Right,
    Both,
    Head,
}

pub(crate) const KEYS: [(&str, &str); 10] = [
    ("x, space", "stop: motors off until they are armed"),
    ("a", "arm: motors may be driven"),
    ("Ctrl-C", "stop, then end"),
    ("q", "end; the module goes on as it is"),
    ("Tab", "left, right, both whiskers; the head"),
    ("p", "pause: hold the picture; recording goes on"),
    ("arrows, PgUp, PgDn", "paused: back and forth; Home, End"),
    ("+, -", "a shorter, a longer time"),
    ("s", "save the last minutes to a file"),
    ("?", "this list, and back"),
];

const SPANS_S: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 30.0, 60.0];

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct View {
    pub(crate) shows: Shows,
    /// The last tick that is shown while the picture is held.
    pub(crate) held: Option<u64>,
    pub(crate) has_help: bool,
    span: usize,
}

/// The ticks that there are to look at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent {
    pub(crate) oldest: u64,
    pub(crate) now: u64,
    pub(crate) tick_hz: u32,
    pub(crate) whiskers: usize,
    pub(crate) has_head: bool,
}

const fn is_control(key: KeyEvent) -> bool {
    matches!(key.code, KeyCode::Char(_)) && key.modifiers.contains(KeyModifiers::CONTROL)
}

/// What a key means that must not wait for a picture.
pub(crate) const fn wish(key: KeyEvent) -> Option<Wish> {
    Some(match (key.code, is_control(key)) {
        (KeyCode::Char('x' | 'X' | ' '), false) => Wish::Stop,
        (KeyCode::Char('a'), false) => Wish::Arm,
        (KeyCode::Char('q'), false) => Wish::End,
        (KeyCode::Char('c' | 'C'), true) => Wish::StopAndEnd,
        _ => return None,
    })
}

pub(crate) const fn saves(key: KeyEvent) -> bool {
    matches!(key.code, KeyCode::Char('s')) && !is_control(key)
}

impl View {
    pub(crate) const fn new(extent: Extent) -> Self {
        Self {
            shows: if extent.has_head {
                Shows::Head
            } else {
                Shows::Left
            },
            held: None,
            has_help: false,
            span: 2,
        }
    }

    pub(crate) const fn span_s(&self) -> f64 {
        SPANS_S[self.span]
    }

    pub(crate) const fn sides(&self) -> &'static [usize] {
        match self.shows {
            Shows::Left | Shows::Head => &[0],
            Shows::Right => &[1],
            Shows::Both => &[0, 1],
        }
    }

    pub(crate) fn end(&self, extent: Extent) -> u64 {
        let held = self.held.unwrap_or(extent.now);
        held.clamp(extent.oldest.min(extent.now), extent.now)
    }

    pub(crate) fn press(&mut self, key: KeyEvent, extent: Extent) {
        match key.code {
            _ if is_control(key) => {}
            KeyCode::Char('?' | 'h') => self.has_help = !self.has_help,
            KeyCode::Esc => self.has_help = false,
            KeyCode::Tab => {
                self.shows = match self.shows {
                    Shows::Left if extent.whiskers > 1 => Shows::Right,
                    Shows::Right => Shows::Both,
                    Shows::Left | Shows::Both if extent.has_head => Shows::Head,
                    Shows::Left | Shows::Both | Shows::Head => Shows::Left,
                };
            }
            KeyCode::Char('p') => self.held = self.held.xor(Some(extent.now)),
            KeyCode::Char('+' | '=') => self.span = self.span.saturating_sub(1),
            KeyCode::Char('-') => self.span = (self.span + 1).min(SPANS_S.len() - 1),
            KeyCode::Left => self.go(extent, -0.2),
            KeyCode::Right => self.go(extent, 0.2),
            KeyCode::PageUp => self.go(extent, -1.0),
            KeyCode::PageDown => self.go(extent, 1.0),
            KeyCode::Home => self.go(extent, f64::NEG_INFINITY),
            KeyCode::End => self.go(extent, f64::INFINITY),
            _ => {}
        }
    }

    fn go(&mut self, extent: Extent, pictures: f64) {
        if self.held.is_none() {
            return;
        }
        let span = self.span_s() * f64::from(extent.tick_hz);
        // The first picture begins with the oldest record.
        let first = (extent.oldest as f64 + span).min(extent.now as f64);
        let end = self.end(extent) as f64 + pictures * span;
        self.held = Some(end.clamp(first, extent.now as f64).round() as u64);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXTENT: Extent = Extent {
        oldest: 1000,
        now: 101_000,
        tick_hz: 1000,
        whiskers: 2,
        has_head: false,
    };

    #[test]
    fn a_held_picture_stays_and_is_moved_within_what_is_held() {
        let mut view = View::new(EXTENT);
        view.press(KeyCode::Left.into(), EXTENT);
        assert_eq!(view.end(EXTENT), 101_000);
        view.press(KeyCode::Char('p').into(), EXTENT);
        let extent = |oldest, now| Extent {
            oldest,
            now,
            ..EXTENT
        };
        let later = extent(1000, 150_000);
        assert_eq!(view.end(later), 101_000);
        for (key, end) in [
            (KeyCode::Left, 100_000),
            (KeyCode::PageUp, 95_000),
            (KeyCode::Home, 6000),
            (KeyCode::PageUp, 6000),
            (KeyCode::End, 150_000),
            (KeyCode::Home, 6000),
        ] {
            view.press(key.into(), later);
            assert_eq!(view.end(later), end, "{key}");
        }
        // What was looked at is no longer there.
        let much_later = extent(50_000, 350_000);
        assert_eq!(view.end(much_later), 50_000);
        view.press(KeyCode::Char('p').into(), much_later);
        assert_eq!(view.end(much_later), 350_000);
    }

    #[test]
    fn a_head_is_shown_first_and_after_its_whiskers() {
        let has_head = true;
        let head = Extent { has_head, ..EXTENT };
        let mut view = View::new(head);
        let mut seen = Vec::new();
        for _ in 0..4 {
            seen.push(view.shows);
            view.press(KeyCode::Tab.into(), head);
        }
        assert_eq!(seen, [Shows::Head, Shows::Left, Shows::Right, Shows::Both]);
        assert_eq!(view.shows, Shows::Head);
        let whiskers = 1;
        let one = Extent { whiskers, ..EXTENT };
        let mut view = View::new(one);
        view.press(KeyCode::Tab.into(), one);
        assert_eq!(view.shows, Shows::Left);
    }

    #[test]
    fn motors_are_stopped_by_the_keys_that_say_so() {
        for key in ['x', 'X', ' '] {
            assert_eq!(wish(KeyCode::Char(key).into()), Some(Wish::Stop));
        }
        let control = |letter| KeyEvent::new(KeyCode::Char(letter), KeyModifiers::CONTROL);
        assert_eq!(wish(control('c')), Some(Wish::StopAndEnd));
        assert_eq!(wish(control('x')), None);
        assert_eq!(wish(KeyCode::Char('c').into()), None);
        assert_eq!(wish(KeyCode::Char('q').into()), Some(Wish::End));
    }
}
