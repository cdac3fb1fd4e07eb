//! In which order a scene and its model are written into flash.

use serde::{Deserialize, Serialize};

/// How many words of each come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Load {
    /// Words of the configuration, with its header.
    pub config: u16,
    /// Words of the model; 0: the scene needs none.
    pub model: u16,
}

/// Which word comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadedWord {
    /// This one of the model.
    Model(u16),
    /// This one of the configuration.
    Config(u16),
}

impl Load {
    /// How many words come in all.
    pub const fn words(self) -> u32 {
        self.config as u32 + self.model as u32
    }

    /// The word that comes as the `number`-th, from 0: the model, then the configuration from its
    /// third word on, then its second, its first last. Whatever lies there is no configuration
    /// before that is written, so that a deployment which is cut off leaves the scene before.
    pub fn word(self, number: u32) -> Option<LoadedWord> {
        let [model, config] = [self.model, self.config].map(u32::from);
        if number < model {
            return Some(LoadedWord::Model(number as u16));
        }
        let n = number - model;
        let last = config.min(LAST_WORDS);
        if n >= config {
            None
        } else if n < config - last {
            Some(LoadedWord::Config((last + n) as u16))
        } else {
            Some(LoadedWord::Config((config - 1 - n) as u16))
        }
    }
}

/// Words at the beginning of a configuration that are written last, the first of all in the
/// end. Two, which is what the flash of an STM32G0 is programmed by.
const LAST_WORDS: u32 = 2;

#[cfg(test)]
mod tests {
    use super::{Load, LoadedWord};

    #[test]
    fn every_word_comes_once_and_the_first_of_the_configuration_last() {
        for (config, model) in [(1, 0), (5, 0), (4, 3), (300, 2_000)] {
            let load = Load { config, model };
            let words: Vec<LoadedWord> = (0..).map_while(|n| load.word(n)).collect();
            assert_eq!(words.len() as u32, load.words());
            assert_eq!(words.last(), Some(&LoadedWord::Config(0)));
            let models = (0..model).map(LoadedWord::Model);
            let configs = (0..config).map(LoadedWord::Config);
            for word in models.chain(configs) {
                assert_eq!(words.iter().filter(|one| **one == word).count(), 1);
            }
        }
    }
}
