//! Scenes for hours: on the PC, whether they end as they began; on the emulated boards, with
//! every counter started just below its wrap, whether they stay the same as on the PC.
//!
//! A week and a day are cut into *shards*: a scene with a seed for some hours, whose row is
//! kept in a file of its own, so that what is interrupted goes on where it stood.

mod on_board;
mod on_pc;
mod page;
mod row;
mod span;

pub use on_board::on_board;
pub use on_pc::on_pc;
pub use page::page;
pub use row::{ShardRow, row};
