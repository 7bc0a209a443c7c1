//! Errors at their places; reading what was written; nothing panics.

mod errors;
mod hostile;
mod keywords;
mod roundtrip;
