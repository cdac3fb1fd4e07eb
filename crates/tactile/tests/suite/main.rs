//! The product's classifier: models, rules and training.

mod classifier;
mod common;
mod joint;
mod lasting;
mod model_file;
mod opinion;
mod priors;
mod rules;
mod score;
mod touch_detector;
mod touches;
mod training;
