//! Configurations that a board must refuse.

use firmware::{ConfigError, HEADER_BYTES, VERSION};
use tactile::checksum;

/// Where the header of a configuration has what.
const VERSION_AT: usize = 4;
const BOARD_AT: usize = 6;
const FORMAT_AT: usize = 7;
const LENGTH_AT: usize = 8;
const CRC_AT: usize = 12;

/// What is wrong about a configuration that is right otherwise, each with its reason.
pub(crate) fn configs(right: &[u8]) -> Vec<(Vec<u8>, ConfigError)> {
    let changed = |at: usize, by: u8| {
        let mut config = right.to_vec();
        config[at] ^= by;
        config
    };
    let summed = |mut config: Vec<u8>| {
        let sum = checksum(&[&config[VERSION_AT..CRC_AT], &config[HEADER_BYTES..]].concat());
        config[CRC_AT..HEADER_BYTES].copy_from_slice(&sum.to_le_bytes());
        config
    };
    let [board, format] = [right[BOARD_AT] ^ 4, right[FORMAT_AT] ^ 1];
    vec![
        (changed(0, 1), ConfigError::Strange),
        (
            summed(changed(VERSION_AT, 8)),
            ConfigError::Version(VERSION ^ 8),
        ),
        (summed(changed(BOARD_AT, 4)), ConfigError::Board(board)),
        (summed(changed(FORMAT_AT, 1)), ConfigError::Format(format)),
        (changed(LENGTH_AT + 2, 1), ConfigError::TooLong),
        (changed(right.len() / 2, 4), ConfigError::Damaged),
    ]
}
