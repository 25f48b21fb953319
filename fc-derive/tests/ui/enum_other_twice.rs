//! Two variants for unknown values.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = u8)]
enum Status {
    #[fc(other)]
    Unknown(u8),
    #[fc(other)]
    Other(u8),
}

fn main() {}
