//! A header without digest.

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
    #[fc(role = "id")]
    id: u32,
    #[fc(role = "encoding")]
    encoding: u8,
    #[fc(value = 0)]
    status: u8,
    #[fc(role = "total_length")]
    total_length: u32,
    #[fc(role = "plain_length")]
    plain_length: u32,
}

fn main() {}
