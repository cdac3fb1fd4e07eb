//! Enums whose variants have a number that never changes its meaning, and a text.

/// An enum by a table of `Name = number: "text";`, with both ways between a variant and its number.
macro_rules! numbered {
    ($(#[doc = $doc:literal])+ $type:ident: $($name:ident = $code:literal: $text:literal;)*) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[repr(u8)]
        pub enum $type {
            $(#[doc = $text] $name = $code,)*
        }

        impl $type {
            /// Each of them.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// It in words.
            pub const fn text(self) -> &'static str {
                match self {
                    $(Self::$name => $text,)*
                }
            }

            /// Its number.
            pub const fn code(self) -> u8 {
                self as u8
            }

            /// That of a number.
            pub fn from_code(code: u8) -> Option<Self> {
                Self::ALL.iter().copied().find(|one| one.code() == code)
            }
        }

        impl core::fmt::Display for $type {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.text())
            }
        }
    };
}
pub(crate) use numbered;
