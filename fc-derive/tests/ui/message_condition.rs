//! Conditions that cannot be.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    kind: u8,
    #[fc(when(knd = 1))]
    unknown: Option<u8>,
    #[fc(unless(own = 1))]
    own: Option<u8>,
    #[fc(when(kind = 1), unless(kind = 2))]
    both: Option<u8>,
    #[fc(when())]
    nothing: Option<u8>,
    #[fc(when(kind = 1.5))]
    fraction: Option<u8>,
    #[fc(when(kind))]
    bare: Option<u8>,
    #[fc(when(kind = 1))]
    required: u8,
    #[fc(when(unknown = 1))]
    absent: Option<u8>,
}

fn main() {}
