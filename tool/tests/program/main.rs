//! The program from outside, as a user runs it: what it writes and prints, what it refuses
//! and how, and whether what it captures is what can be learnt from.

mod bringup;
mod calibrate;
mod capture;
mod common;
mod deploy;
mod learnt;
mod log;
mod messages;
mod monitor;
mod order;
mod port;
mod records;
mod script;
mod tuning;
