//! The module of the scene on this board.

use super::scene::{Motion, Number, Perception, SIDES, Source};
use crate::here::Counter;

/// Its type.
pub(crate) type Inner =
    firmware::Module<Number, Source, Motion, &'static mut Perception, Counter, { SIDES.len() }, 1>;
