//! A variant for unknown values that cannot keep them.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = 0)]
    Idle,
    #[fc(other)]
    Unknown,
}

fn main() {}
