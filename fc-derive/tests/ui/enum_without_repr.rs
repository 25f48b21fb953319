//! The wire type is missing.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
enum Status {
    #[fc(value = 0)]
    Idle,
}

fn main() {}
