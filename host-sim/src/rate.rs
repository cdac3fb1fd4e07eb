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
    let mut said = said.into_iter().filter_map(|(who, hz)| Some((who, hz?)));
    let Some((first, hz)) = said.next() else {
        return Ok(None);
    };
    match said.find(|(_, other)| *other != hz) {
        Some((who, other)) => Err(format!("{first}: found {hz}, {who} has {other}")),
        None => Ok(Some(hz)),
    }
}

/// What a recording is taken for that does not say its samples a second, where its model was trained at
/// other than the usual ones.
pub fn assumed((model, trained): &Said, (recording, said): &Said) -> Option<String> {
    let hz = trained.filter(|hz| said.is_none() && *hz != USUAL_HZ)?;
    Some(format!(
        "{recording} is not said, and taken as {hz}, as {model} has it"
    ))
}

/// Whether recordings can be taken together of which nothing but themselves says the samples a
/// second: all say them, or those that do say the usual ones.
///
/// # Errors
/// One that says others, and the first that does not say them.
pub fn complete(recordings: &[Said]) -> Result<(), String> {
    let other = recordings
        .iter()
        .find(|(_, hz)| hz.is_some_and(|hz| hz != USUAL_HZ));
    let silent = recordings.iter().find(|(_, hz)| hz.is_none());
    match (other, silent) {
        (Some((other, Some(hz))), Some((silent, _))) => Err(format!(
            "{other} is {hz}, {silent} is not said; say what both have by --rate"
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_says_nothing_goes_with_the_usual_rate_alone() {
        let said =
            |hz: &[Option<u32>]| hz.iter().map(|hz| (String::new(), *hz)).collect::<Vec<_>>();
        assert!(complete(&said(&[None, Some(USUAL_HZ), None])).is_ok());
        assert!(complete(&said(&[Some(1000), Some(1000)])).is_ok());
        assert!(complete(&said(&[None, Some(1000)])).is_err());
        let assumed = |trained, said| assumed(&(String::new(), trained), &(String::new(), said));
        assert!(assumed(Some(1000), None).is_some());
        for (trained, said) in [
            (Some(USUAL_HZ), None),
            (Some(1000), Some(1000)),
            (None, None),
        ] {
            assert_eq!(assumed(trained, said), None);
        }
    }
}
