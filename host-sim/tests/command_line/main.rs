//! The command line from outside: what it writes and prints, what it refuses
//! and how, and what its figures mean. The program runs as a user runs it.

mod columns;
mod common;
mod deployed;
mod does;
mod judges;
mod library;
mod main_job;
mod mutations;
mod others_recordings;
mod outputs;
mod pictures;
mod poses;
mod press;
mod refuses_arguments;
mod refuses_models;
mod refuses_recordings;
mod refuses_scenes;
mod settings;
mod tuning;
