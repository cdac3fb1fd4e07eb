//! The whisker module on a PC: the firmware library runs unchanged on mock
//! sensors and motors, with whiskers and surfaces behind them.
//!
//! The core is a library for any program: scene text in, then tick by tick rows of the trace,
//! events, decisions and samples out, without files, threads, clocks or a terminal. It builds for
//! `wasm32-unknown-unknown`. The feature `cli` (on unless switched off) adds what the program
//! `host-sim` needs besides: files, progress, plots and the commands themselves.
//!
//! ```
//! use host_sim::recording::Recorder;
//! use host_sim::run::Run;
//! use scene::Scene;
//!
//! let text = r#"
//! name = "free"
//! tick_hz = 2000
//! duration_s = 0.1
//! seed = 1
//! [head]
//! whiskers_per_side = 1
//! [whisking]
//! frequency_hz = 2.0
//! integrator = "exact"
//! coupling = true
//! noise = 0.0
//! gain = 1.0
//! start = [[1.0, 0.0], [1.0, 0.0]]
//! [plant]
//! kind = "ideal"
//! "#;
//! let scene = Scene::from_str("free.toml", text)?;
//! let mut run = Run::new(&scene, None)?;
//! let mut recorder = Recorder::default();
//! for _ in 0..run.ticks() {
//!     let row = run.tick();
//!     assert!(row.theta_deg.iter().all(|theta| (40.0..140.0).contains(theta)));
//!     assert!(run.events().is_empty());
//!     recorder.take(&mut run);
//! }
//! assert_eq!(recorder.into_streams()[0].samples.len(), 200);
//!
//! run.reset(2)?;
//! assert_eq!(run.tick().t_s, 0.0005);
//! # Ok::<(), host_sim::Error>(())
//! ```

pub mod array;
pub mod bench;
pub mod bus;
pub mod cells;
pub mod classifier;
pub mod columns;
pub mod decisions;
pub mod doubts;
pub mod drive;
mod error;
pub mod evaluation;
pub mod loaded;
pub mod motor;
pub mod origin;
pub mod plant;
pub mod pressing;
pub mod rate;
pub mod received;
pub mod recording;
pub mod replay;
pub mod run;
pub mod scoring;
pub mod trace;
pub mod training;
pub mod world;

#[cfg(feature = "cli")]
pub mod commands;
#[cfg(feature = "cli")]
pub mod files;
#[cfg(feature = "cli")]
pub mod misfit;
#[cfg(feature = "cli")]
pub mod output;
#[cfg(feature = "cli")]
pub mod plot;
#[cfg(feature = "cli")]
pub mod progress;
#[cfg(feature = "cli")]
pub mod report;

pub use error::Error;
