//! What the tests by topic share: strategies for words and rules.

use mlx90333::{SumRule, Word};
use proptest::prelude::*;
use proptest::sample::select;

/// Any word, the ends of the range more often than their share.
pub(crate) fn word() -> impl Strategy<Value = Word> {
    prop_oneof![
        4 => any::<u16>(),
        1 => select(vec![0, 1, 0x00FF, 0x7FFF, 0x8000, 0xFF00, 0xFFFF]),
    ]
    .prop_map(Word::new)
}

pub(crate) fn pair() -> impl Strategy<Value = (Word, Word)> {
    let stuck =
        |pair: &(Word, Word)| matches!((pair.0.raw(), pair.1.raw()), (0, 0) | (0xFFFF, 0xFFFF));
    (word(), word()).prop_filter("a stuck line", move |pair| !stuck(pair))
}

pub(crate) fn rule() -> impl Strategy<Value = SumRule> {
    select(SumRule::ALL.to_vec())
}
