//! A string where integers travel.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = "idle")]
    Idle,
}

fn main() {}
