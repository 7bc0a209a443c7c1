//! The `zrak` command as a user meets it: the real program, its files, its words, its exit codes.

mod bad_input;
mod compare;
mod compile;
mod formats;
mod harness;
mod help;
mod interrupt;
mod outputs;
mod render;
mod reports;
mod scenes;
