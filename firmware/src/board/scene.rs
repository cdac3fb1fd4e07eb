//! The scene that the firmware was built for: its types and settings, written
//! by the build script from the scene file.
//!
//! - `NAME`, `TICK_HZ`.
//! - `SIDES`: what its whiskers hang on, left first.
//! - `Source`, `source`, `frames`: where words come from; `FINDS_ZERO`: whether their zero is
//!   found anew by itself.
//! - `Number`: the number format of the tick.
//! - `Settings` and `SETTINGS`: what the tick reads. What the scene leaves out
//!   is left out by type.
//! - `Motion`, `start_motion`, `HAS_MOTOR`, `ARMS_AT_START`: how it moves.
//! - `Perception`, `start_perception`, `DECIDES`: what it decides, if anything; `model`: by
//!   which model; `adapt`: what of the settings follows from that; `constants`: what it holds
//!   that no sample changes, the model's bytes first; `AWAITS_MODEL`: whether that lies apart
//!   from the program.
//! - `Names`, `names`, `class_name`: the names of the classes.
//! - `HAS_SERIAL`, `SERIAL_BAUD`, `HAS_PINS`: what it tells without a probe.
//! - `HEARS_SEVERAL`: whether by more than one whisker.
#![allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "what a scene leaves out takes no memory"
)]
#![allow(
    clippy::unnecessary_wraps,
    reason = "a scene without a classifier starts nothing that can fail"
)]
#![allow(
    clippy::excessive_precision,
    clippy::unreadable_literal,
    reason = "numbers are written as computed"
)]

include!(concat!(env!("OUT_DIR"), "/scene.rs"));
