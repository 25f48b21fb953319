//! A limit that says its own type.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(max = 5u8)]
    id: u8,
}

fn main() {}
