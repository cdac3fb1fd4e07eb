//! Tests of the driver and the decoder, by topic.

mod common;
mod driver;
mod faults;
mod frame;
mod timing;
mod transfer;
mod word;
