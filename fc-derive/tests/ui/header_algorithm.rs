//! Algorithms that do not fit their fields.

use fc_derive::Header;

#[derive(Clone, Copy, Header)]
#[fc(byte_order = "big")]
struct FrameHeader {
    #[fc(role = "head")]
    head: [u8; 2],
    #[fc(role = "kind", algorithm = "md5")]
    kind: u8,
    #[fc(role = "code")]
    code: u16,
    #[fc(role = "id")]
    id: u8,
    #[fc(role = "total_length")]
    total_length: u32,
    #[fc(role = "digest", algorithm = "crc32")]
    digest: [u8; 16],
}

#[derive(Clone, Copy, Header)]
#[fc(byte_order = "big")]
struct Unknown {
    #[fc(role = "head")]
    head: [u8; 2],
    #[fc(role = "kind")]
    kind: u8,
    #[fc(role = "code")]
    code: u16,
    #[fc(role = "id")]
    id: u16,
    #[fc(role = "total_length")]
    total_length: u32,
    #[fc(role = "digest", algorithm = "sha1")]
    digest: [u8; 16],
}

fn main() {}
