//! A value in the wrong place.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = 1)]
    Idle = 1,
}

fn main() {}
