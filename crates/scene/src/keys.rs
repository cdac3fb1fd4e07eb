//! The macro in which the sections of a scene are declared.

/// Writes a struct, the list of its keys and their reader from one declaration.
///
/// ```text
/// keys! {
///     /// Documentation of the struct.
///     pub struct Example {
///         /// Meaning of the key, here and on the reference page.
///         tau_s: f64 = number(1e-6..=1e5).unit("s"),
///
///         /// A key that has no field: the reader of another field takes it.
///         (threshold): f64 = between(0.0, 1.0),
///
///         /// Some keys of the same table: there when all of them are.
///         ..obstacle: Option<Obstacles>,
///
///         /// A table of the file; only in `Scene`.
///         [rcp]: Option<GateSettings> = optional::<Rcp>("contact gates nothing"),
///     }
/// }
/// ```
///
/// A field is called as its key. With `pub(crate) Rcp fills GateSettings` in
/// place of `pub struct Example` the keys are read into a struct that is there
/// already, and the name is that of the list.
macro_rules! keys {
    ($(#[$about:meta])+ pub struct $name:ident { $($body:tt)+ }) => {
        keys! { @next {$(#[$about])+ struct $name} from [] [] [] [] $($body)+ }
    };
    ($(#[$about:meta])+ pub(crate) $name:ident fills $filled:ident { $($body:tt)+ }) => {
        keys! { @next {$(#[$about])+ $name fills $filled} from [] [] [] [] $($body)+ }
    };

    // A key with a field.
    (@next $head:tt $from:ident
        [$($fields:tt)*] [$($entries:tt)*] [$($tables:tt)*] [$($values:tt)*]
        $(#[doc = $meaning:literal])+ $field:ident: $type:ty = $key:expr, $($rest:tt)*
    ) => {
        keys! { @next $head $from
            [$($fields)*
                $(#[doc = $meaning])+
                #[doc = concat!("\n\nKey `", stringify!($field), "`: `", stringify!($key), "`.")]
                pub $field: $type,
            ]
            [$($entries)* crate::section::Entry::Key(
                crate::key::Key::<$type>::row($key, stringify!($field), concat!($($meaning),+))
            ),]
            [$($tables)*]
            [$($values)* $field: $from.get(stringify!($field))?,]
            $($rest)*
        }
    };
    // A key without a field.
    (@next $head:tt $from:ident
        $fields:tt [$($entries:tt)*] $tables:tt $values:tt
        $(#[doc = $meaning:literal])+ ($key_name:ident): $type:ty = $key:expr, $($rest:tt)*
    ) => {
        keys! { @next $head $from
            $fields
            [$($entries)* crate::section::Entry::Key(
                crate::key::Key::<$type>::row($key, stringify!($key_name), concat!($($meaning),+))
            ),]
            $tables $values $($rest)*
        }
    };
    // More keys of the same table.
    (@next $head:tt $from:ident
        [$($fields:tt)*] [$($entries:tt)*] $tables:tt [$($values:tt)*]
        $(#[doc = $meaning:literal])+ ..$field:ident: Option<$keys:ident>, $($rest:tt)*
    ) => {
        keys! { @next $head $from
            [$($fields)* $(#[doc = $meaning])+ pub $field: Option<$keys>,]
            [$($entries)* crate::section::Entry::Keys(<$keys as crate::table::Keys>::ENTRIES),]
            $tables
            [$($values)* $field: <$keys as crate::table::Keys>::read($from),]
            $($rest)*
        }
    };
    // A table.
    (@next $head:tt $from:ident
        [$($fields:tt)*] $entries:tt [$($tables:tt)*] [$($values:tt)*]
        $(#[doc = $meaning:literal])+ [$field:ident]: $type:ty = $table:expr, $($rest:tt)*
    ) => {
        keys! { @next $head $from
            [$($fields)* $(#[doc = $meaning])+ pub $field: $type,]
            $entries
            [$($tables)* crate::table::Table::<$type>::section(
                &$table, stringify!($field), concat!($($meaning),+)
            ),]
            [$($values)* $field: crate::table::Table::<$type>::read(
                &$table, $from.values, stringify!($field)
            )?,]
            $($rest)*
        }
    };

    // All is sorted: write it.
    (@next {$(#[$about:meta])+ struct $name:ident} $from:ident
        [$($fields:tt)*] $entries:tt $tables:tt $values:tt
    ) => {
        $(#[$about])+
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name { $($fields)* }

        keys! { @impl $name, $name, $from, $entries $tables $values }
    };
    (@next {$(#[$about:meta])+ $name:ident fills $filled:ident} $from:ident
        $fields:tt $entries:tt $tables:tt $values:tt
    ) => {
        $(#[$about])+
        pub(crate) enum $name {}

        keys! { @impl $name, $filled, $from, $entries $tables $values }
    };
    (@impl $name:ident, $value:ident, $from:ident,
        [$($entries:tt)*] [$($tables:tt)*] [$($values:tt)*]
    ) => {
        impl crate::table::Keys for $name {
            type Value = $value;
            const ENTRIES: &'static [crate::section::Entry] = &[$($entries)*];
            const TABLES: &'static [crate::section::Section] = &[$($tables)*];

            fn read($from: crate::values::Part<'_>) -> Option<$value> {
                Some($value { $($values)* })
            }
        }
    };
}

pub(crate) use keys;
