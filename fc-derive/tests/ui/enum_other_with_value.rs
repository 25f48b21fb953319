//! A variant for unknown values that has one.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(other, value = 1)]
    Unknown(u8),
}

fn main() {}
