//! The command `moorline`.

fn main() {}
