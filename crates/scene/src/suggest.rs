//! Suggestions for misspelt words.

/// Least Jaro–Winkler similarity (0 to 1) at which two words count as alike. It admits one slip in
/// a short word (`gian`) and a forgotten unit (`tau`), and keeps unrelated keys apart.
const ALIKE: f64 = 0.84;

/// The candidate that `word` is most likely a misspelling of, if any is near.
/// Upper and lower case, and `-` and `_`, count as the same.
pub(crate) fn nearest(
    word: &str,
    candidates: impl IntoIterator<Item = &'static str>,
) -> Option<&'static str> {
    let word = fold(word);
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&word, &fold(candidate)), candidate))
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

fn fold(word: &str) -> String {
    word.to_lowercase().replace('-', "_")
}

#[cfg(test)]
mod tests {
    use super::nearest;
    use crate::section::Section;
    use crate::sections::sections;

    #[test]
    fn slips_find_their_key_among_all() {
        for (written, meant) in [
            ("gian", "gain"),
            ("tau", "tau_s"),
            ("Tick-Hz", "tick_hz"),
            ("frequncy_hz", "frequency_hz"),
            ("freqency", "frequency_hz"),
            ("obstacle", "obstacle_deg"),
            ("obstacles_deg", "obstacle_deg"),
            ("whisker_per_side", "whiskers_per_side"),
            ("treshold", "threshold"),
            ("stifness", "stiffness"),
            ("duration", "duration_s"),
            ("couplng", "coupling"),
            ("duty_limt", "duty_limit"),
            ("count_per_rev", "counts_per_rev"),
        ] {
            let all = sections().flat_map(Section::keys).map(|key| key.name);
            assert_eq!(nearest(written, all), Some(meant), "{written}");
        }
    }

    #[test]
    fn unrelated_words_find_nothing() {
        for written in ["", "x", "colour", "voltage", "sampling", "pid"] {
            let all = sections().flat_map(Section::keys).map(|key| key.name);
            assert_eq!(nearest(written, all), None, "{written}");
        }
    }
}
