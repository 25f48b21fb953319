//! Unknown keys in a field that cannot keep them.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(extra)]
    extra: String,
}

fn main() {}
