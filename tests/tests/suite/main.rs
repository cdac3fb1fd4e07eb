//! The papers' claims, closed loop, faults and real recordings, across the crates.

mod claims;
mod closed_loop;
mod common;
mod disturbances;
mod encoder_faults;
mod euler_trace;
mod facing;
mod faults;
mod faults_by_side;
mod gains;
mod homing_faults;
mod limits;
mod motion_faults;
mod played;
mod precision;
mod pressed;
mod reference;
mod reference_claims;
mod second_sensor;
mod several;
mod stability;
mod starting;
mod terrain;
mod tilted_module;
mod unchanged;
mod zero;
