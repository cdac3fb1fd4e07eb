//! The module of the scene on this board.

use super::scene::{Motion, Number, Perception, SIDES};
use super::sensor::Frames;
use crate::here::Counter;

/// Its type.
pub(crate) type Inner =
    firmware::Module<Number, Frames, Motion, &'static mut Perception, Counter, { SIDES.len() }, 1>;
