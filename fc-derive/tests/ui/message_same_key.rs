//! Two fields with one key.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    id: i32,
    #[fc(key = "id")]
    number: i32,
}

fn main() {}
