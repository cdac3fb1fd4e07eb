//! Stability: no frequency, tick rate, time constant, gain, start or input
//! makes the module leave its bounds, and after any of them it comes back.
//!
//! - *abuse*: ticks with an input that no sound sensor gives, see
//!   [`axes::Input`]; *rest*: no contact at all, after abuse.
//! - *bounds*: every state finite, |ψ| ≤ 1.5, 0 ≤ z ≤ 1, 0 ≤ g ≤ 2, |θ| ≤ 2,
//!   |v| ≤ 2, checked every tick. A panic, overflow included, fails the test.
//! - *no wrap-around*: f32 and [`whisking::Fix`] stay within a stated distance
//!   of f64 from the same start under the same input; a wrap is an error of at
//!   least one.
//! - *back*: every θ' within 0.1° of the module's that was never touched, once
//!   the gates have had six of their time constants and the muscles three
//!   whisks; gates that need longer are on their closed-form way to rest.
//!
//! What is run is in `axes.rs`: a full product of the axes that shape the
//! equations, over which time constants and gains are dealt so that every pair
//! of levels of any two axes occurs.

mod abuse;
mod axes;
mod long;
mod noise;
mod position;
mod recovery;
mod rig;
