//! A header without a message id.

use fc_derive::Header;

#[derive(Clone, Copy, Header)]
#[fc(byte_order = "big")]
struct FrameHeader {
    #[fc(role = "head")]
    head: [u8; 2],
    #[fc(role = "kind")]
    kind: u8,
    #[fc(role = "code")]
    code: u16,
    #[fc(role = "total_length")]
    total_length: u32,
}

fn main() {}
