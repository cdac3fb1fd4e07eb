//! Words and halves of words.

/// Words of a packet.
pub const PACKET_WORDS: usize = 5;

/// Bytes of a packet.
pub const PACKET_BYTES: usize = PACKET_WORDS * size_of::<u32>();

/// The first `N` words of some bytes.
pub(crate) fn words<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let mut words = [0; N];
    for (word, bytes) in words.iter_mut().zip(bytes.as_chunks().0) {
        *word = u32::from_le_bytes(*bytes);
    }
    words
}

/// The halves of a word, the lower one first.
pub(crate) const fn halves(word: u32) -> [u16; 2] {
    [word as u16, (word >> 16) as u16]
}

/// The word of two halves, the lower one first.
pub(crate) const fn word(low: u16, high: u16) -> u32 {
    low as u32 | (high as u32) << 16
}
