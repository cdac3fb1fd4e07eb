//! A part of the module as Rust source.

use databake::{TokenStream, quote};
use whisking::Source;

/// The types, constants and start of motion or perception, and its settings.
pub(crate) struct Part {
    pub(crate) items: Vec<TokenStream>,
    pub(crate) config: Source,
}

/// Settings of a part that is left out.
pub(crate) fn nothing() -> Source {
    Source {
        of_type: quote! { () },
        value: quote! { () },
    }
}
