//! An enum.

use fc_derive::RedactedDebug;

#[derive(RedactedDebug)]
enum Status {
    Idle,
}

fn main() {}
