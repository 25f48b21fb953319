//! Two variants with one value.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(value = 1)]
    Idle,
    #[fc(value = 0x01)]
    Busy,
}

fn main() {}
