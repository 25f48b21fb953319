//! A number that is read as a bool.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(lenient(bool))]
    id: i32,
}

fn main() {}
