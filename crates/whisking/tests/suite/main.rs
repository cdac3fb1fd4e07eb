//! Tests of the pattern generator, the position control and the motor drivers, by topic.

mod bounds;
mod module_terms;
mod motor_duty;
mod motor_guard;
mod motor_hall;
mod motor_hbridge;
mod motor_homing;
mod motor_rotor;
mod motor_six_step;
mod motor_stall;
mod phase_noise;
mod pins;
mod same_bits;
mod settings;
mod sides;
