//! Tests of the driver and the decoder, by topic.

mod driver;
mod faults;
mod frame;
mod timing;
mod word;
