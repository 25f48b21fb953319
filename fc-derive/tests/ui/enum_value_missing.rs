//! A variant without value.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = 0)]
    Idle,
    Busy,
}

fn main() {}
