//! A key with a control character.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(key = "a\u{1}")]
    id: i32,
}

fn main() {}
