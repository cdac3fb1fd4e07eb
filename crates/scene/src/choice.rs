//! Settings that are one of a few words, such as `integrator = "exact"`.
//!
//! One macro writes the enum together with its words, so that the words in the
//! declarations, in the messages and in the reader are the same list.

/// An enum whose variants each have a word in the scene file.
pub trait Choice: Sized {
    /// The words, in the order in which messages list them.
    const WORDS: &'static [&'static str];

    /// The variant for a word; `None` for a word that is not among them.
    fn of_word(word: &str) -> Option<Self>;
}

/// Gives an enum its words: a new one, or, after `for`, one of another crate.
macro_rules! choice {
    (for $name:ty { $($variant:ident = $word:literal),+ $(,)? }) => {
        impl crate::choice::Choice for $name {
            const WORDS: &'static [&'static str] = &[$($word),+];

            fn of_word(word: &str) -> Option<Self> {
                match word {
                    $($word => Some(Self::$variant),)+
                    _ => None,
                }
            }
        }
    };
    (
        $(#[$meta:meta])*
        $vis:vis enum $name:ident {
            $($(#[$variant_meta:meta])* $variant:ident = $word:literal),+ $(,)?
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        $vis enum $name {
            $($(#[$variant_meta])* $variant),+
        }

        impl $name {
            /// The word for this variant in a scene file.
            $vis const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $word),+
                }
            }
        }

        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.name())
            }
        }

        crate::choice::choice!(for $name { $($variant = $word),+ });
    };
}

pub(crate) use choice;
