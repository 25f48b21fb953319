//! A field that cannot be absent.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(empty_is_absent)]
    name: String,
}

fn main() {}
