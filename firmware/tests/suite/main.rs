//! Tests of the module from outside: its loop, and contact.

mod contact;
mod control_loop;
