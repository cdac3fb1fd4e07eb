//! The models' numbers against another source: the descriptions of the chips in
//! stm32-metapac, which are made from ST's configuration tool and register files.

mod f446;
