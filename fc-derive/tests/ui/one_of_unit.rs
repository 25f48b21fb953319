//! A variant without a message.

use fc_derive::OneOf;
use fc_runtime::Empty;

#[derive(OneOf)]
enum Cells {
    Some(Empty),
    None,
}

fn main() {}
