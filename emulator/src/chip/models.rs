//! The chips that there are.

mod stm32f103;
mod stm32f446;
mod stm32g071;

use super::model::Model;

pub(crate) use stm32f103::F103;
pub(crate) use stm32f446::F446;
pub(crate) use stm32g071::G071;

pub(crate) static MODELS: [&Model; 3] = [&F446, &F103, &G071];
