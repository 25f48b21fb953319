//! No variants.

use fc_derive::OneOf;

#[derive(OneOf)]
enum Cells {}

fn main() {}
