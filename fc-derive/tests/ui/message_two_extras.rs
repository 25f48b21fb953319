//! Two fields for unknown keys.

use fc_derive::Message;
use fc_runtime::Extra;

#[derive(Message)]
struct Station {
    #[fc(extra)]
    extra: Extra,
    #[fc(extra)]
    more: Extra,
}

fn main() {}
