//! Variants are told apart by keys, not by attributes.

use fc_derive::OneOf;
use fc_runtime::Empty;

#[derive(OneOf)]
enum Cells {
    #[fc(value = 1)]
    One(Empty),
}

fn main() {}
