//! Settings that are one of a few words, such as `integrator = "exact"`.
//!
//! One macro writes the enum together with its words, so that the words in the
//! catalogue, in the messages and in the reader are the same list.

/// Writes a public enum whose variants each have a word in the scene file.
macro_rules! choice {
    (
        $(#[$meta:meta])*
        $name:ident {
            $($(#[$variant_meta:meta])* $variant:ident = $word:literal),+ $(,)?
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $name {
            $($(#[$variant_meta])* $variant),+
        }

        impl $name {
            /// The words that a scene file may use, in the order of the variants.
            pub const NAMES: &'static [&'static str] = &[$($word),+];

            /// The word for this variant in a scene file.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $word),+
                }
            }

            /// The variant for a word of [`Self::NAMES`]; `None` for any other.
            pub fn from_name(word: &str) -> Option<Self> {
                match word {
                    $($word => Some(Self::$variant),)+
                    _ => None,
                }
            }
        }

        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

pub(crate) use choice;
