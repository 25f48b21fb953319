//! Values of an enum on a number.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(only(1, 6))]
    id: i32,
}

fn main() {}
