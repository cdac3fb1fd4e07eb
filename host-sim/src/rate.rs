//! Samples a second: by an option, by what stands above a recording, by a scene or a model. All
//! that say them must agree.

/// Samples a second of a recording of which nothing is said.
pub const USUAL_HZ: u32 = 2000;

/// Who says it, and what; none: it says nothing.
pub type Said = (String, Option<u32>);

/// The samples a second that all agree on; none: nobody says them.
///
/// # Errors
/// The first two that contradict each other.
pub fn agreed(said: impl IntoIterator<Item = Said>) -> Result<Option<u32>, String> {
    let mut first: Option<(String, u32)> = None;
    for (who, hz) in said {
        match (&first, hz) {
            (Some((other, before)), Some(hz)) if *before != hz => {
                return Err(format!("{other}: found {before}, {who} has {hz}"));
            }
            (None, Some(hz)) => first = Some((who, hz)),
            _ => {}
        }
    }
    Ok(first.map(|(_, hz)| hz))
}
