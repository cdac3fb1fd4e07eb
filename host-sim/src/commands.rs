//! The commands of the command line, one file for each.

pub mod classify;
pub mod evaluate;
pub mod main_job;
pub mod record;
pub mod run;
pub mod score;
pub mod train;

/// The names of two columns, A,B, as an option has them.
///
/// # Errors
/// What is allowed instead.
pub fn channels(text: &str) -> Result<[String; 2], String> {
    match text.split_once(',') {
        Some((a, b)) if !a.is_empty() && !b.is_empty() && !b.contains(',') => {
            Ok([a.to_owned(), b.to_owned()])
        }
        _ => Err("allowed: two names, such as x,y".to_owned()),
    }
}
