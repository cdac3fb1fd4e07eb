//! Readers of untrusted data: frames of a sensor, configurations, models,
//! scenes, recordings and the tables of a campaign's shards. Whatever the bytes, each target ends
//! soon, in little memory, without a panic; and what it takes holds what the rest relies on.
//!
//! `cargo xtask fuzz` feeds them; the tests here run them over the corpus.

mod config;
mod model;
mod scene;
#[cfg(feature = "shards")]
mod shards;

pub use config::config;
pub use model::model;
pub use scene::{scene, simulation};
#[cfg(feature = "shards")]
pub use shards::shards;

use host_sim::recording;
use mlx90333::{Decoder, Frame, Mode, SumRule, Word, encode};

/// The decoder of the sensor's frames, with every mode and rule of the sum.
///
/// # Panics
/// If a frame that is taken is not the one its words are sent as.
pub fn frame(data: &[u8]) {
    for bytes in data.as_chunks().0 {
        for mode in [Mode::AlphaBeta, Mode::Xyz] {
            for sum_rule in SumRule::ALL {
                let decoder = Decoder::with(mode, sum_rule);
                let sent = match decoder.decode(bytes) {
                    Ok(Frame {
                        first,
                        second,
                        third,
                    }) => {
                        let words = [first, second, third.unwrap_or_default()];
                        encode::words(words.map(Word::raw), decoder)
                    }
                    Err(error) => {
                        assert!(!error.to_string().is_empty());
                        continue;
                    }
                };
                assert_eq!(sent[..7], bytes[..7]);
                assert!(sent[7] == bytes[7] || sum_rule == SumRule::Ignore);
            }
        }
    }
}

/// The reader of recordings.
///
/// # Panics
/// If streams that are taken are not what is read back after they are written.
pub fn recording(data: &[u8]) {
    let Ok(streams) = recording::read(data, recording::CHANNELS) else {
        return;
    };
    for stream in &streams {
        let numbers = stream.touches(recording::GATE, 10).count();
        assert_eq!(numbers, stream.samples.len());
        assert!(stream.samples.iter().flatten().all(|x| x.is_finite()));
    }
    let mut text = Vec::new();
    assert!(recording::write(&mut text, &streams).is_ok());
    let again = recording::read(text.as_slice(), recording::CHANNELS);
    let samples = |streams: &[recording::Stream]| -> Vec<[f64; 2]> {
        streams.iter().flat_map(|s| s.samples.clone()).collect()
    };
    assert_eq!(again.as_deref().map(samples).ok(), Some(samples(&streams)));
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    /// Runs each target over the files of its folders, seen from the top of the workspace.
    #[test]
    fn first_inputs_are_read() {
        type Target = fn(&[u8]);
        let scenes = &["scenes", "fuzz/corpus/scene"][..];
        let targets: &[(Target, &[&str])] = &[
            (super::config, &["fuzz/corpus/config"]),
            (super::frame, &["fuzz/corpus/frame"]),
            (super::model, &["scenes/models", "fuzz/corpus/model"]),
            (super::recording, &["fuzz/corpus/recording"]),
            (super::scene, scenes),
            #[cfg(feature = "shards")]
            (super::shards, &["fuzz/corpus/shards"]),
            (super::simulation, scenes),
        ];
        for &(target, folders) in targets {
            for folder in folders {
                let mut files = 0;
                for entry in Path::new("..").join(folder).read_dir().unwrap() {
                    let path = entry.unwrap().path();
                    if path.is_file() {
                        target(&std::fs::read(path).unwrap());
                        files += 1;
                    }
                }
                assert!(files > 0, "{folder}");
            }
        }
    }
}
