//! An unknown attribute.

use fc_derive::Message;

#[derive(Message)]
#[fc(example = "{}", sample = "{}")]
struct Station {
    id: i32,
}

fn main() {}
