//! The scene that the firmware was built for, as constants; written by the
//! build script from the scene file.
#![allow(
    clippy::enum_glob_use,
    reason = "variants print with the names of the types they hold; a glob gives way to those"
)]
#![allow(
    clippy::excessive_precision,
    clippy::unreadable_literal,
    reason = "numbers are written as computed"
)]

include!(concat!(env!("OUT_DIR"), "/scene.rs"));
