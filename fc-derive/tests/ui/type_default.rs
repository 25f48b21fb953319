//! A default is of the type of its field.

use fc_derive::{Defaults, Message};

#[derive(Clone, Debug, PartialEq, Message, Defaults)]
struct Station {
    #[fc(default = "ground")]
    floor: Option<i32>,
}

fn main() {}
