//! A value with a fraction.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = 0.5)]
    Idle,
}

fn main() {}
