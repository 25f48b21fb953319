//! A struct.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
struct Status {
    id: u8,
}

fn main() {}
