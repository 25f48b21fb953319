//! A leniency that does not exist.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(lenient(string))]
    name: String,
}

fn main() {}
