//! An enum.

use fc_derive::Message;

#[derive(Message)]
enum Station {
    Dock,
}

fn main() {}
