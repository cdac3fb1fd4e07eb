//! Faults injected at random times into running scenes, on the PC and on emulated boards,
//! and what becomes of them.
//!
//! Every run is one scene, one fault and one time, all drawn from the run's number: the
//! same number gives the same run. What must hold in every tick of every run is in
//! [`judge`]; how a run is called afterwards is in [`outcome`].
//!
//! # Glossary
//!
//! - *subject*: where a scene runs: host-sim, or a board's program on its emulated chip;
//! - *undisturbed run*: the same scene without a fault, to which a run is compared;
//! - *shard*: the runs whose numbers leave the same remainder; its rows are kept in a file
//!   of its own, so that what is interrupted goes on where it stood.

mod draw;
mod injection;
mod judge;
mod on_board;
mod outcome;
mod page;
mod prepared;
mod shard;
mod subject;
mod table;
mod words;

pub use draw::Plan;
pub use injection::Kind;
pub use outcome::{Ending, RunRow};
pub use page::{described, page};
pub use shard::{Scenes, Shard, run};
pub use table::{ShardTable, merge, read, rows};
