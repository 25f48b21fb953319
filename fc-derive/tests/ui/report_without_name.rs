//! A report without a name.

use fc_derive::{Message, Report};

#[derive(Message, Report)]
#[fc(code = 0x0B01)]
struct Arrived {}

fn main() {}
