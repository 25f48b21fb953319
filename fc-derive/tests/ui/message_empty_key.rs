//! A key without characters.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(key = "")]
    id: i32,
}

fn main() {}
