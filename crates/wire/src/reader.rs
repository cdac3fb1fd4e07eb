//! Reads postcard's format, so that little code is needed on a board.
//!
//! postcard's own reader may fail at each number, and what is derived for a structure asks after
//! each. This one reads zero beyond the end, or where a number is too large, and remembers that
//! ([`Reader::is_good`]), which takes half of the code (docs/decisions.md, record 5).

use serde::de::{
    DeserializeSeed, EnumAccess, Error, IntoDeserializer, SeqAccess, VariantAccess, Visitor,
};
use serde::{Deserialize, Deserializer};

/// What is left to read, and whether all was good.
pub struct Reader<'de> {
    bytes: &'de [u8],
    is_good: bool,
}

/// What is no value of its type.
#[derive(Debug, thiserror::Error)]
#[error("unreadable")]
pub struct Unreadable;

impl Error for Unreadable {
    fn custom<T: core::fmt::Display>(_: T) -> Self {
        Self
    }
}

impl<'de> Reader<'de> {
    /// Of a value's bytes, which may go on behind it.
    pub const fn new(bytes: &'de [u8]) -> Self {
        Self {
            bytes,
            is_good: true,
        }
    }

    /// Whether all that was read was there, and in range.
    pub const fn is_good(&self) -> bool {
        self.is_good
    }

    #[inline(never)]
    fn byte(&mut self) -> u8 {
        if let [first, rest @ ..] = self.bytes {
            self.bytes = rest;
            *first
        } else {
            self.is_good = false;
            0
        }
    }

    fn flag(&mut self) -> bool {
        let byte = self.byte();
        self.is_good &= byte < 2;
        byte == 1
    }

    fn below(&mut self, end: u32) -> u32 {
        let number = self.word();
        if number < end {
            number
        } else {
            self.is_good = false;
            0
        }
    }

    /// Seven bits a byte, the lowest first; the top bit says that more follow.
    #[inline(never)]
    fn word(&mut self) -> u32 {
        let word = self.long();
        if word > u64::from(u32::MAX) {
            self.is_good = false;
        }
        word as u32
    }

    #[inline(never)]
    fn long(&mut self) -> u64 {
        let mut long = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte();
            long |= u64::from(byte & 0x7F) << shift;
            if byte < 0x80 {
                return long;
            }
        }
        self.is_good = false;
        long
    }

    #[inline(never)]
    fn fixed(&mut self) -> u32 {
        let bytes = [(); 4].map(|()| self.byte());
        u32::from_le_bytes(bytes)
    }

    /// The bytes of a text, which may be of any, or of a list of bytes.
    #[inline(never)]
    pub fn slice(&mut self) -> &'de [u8] {
        let length = self.word() as usize;
        let (slice, rest) = self.bytes.split_at_checked(length).unwrap_or_else(|| {
            self.is_good = false;
            (&[], &[])
        });
        self.bytes = rest;
        slice
    }
}

/// A value, and what stands behind it. `None`: there is no such value.
pub(crate) fn take<'b, T: Deserialize<'b>>(bytes: &'b [u8]) -> Option<(T, &'b [u8])> {
    let mut reader = Reader::new(bytes);
    let value = T::deserialize(&mut reader).ok()?;
    reader.is_good.then_some((value, reader.bytes))
}

/// Signs alternate: 0, −1, 1, −2, …
const fn signed(word: u64) -> i64 {
    (word >> 1).cast_signed() ^ -(word & 1).cast_signed()
}

macro_rules! whole {
    ($($method:ident $visit:ident $type:ty: $read:expr;)+) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
            let read: fn(&mut Reader<'de>) -> $type = $read;
            visitor.$visit(read(self))
        }
    )+};
}

impl<'de> Deserializer<'de> for &mut Reader<'de> {
    type Error = Unreadable;

    whole! {
        deserialize_bool visit_bool bool: Reader::flag;
        deserialize_u8 visit_u8 u8: Reader::byte;
        deserialize_u16 visit_u16 u16: |reader| reader.below(1 << 16) as u16;
        deserialize_u32 visit_u32 u32: Reader::word;
        deserialize_u64 visit_u64 u64: Reader::long;
        deserialize_i16 visit_i16 i16: |reader| signed(reader.below(1 << 16).into()) as i16;
        deserialize_i32 visit_i32 i32: |reader| signed(reader.word().into()) as i32;
        deserialize_i64 visit_i64 i64: |reader| signed(reader.long());
        deserialize_f32 visit_f32 f32: |reader| f32::from_bits(reader.fixed());
        deserialize_f64 visit_f64 f64: |reader| {
            let low = u64::from(reader.fixed());
            f64::from_bits(low | u64::from(reader.fixed()) << 32)
        };
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        let text = str::from_utf8(self.slice()).map_err(|_| Unreadable)?;
        visitor.visit_borrowed_str(text)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        if self.flag() {
            visitor.visit_some(self)
        } else {
            visitor.visit_none()
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        let count = self.word();
        visitor.visit_seq(Counted(self, count))
    }

    fn deserialize_tuple<V: Visitor<'de>>(
        self,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        visitor.visit_seq(Fields(self))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        visitor.visit_seq(Fields(self))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        let index = self.below(variants.len() as u32);
        visitor.visit_enum(Variant(self, index))
    }

    // What no configuration has, or the format does not say.
    serde::forward_to_deserialize_any! {
        i8 char string bytes byte_buf unit unit_struct tuple_struct map identifier ignored_any
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Unreadable> {
        Err(Unreadable)
    }

    fn is_human_readable(&self) -> bool {
        false
    }
}

