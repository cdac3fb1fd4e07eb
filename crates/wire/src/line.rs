//! A line of text that is put together without an allocator and without a panic.

/// Most bytes of a line, its end included.
pub const LINE_BYTES: usize = 240;

/// The end of every line: a terminal goes on at the left.
const END: [u8; 2] = *b"\r\n";

// Lines are rare and put together in many places: their parts stand in flash once.
/// A line of text; what does not fit is left out.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    bytes: [u8; LINE_BYTES],
    length: usize,
}

impl Line {
    /// An empty line.
    pub const fn new() -> Self {
        Self {
            bytes: [0; LINE_BYTES],
            length: 0,
        }
    }

    /// Appends a byte if it fits before the line's end: a question mark for a control character,
    /// whoever wrote it, as no text may end a line or begin another.
    #[inline(never)]
    fn put(&mut self, byte: u8) {
        let byte = if byte.is_ascii_control() { b'?' } else { byte };
        if self.length < LINE_BYTES - END.len()
            && let Some(place) = self.bytes.get_mut(self.length)
        {
            *place = byte;
            self.length += 1;
        }
    }

    /// Appends text.
    #[inline(never)]
    pub fn text(&mut self, text: &str) -> &mut Self {
        text.bytes().for_each(|byte| self.put(byte));
        self
    }

    /// Appends what somebody else has written: a question mark for what is not to be seen.
    #[inline(never)]
    pub fn shown(&mut self, bytes: &[u8]) -> &mut Self {
        for &byte in bytes {
            self.put(if byte.is_ascii_graphic() { byte } else { b'?' });
        }
        self
    }

    /// Appends a space and text.
    #[inline(never)]
    pub fn word(&mut self, text: &str) -> &mut Self {
        self.put(b' ');
        self.text(text)
    }

    /// Appends a space and a whole number.
    #[inline(never)]
    pub fn field(&mut self, number: u32) -> &mut Self {
        self.word("").number(number)
    }

    /// Appends a space and a whole number with its sign, if it is negative.
    #[inline(never)]
    pub fn signed(&mut self, number: i32) -> &mut Self {
        self.word(if number < 0 { "-" } else { "" })
            .number(number.unsigned_abs())
    }

    /// Appends a whole number.
    #[inline(never)]
    pub fn number(&mut self, number: u32) -> &mut Self {
        self.digits(number, 1, 10)
    }

    /// Appends at least so many digits to this base, 10 or 16.
    #[inline(never)]
    fn digits(&mut self, number: u32, least: usize, base: u32) -> &mut Self {
        // The last first.
        let mut digits = [b'0'; 10];
        let (mut rest, mut count) = (number, 0);
        for digit in &mut digits {
            let value = (rest % base) as u8;
            *digit = value + if value < 10 { b'0' } else { b'a' - 10 };
            rest /= base;
            count += 1;
            if rest == 0 && count >= least {
                break;
            }
        }
        digits
            .iter()
            .take(count)
            .rev()
            .for_each(|&digit| self.put(digit));
        self
    }

    /// Appends a text with its fields in the places of what stands in braces, as defmt's texts
    /// have them: `{=u32}`, `{=u32:04}` for at least so many digits, `{=u32:08x}` for them to the
    /// base of 16.
    #[inline(never)]
    pub fn form(&mut self, text: &str, fields: &[Field<'_>]) -> &mut Self {
        let mut fields = fields.iter();
        let (mut is_hint, mut least, mut base) = (false, 1, 10);
        for byte in text.bytes() {
            match byte {
                b'{' => (is_hint, least, base) = (true, 1, 10),
                b'}' => {
                    is_hint = false;
                    self.fill_in(fields.next(), least, base);
                }
                b'x' if is_hint => base = 16,
                // A hint of 1 is none: digits of a type's name are passed over.
                b':' if is_hint => least = 0,
                _ if is_hint && least != 1 => least = usize::from(byte.wrapping_sub(b'0')),
                _ if is_hint => {}
                _ => self.put(byte),
            }
        }
        self
    }

    fn fill_in(&mut self, field: Option<&Field<'_>>, least: usize, base: u32) {
        match field {
            Some(Field::Text(text)) => self.text(text),
            Some(Field::Number(number)) => self.digits(*number, least, base),
            Some(Field::Signed(number)) => {
                self.text(if *number < 0 { "-" } else { "" });
                self.digits(number.unsigned_abs(), least, base)
            }
            None => self,
        };
    }

    /// The line with its end.
    #[inline(never)]
    pub fn ended(&mut self) -> &[u8] {
        let rest = self.bytes.get_mut(self.length..).unwrap_or_default();
        for (place, byte) in rest.iter_mut().zip(END) {
            *place = byte;
        }
        let length = self.length + END.len();
        self.bytes.get(..length).unwrap_or_default()
    }
}

/// What stands in the place of a pair of braces.
#[derive(Debug, Clone, Copy)]
pub enum Field<'t> {
    /// Text.
    Text(&'t str),
    /// A whole number.
    Number(u32),
    /// One with its sign, if it is negative.
    Signed(i32),
}

impl<'t> From<&'t str> for Field<'t> {
    fn from(text: &'t str) -> Self {
        Self::Text(text)
    }
}

impl From<u8> for Field<'_> {
    fn from(number: u8) -> Self {
        Self::Number(number.into())
    }
}

impl From<u16> for Field<'_> {
    fn from(number: u16) -> Self {
        Self::Number(number.into())
    }
}

impl From<u32> for Field<'_> {
    fn from(number: u32) -> Self {
        Self::Number(number)
    }
}

impl From<i16> for Field<'_> {
    fn from(number: i16) -> Self {
        Self::Signed(number.into())
    }
}

impl Default for Line {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{LINE_BYTES, Line};

    fn text(line: &mut Line) -> String {
        String::from_utf8(line.ended().to_vec()).expect("text")
    }

    proptest! {
        #[test]
        fn numbers_are_written_as_std_writes_them(number: u32, signed: i16) {
            let mut line = Line::new();
            let fields = [number.into(), signed.into(), number.into(), number.into()];
            line.form("{=u32} {=i16} {=u32:04} {=u32:08x}", &fields);
            let expected = format!("{number} {signed} {number:04} {number:08x}\r\n");
            prop_assert_eq!(text(&mut line), expected);
        }
    }

    #[test]
    fn fields_stand_where_braces_stood() {
        let mut line = Line::new();
        let fields = ["left".into(), 7_u8.into(), 42_u32.into(), (-5_i16).into()];
        line.form("{=str} {=u8}.{=u32:04} %, {=i16}!{=str}", &fields);
        assert_eq!(text(&mut line), "left 7.0042 %, -5!\r\n");
    }

    #[test]
    fn no_text_ends_a_line() {
        let mut line = Line::new();
        line.text("a\r\nok stop").word("\u{1b}[2J\u{7f}");
        line.form("{=str}\n", &["b\n".into()]);
        assert_eq!(text(&mut line), "a??ok stop ?[2J?b??\r\n");
    }

    #[test]
    fn what_does_not_fit_is_cut_and_the_line_ends_all_the_same() {
        let mut line = Line::new();
        line.text(&"a".repeat(2 * LINE_BYTES)).number(7);
        let found = text(&mut line);
        assert_eq!(found.len(), LINE_BYTES);
        assert!(found.ends_with("aa\r\n"));
        // Asked for twice it is the same.
        assert_eq!(text(&mut line), found);
    }
}
