//! Values that a field takes, but none.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(only())]
    id: i32,
}

fn main() {}
