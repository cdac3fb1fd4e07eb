//! Factors that are used together, in floats.

use serde::{Deserialize, Serialize};

use crate::{Bound, Bounded};

/// `K` factors that are used together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(
    serialize = "T: Serialize",
    deserialize = "T: Deserialize<'de> + Default + Copy"
))]
pub struct FactorRow<T, const K: usize>(
    /// The factors.
    #[serde(with = "array")]
    pub [T; K],
);

impl<T: Bounded, const K: usize> Bounded for FactorRow<T, K> {
    fn lies_within(&self, bound: Bound) -> bool {
        self.0.lies_within(bound)
    }
}

/// An array of any length as a tuple: serde itself knows arrays of some lengths only.
pub(super) mod array {
    use core::fmt;

    use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
    use serde::ser::{Serialize, SerializeTuple, Serializer};

    pub(in crate::real) fn serialize<S: Serializer, T: Serialize, const K: usize>(
        array: &[T; K],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(K)?;
        for entry in array {
            tuple.serialize_element(entry)?;
        }
        tuple.end()
    }

    pub(in crate::real) fn deserialize<'de, D, T, const K: usize>(
        deserializer: D,
    ) -> Result<[T; K], D::Error>
    where
        D: Deserializer<'de>,
        T: Deserialize<'de> + Default + Copy,
    {
        deserializer.deserialize_tuple(K, Entries([T::default(); K]))
    }

    struct Entries<T, const K: usize>([T; K]);

    impl<'de, T: Deserialize<'de> + Default + Copy, const K: usize> Visitor<'de> for Entries<T, K> {
        type Value = [T; K];

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "{K} entries")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<[T; K], A::Error> {
            let mut array = self.0;
            for (n, place) in array.iter_mut().enumerate() {
                let entry = entries.next_element()?;
                *place = entry.ok_or_else(|| Error::invalid_length(n, &self))?;
            }
            Ok(array)
        }
    }
}
