//! The product's classifier: models, rules, training, and real recordings.

mod channels;
mod common;
mod model_file;
mod rules;
mod score;
mod terrain;
mod training;
