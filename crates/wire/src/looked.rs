//! How a whisker is, by one answer.

use crate::Flags;

/// A whisker as [`Command::Look`](crate::Command::Look) is answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Looked {
    /// Where it is by its encoder: protraction, Q13.
    pub measured: i16,
    /// Contact π, 0 to 1: Q13.
    pub contact: i16,
    /// Flags, as in a record.
    pub flags: Flags,
    /// How often it has decided: 0 never, after 255 comes 1.
    pub decisions: u8,
    /// Which class it has named last; `None`: it has decided that it does not know.
    pub class: Option<u8>,
}

impl Looked {
    /// As the values of an answer.
    pub const fn values(self) -> [i32; 2] {
        let class = match self.class {
            Some(class) => class.saturating_add(1),
            None => 0,
        };
        let [a, b] = self.measured.to_le_bytes();
        let [c, d] = self.contact.to_le_bytes();
        let [e, f] = self.flags.bits().to_le_bytes();
        [
            i32::from_le_bytes([a, b, c, d]),
            i32::from_le_bytes([e, f, class, self.decisions]),
        ]
    }

    /// Of the values of an answer.
    pub const fn of([first, second]: [i32; 2]) -> Self {
        let [a, b, c, d] = first.to_le_bytes();
        let [e, f, class, decisions] = second.to_le_bytes();
        Self {
            measured: i16::from_le_bytes([a, b]),
            contact: i16::from_le_bytes([c, d]),
            flags: Flags::from_bits(u16::from_le_bytes([e, f])),
            decisions,
            class: class.checked_sub(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Looked;

    #[test]
    fn an_answer_lies_where_the_page_says() {
        let values = [0x0403_0201, 0x0807_0605];
        let looked = Looked::of(values);
        assert_eq!([looked.measured, looked.contact], [0x0201, 0x0403]);
        assert_eq!(looked.flags.bits(), 0x0605);
        assert_eq!((looked.class, looked.decisions), (Some(6), 8));
        assert_eq!(looked.values(), values);
        assert_eq!(Looked::of([0, 0]), Looked::default());
        assert_eq!(Looked::of([-1, 0]).measured, -1);
    }
}