struct Fields<'r, 'de>(&'r mut Reader<'de>);

impl<'de> SeqAccess<'de> for Fields<'_, 'de> {
    type Error = Unreadable;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Unreadable> {
        seed.deserialize(&mut *self.0).map(Some)
    }
}

struct Counted<'r, 'de>(&'r mut Reader<'de>, u32);

impl<'de> SeqAccess<'de> for Counted<'_, 'de> {
    type Error = Unreadable;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Unreadable> {
        // A list without end would be read as zeros for as long as it says.
        if self.1 == 0 || !self.0.is_good {
            return Ok(None);
        }
        self.1 -= 1;
        seed.deserialize(&mut *self.0).map(Some)
    }
}

struct Variant<'r, 'de>(&'r mut Reader<'de>, u32);

impl<'de> EnumAccess<'de> for Variant<'_, 'de> {
    type Error = Unreadable;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Self), Unreadable> {
        let variant = seed.deserialize(self.1.into_deserializer())?;
        Ok((variant, self))
    }
}

impl<'de> VariantAccess<'de> for Variant<'_, 'de> {
    type Error = Unreadable;

    fn unit_variant(self) -> Result<(), Unreadable> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(
        self,
        seed: T,
    ) -> Result<T::Value, Unreadable> {
        seed.deserialize(self.0)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Unreadable> {
        visitor.visit_seq(Fields(self.0))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        visitor.visit_seq(Fields(self.0))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde::{Deserialize, Serialize};

    use super::take;

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    enum Kind {
        Alone,
        Of(u16, i32),
        Named { rate: f32 },
    }

    /// All that a configuration is made of.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Whole {
        name: heapless::String<8>,
        list: heapless::Vec<(u8, i16), 3>,
        kinds: [Option<Kind>; 2],
        seed: u64,
        wide: (f64, i64),
        small: (bool, u8, u32),
    }

    fn read(bytes: &[u8]) -> Option<(Whole, usize)> {
        take(bytes).map(|(whole, rest)| (whole, rest.len()))
    }

    fn kinds() -> impl Strategy<Value = Option<Kind>> {
        proptest::option::of(prop_oneof![
            Just(Kind::Alone),
            (any::<u16>(), any::<i32>()).prop_map(|(a, b)| Kind::Of(a, b)),
            any::<f32>().prop_map(|rate| Kind::Named { rate }),
        ])
    }

    proptest! {
        /// postcard wrote it.
        #[test]
        fn what_was_written_is_read_and_what_is_cut_off_is_not(
            name in "[a-z]{0,8}",
            list in proptest::collection::vec(any::<(u8, i16)>(), 0..4),
            kinds in [kinds(), kinds()],
            (seed, wide, small) in any::<(u64, (f64, i64), (bool, u8, u32))>(),
        ) {
            let name = name.as_str().try_into().unwrap();
            let list = list.into_iter().collect();
            let whole = Whole { name, list, kinds, seed, wide, small };
            let mut room = [0; 128];
            let bytes = postcard::to_slice(&whole, &mut room).unwrap();
            prop_assert_eq!(read(bytes), Some((whole, 0)));
            for length in 0..bytes.len() {
                prop_assert_eq!(read(&bytes[..length]), None);
            }
        }

        /// Of numbers with more bytes than they need it reads the longer ones too.
        #[test]
        fn what_postcard_reads_is_read(
            bytes in proptest::collection::vec(prop_oneof![3 => 0..3_u8, 1 => 0..0x80_u8], 64),
        ) {
            let found = postcard::take_from_bytes::<Whole>(&bytes).ok();
            prop_assert_eq!(read(&bytes), found.map(|(whole, rest)| (whole, rest.len())));
        }
    }
}
