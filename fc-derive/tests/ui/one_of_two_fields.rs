//! A variant with two messages.

use fc_derive::OneOf;
use fc_runtime::Empty;

#[derive(OneOf)]
enum Cells {
    Both(Empty, Empty),
}

fn main() {}
