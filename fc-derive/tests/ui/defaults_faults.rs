//! A default is what the absence of a field means.

use fc_derive::{Defaults, Message};

#[derive(Clone, Debug, PartialEq, Message, Defaults)]
struct Station {
    #[fc(default = 1)]
    floor: i32,
    #[fc(default)]
    height: Option<i32>,
    #[fc(default = 1, default = 2)]
    wing: Option<i32>,
}

#[derive(Defaults)]
enum Place {}

fn main() {}
