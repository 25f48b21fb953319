//! A pattern on a number.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(pattern = "[0-9]")]
    id: i32,
}

fn main() {}
