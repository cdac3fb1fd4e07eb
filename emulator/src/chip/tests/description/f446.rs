//! The STM32F446RE.

use stm32_metapac as metapac;

use crate::chip::models::F446 as MODEL;

#[path = "checks.rs"]
mod checks;
