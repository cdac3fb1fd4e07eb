//! Tests of the module from outside: its loop, and contact.

mod command;
mod contact;
mod control_loop;
