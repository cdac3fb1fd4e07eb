//! The shape of a field: a name for each value, and its place in the register.

/// A field of a register: its values, and to and from the register's bits.
macro_rules! field {
    (
        $(#[$about:meta])*
        pub enum $name:ident at $shift:literal, mask $mask:literal {
            $($(#[$value_about:meta])* $value:ident = $bits:literal,)+
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(u16)]
        pub enum $name {
            $($(#[$value_about])* $value = $bits,)+
        }

        impl $name {
            /// Every value, in the order of their bits.
            pub const ALL: &[$name] = &[$($name::$value,)+];

            /// In its place in the register.
            #[inline]
            pub const fn bits(self) -> u16 {
                (self as u16) << $shift
            }

            /// The value that a register holds; `None` if it is none of these.
            pub const fn of(register: u16) -> Option<$name> {
                match (register & $mask) >> $shift {
                    $($bits => Some($name::$value),)+
                    _ => None,
                }
            }
        }
    };
}
