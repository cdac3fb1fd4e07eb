//! What of the history is looked at, and what each key does.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shows {
    Left,
    Right,
    Both,
    /// All whiskers of a head, from above.
    Head,
}

/// A key, whatever terminal it comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Key {
    Letter(char),
    Control(char),
    Tab,
    Escape,
    Back,
    Forward,
    PageBack,
    PageForward,
    First,
    Last,
}

/// What is to be done that is not a matter of looking.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Deed {
    Arm,
    Stop,
    /// Ends; the module goes on.
    Quit,
    StopAndQuit,
    Save,
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

/// What a key means that must not wait for a picture.
pub(crate) const fn deed(key: Key) -> Option<Deed> {
    Some(match key {
        Key::Letter('x' | 'X' | ' ') => Deed::Stop,
        Key::Letter('a') => Deed::Arm,
        Key::Letter('s') => Deed::Save,
        Key::Letter('q') => Deed::Quit,
        Key::Control('c') => Deed::StopAndQuit,
        _ => return None,
    })
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

    pub(crate) fn press(&mut self, key: Key, extent: Extent) {
        match key {
            Key::Letter('?' | 'h') => self.has_help = !self.has_help,
            Key::Escape => self.has_help = false,
            Key::Tab => {
                self.shows = match self.shows {
                    Shows::Left if extent.whiskers > 1 => Shows::Right,
                    Shows::Right => Shows::Both,
                    Shows::Left | Shows::Both if extent.has_head => Shows::Head,
                    Shows::Left | Shows::Both | Shows::Head => Shows::Left,
                };
            }
            Key::Letter('p') => {
                self.held = match self.held {
                    Some(_) => None,
                    None => Some(extent.now),
                };
            }
            Key::Letter('+' | '=') => self.span = self.span.saturating_sub(1),
            Key::Letter('-') => self.span = (self.span + 1).min(SPANS_S.len() - 1),
            Key::Back => self.go(extent, -0.2),
            Key::Forward => self.go(extent, 0.2),
            Key::PageBack => self.go(extent, -1.0),
            Key::PageForward => self.go(extent, 1.0),
            Key::First => self.go(extent, f64::NEG_INFINITY),
            Key::Last => self.go(extent, f64::INFINITY),
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
    use super::{Deed, Extent, Key, Shows, View, deed};

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
        view.press(Key::Back, EXTENT);
        assert_eq!(view.end(EXTENT), 101_000);
        view.press(Key::Letter('p'), EXTENT);
        let later = Extent {
            now: 150_000,
            ..EXTENT
        };
        assert_eq!(view.end(later), 101_000);
        view.press(Key::Back, later);
        assert_eq!(view.end(later), 100_000);
        view.press(Key::PageBack, later);
        assert_eq!(view.end(later), 95_000);
        view.press(Key::First, later);
        assert_eq!(view.end(later), 6000);
        view.press(Key::PageBack, later);
        assert_eq!(view.end(later), 6000);
        view.press(Key::Last, later);
        assert_eq!(view.end(later), 150_000);
        view.press(Key::First, later);
        // What was looked at is no longer there.
        let much_later = Extent {
            oldest: 50_000,
            now: 350_000,
            ..EXTENT
        };
        assert_eq!(view.end(much_later), 50_000);
        view.press(Key::Letter('p'), much_later);
        assert_eq!(view.end(much_later), 350_000);
    }

    #[test]
    fn a_head_is_shown_first_and_after_its_whiskers() {
        let head = Extent {
            has_head: true,
            ..EXTENT
        };
        let mut view = View::new(head);
        let mut seen = Vec::new();
        for _ in 0..4 {
            seen.push(view.shows);
            view.press(Key::Tab, head);
        }
        assert_eq!(seen, [Shows::Head, Shows::Left, Shows::Right, Shows::Both]);
        assert_eq!(view.shows, Shows::Head);
        let one = Extent {
            whiskers: 1,
            ..EXTENT
        };
        let mut view = View::new(one);
        view.press(Key::Tab, one);
        assert_eq!(view.shows, Shows::Left);
    }

    #[test]
    fn motors_are_stopped_by_the_keys_that_say_so() {
        let stops = |key| deed(key) == Some(Deed::Stop);
        assert!(stops(Key::Letter('x')) && stops(Key::Letter(' ')));
        assert_eq!(deed(Key::Control('c')), Some(Deed::StopAndQuit));
        assert_eq!(deed(Key::Letter('c')), None);
        assert_eq!(deed(Key::Letter('q')), Some(Deed::Quit));
    }
}
