//! Configurations and models that a board must refuse.

use firmware::boards::BoardFacts;
use firmware::{ConfigError, HEADER_BYTES, Refusal, VERSION};
use host_sim::Error;
use tactile::{Axis, CRC_BYTES, ModelBuf, ModelParts, Quantiser, TableParts, checksum};

/// Where the header of a configuration has what.
const VERSION_AT: usize = 4;
const BOARD_AT: usize = 6;
const FORMAT_AT: usize = 7;
const LENGTH_AT: usize = 8;
const CRC_AT: usize = 12;

/// Where that of a model has its length; its version is where a configuration has it.
const MODEL_LENGTH_AT: usize = 12;

fn changed(right: &[u8], at: usize, by: u8) -> Vec<u8> {
    let mut bytes = right.to_vec();
    bytes[at] ^= by;
    bytes
}

/// What is wrong about a configuration that is right otherwise, each with its reason.
pub(crate) fn configs(right: &[u8]) -> Vec<(Vec<u8>, ConfigError)> {
    let changed = |at, by| changed(right, at, by);
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

/// What is wrong with a model, the model, and why a board must refuse it.
pub(crate) type Wrong = (&'static str, Vec<u8>, Refusal);

pub(crate) fn models(right: &[u8], facts: &BoardFacts) -> Result<Vec<Wrong>, Error> {
    let changed = |at, by| changed(right, at, by);
    let [slot, _] = facts.flash.slots;
    let length = (slot.model.bytes + 4).to_le_bytes();
    let mut long = right.to_vec();
    long[MODEL_LENGTH_AT..][..4].copy_from_slice(&length);
    let mut contradictory = right.to_vec();
    // Of the tables of samples none is left, and the sum is right.
    contradictory[8] = 0;
    let (body, sum) = contradictory.split_at_mut(right.len() - CRC_BYTES);
    sum.copy_from_slice(&checksum(body).to_le_bytes());
    let many = facts.max_classes + 1;
    Ok(vec![
        ("something else", changed(0, 1), Refusal::Strange),
        ("another version", changed(VERSION_AT, 8), Refusal::Version),
        ("too long", long, Refusal::TooLong),
        (
            "a bit flipped",
            changed(right.len() / 2, 4),
            Refusal::Damaged,
        ),
        ("no table", contradictory, Refusal::Content),
        ("too many classes", plain(many, 2)?, Refusal::Classes),
        ("three channels", plain(2, 3)?, Refusal::Channels),
    ])
}

/// A model of so many classes and channels, of which all are alike.
fn plain(classes: usize, channels: usize) -> Result<Vec<u8>, Error> {
    let names: Vec<String> = (0..classes).map(|class| format!("class {class}")).collect();
    let quantiser = Quantiser {
        origin: 0.0,
        exponent: 0,
        low: 0,
        high: 16_384,
    };
    let axis = |channel| Axis {
        channel,
        bins: 2,
        low: 0,
        high: 16_384,
    };
    let axes: Vec<Axis> = (0..channels).map(axis).collect();
    let entries = vec![1_024; 2 * classes];
    let table = |axis| TableParts::of_channel(axis, &entries);
    let tables: Vec<_> = axes.iter().map(table).collect();
    let model = ModelBuf::new(&ModelParts {
        names: &names,
        block: 20,
        channels: &vec![quantiser; channels],
        tables: &tables,
        floors: None,
        touch: None,
        opinion: &[],
    });
    let model = model.map_err(|error| Error::Work(error.to_string()))?;
    Ok(model.as_bytes().to_vec())
}
