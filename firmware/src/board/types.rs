//! What a module is made of on a board.

use firmware::{CodeClassifier, Hardware};

use super::encoder::Encoder;
use super::motors::Motor;
use super::sensor;
use crate::here::{self, Counter};

pub(crate) type Number = here::Number;

pub(crate) type Settings = firmware::Config<Number>;

pub(crate) type Inner = firmware::Module<Number, Board>;

pub(crate) struct Board;

impl Hardware for Board {
    type Source = sensor::Source;
    type Motor = Motor;
    type Angle = Encoder;
    type Classifier = CodeClassifier<&'static [u32]>;
    type Clock = Counter;
}
