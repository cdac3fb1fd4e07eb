//! Tests of the scene reader through its public interface, by topic.

mod accepts;
mod common;
mod hardening;
mod overrides;
mod refuses;
