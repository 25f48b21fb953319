//! A value that the type cannot hold.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = 256)]
    Idle,
}

fn main() {}
