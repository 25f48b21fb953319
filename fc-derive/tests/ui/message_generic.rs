//! A struct with a parameter.

use fc_derive::Message;

#[derive(Message)]
struct Station<T> {
    id: T,
}

fn main() {}
