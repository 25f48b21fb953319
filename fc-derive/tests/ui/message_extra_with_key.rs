//! A field for unknown keys that has a key.

use fc_derive::Message;
use fc_runtime::Extra;

#[derive(Message)]
struct Station {
    #[fc(extra, key = "more")]
    extra: Extra,
}

fn main() {}
