//! Tests of the module from outside: its loop, contact, commands between ticks.

mod command;
mod config;
mod contact;
mod control_loop;
mod deployed;
mod hardware;
mod link;
mod stopping;
