//! Tests of the driver and the codec, by topic.

mod common;
mod config;
mod crc;
mod driver;
mod faults;
mod frames;
mod timing;
mod value;
