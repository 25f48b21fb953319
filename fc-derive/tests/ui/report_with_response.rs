//! A report that is answered.

use fc_derive::{Message, Report};

#[derive(Message, Report)]
#[fc(code = 0x0B01, name = "arrived", response = Arrived)]
struct Arrived {}

fn main() {}
