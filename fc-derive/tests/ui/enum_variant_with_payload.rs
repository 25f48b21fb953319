//! A known value that holds something.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = 0)]
    Idle(u8),
}

fn main() {}
