//! The `fc` command.

fn main() {}
