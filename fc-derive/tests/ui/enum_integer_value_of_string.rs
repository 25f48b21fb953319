//! An integer where strings travel.

use fc_derive::OpenEnum;

#[derive(OpenEnum)]
#[fc(repr = str)]
enum Status {
    #[fc(value = 5)]
    Idle,
}

fn main() {}
