//! A variant for unknown values that keeps something else.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = 0)]
    Idle,
    #[fc(other)]
    Unknown(u16),
}

fn main() {}
