//! A variant that holds no message.

use fc_derive::OneOf;

#[derive(OneOf)]
enum Cells {
    Index(u8),
}

fn main() {}
