//! A key that nobody can have meant.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(key = "a\u{1}")]
    id: i32,
}

fn main() {}
