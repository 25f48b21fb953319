//! A type that values do not have.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = f32)]
enum Status {
    #[fc(value = 0)]
    Idle,
}

fn main() {}
