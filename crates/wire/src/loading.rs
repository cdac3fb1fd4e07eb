//! The order in which a model is written into flash.

/// Words at the beginning of a model that are written last, the first of all in the end: until
/// then its place counts as empty. Two, which is what the flash of an STM32G0 is programmed by.
const MODEL_LAST_WORDS: u32 = 2;

/// Where the `number`-th word that is written belongs in a model of so many `words`, more than
/// `number`.
pub const fn load_order(number: u32, words: u32) -> u32 {
    let last = if words < MODEL_LAST_WORDS {
        words
    } else {
        MODEL_LAST_WORDS
    };
    if number < words - last {
        last + number
    } else {
        words.saturating_sub(number.saturating_add(1))
    }
}

#[cfg(test)]
mod tests {
    use super::load_order;

    #[test]
    fn the_first_words_come_last_and_backwards() {
        let order = |words| (0..words).map(move |number| load_order(number, words));
        assert!(order(6).eq([2, 3, 4, 5, 1, 0]));
        assert!(order(2).eq([1, 0]));
        assert!(order(1).eq([0]));
    }
}
