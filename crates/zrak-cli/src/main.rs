//! zrak-cli

fn main() {}
