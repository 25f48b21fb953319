//! A value that no enum has.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(only(0.5))]
    id: i32,
}

fn main() {}
