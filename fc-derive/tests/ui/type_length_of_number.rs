//! A length of a number.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(length = 5)]
    id: i32,
}

fn main() {}
