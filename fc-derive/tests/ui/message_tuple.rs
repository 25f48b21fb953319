//! A struct whose fields have no names.

use fc_derive::Message;

#[derive(Message)]
struct Station(i32);

fn main() {}
