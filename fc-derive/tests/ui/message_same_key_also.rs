//! Another key of a field is a field's key.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(also("title"))]
    name: String,
    title: String,
}

fn main() {}
