//! Headers with `#[derive(Header)]`, read and written.

use fc_derive::Header;
use fc_runtime::Header as _;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Header)]
#[fc(byte_order = "big")]
struct Big {
    #[fc(role = "head")]
    frame_head: [u8; 2],
    #[fc(role = "kind")]
    kind: u8,
    #[fc(role = "code")]
    cmd_function: u16,
    #[fc(role = "id")]
    msg_id: u32,
    #[fc(role = "encoding")]
    encryption: u8,
    #[fc(role = "status", value = 7)]
    status_code: u8,
    #[fc(role = "total_length")]
    out: u32,
    #[fc(role = "plain_length")]
    plain_length: u32,
    #[fc(role = "digest")]
    md5: [u8; 16],
}

/// Another order, other widths, the other byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Header)]
#[fc(byte_order = "little")]
struct Little {
    #[fc(role = "head")]
    head: [u8; 3],
    #[fc(role = "total_length")]
    total: u32,
    #[fc(value = 0x0102030405060708)]
    version: u64,
    #[fc(role = "digest")]
    digest: [u8; 16],
    #[fc(value = 0)]
    reserved: [u8; 5],
    #[fc(role = "code")]
    code: u16,
    #[fc(role = "encoding")]
    encoding: u8,
    #[fc(role = "id")]
    id: u32,
    #[fc(role = "kind")]
    kind: u8,
    #[fc(role = "plain_length")]
    plain: u32,
}

/// A shorter digest, a shorter id, and nothing of compression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Header)]
#[fc(byte_order = "little")]
struct Short {
    #[fc(role = "head")]
    head: [u8; 1],
    #[fc(role = "id")]
    id: u16,
    #[fc(role = "digest", algorithm = "crc32")]
    sum: u32,
    #[fc(role = "code")]
    code: u16,
    #[fc(role = "kind")]
    kind: u8,
    #[fc(role = "total_length")]
    total: u32,
}

/// No digest at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Header)]
#[fc(byte_order = "big")]
struct Bare {
    #[fc(role = "head")]
    head: [u8; 1],
    #[fc(role = "kind")]
    kind: u8,
    #[fc(role = "code")]
    code: u16,
    #[fc(role = "id")]
    id: u16,
    #[fc(role = "total_length")]
    total: u32,
}

#[test]
fn a_header_travels_as_its_fields_say() {
    let mut header = Big::new(&[0xFC, 0xAA], 1, 0x0A03, 0x0102_0304, 0);
    assert_eq!(header.status_code, 7);
    header.seal(0x23, 0x10, [9; 16]);
    let mut bytes = [0; 40];
    assert_eq!(Big::LEN, 35);
    assert!(header.write(&mut bytes));
    let start = [
        0xFC, 0xAA, 1, 0x0A, 0x03, 1, 2, 3, 4, 0, 7, 0, 0, 0, 0x23, 0, 0, 0, 0x10, 9,
    ];
    assert_eq!(bytes[..20], start);
    assert_eq!(bytes[34..36], [9, 0]);
    assert_eq!(Big::read(&bytes), Some(header));

    assert_eq!(header.head(), [0xFC, 0xAA]);
    assert_eq!(
        (header.kind(), header.code(), header.id()),
        (1, 0x0A03, 0x0102_0304)
    );
    assert_eq!((header.encoding(), header.total_length()), (0, 0x23));
    assert_eq!((header.plain_length(), header.digest()), (0x10, [9; 16]));
}

#[test]
fn the_other_byte_order() {
    let mut header = Little::new(&[1, 2, 3], 4, 0x0506, 0x0708_090A, 0x0B);
    header.seal(0x0C0D_0E0F, 1, [0; 16]);
    let mut bytes = [0; Little::LEN];
    assert!(header.write(&mut bytes));
    let start = [1, 2, 3, 0x0F, 0x0E, 0x0D, 0x0C, 8, 7, 6, 5, 4, 3, 2, 1];
    assert_eq!(bytes[..15], start);
    assert_eq!(bytes[36..], [6, 5, 0x0B, 0x0A, 9, 8, 7, 4, 1, 0, 0, 0]);
    assert_eq!(Little::read(&bytes), Some(header));
}

#[test]
fn short_digest_has_byte_order_short_id_low_bits() {
    let mut header = Short::new(&[9], 1, 0x0203, 0x0001_0405, 77);
    let mut sum = [0; 16];
    sum[..4].copy_from_slice(&[0xCB, 0xF4, 0x39, 0x26]);
    header.seal(0x14, 77, sum);
    let mut bytes = [0; Short::LEN];
    assert!(header.write(&mut bytes));
    let expected = [9, 5, 4, 0x26, 0x39, 0xF4, 0xCB, 3, 2, 1, 0x14, 0, 0, 0];
    assert_eq!(bytes, expected);
    assert_eq!(Short::read(&bytes), Some(header));
    assert_eq!((header.id(), header.digest()), (0x0405, sum));
    assert_eq!((Short::ID_MAX, Big::ID_MAX), (0xFFFF, u32::MAX));
}

#[test]
fn absent_header_fields_read_as_plain_data() {
    let mut header = Bare::new(&[9], 1, 2, 3, 77);
    header.seal(20, 77, [5; 16]);
    assert_eq!((header.encoding(), header.digest()), (0, [0; 16]));
    assert_eq!(header.plain_length(), 20 - 10);
    header.seal(1, 0, [0; 16]);
    assert_eq!(header.plain_length(), 0, "shorter than a header");
}

#[test]
fn too_few_bytes_are_no_header() {
    let header = Big::new(&[0xFC, 0xAA], 1, 2, 3, 0);
    let mut bytes = [0; Big::LEN];
    for length in 0..Big::LEN {
        assert!(!header.write(&mut bytes[..length]));
        assert_eq!(bytes, [0; Big::LEN]);
        assert_eq!(Big::read(&bytes[..length]), None);
        let peeked = Big::peek_total_length(&bytes[..length]);
        assert_eq!(peeked.is_some(), length >= Big::TOTAL_LENGTH_END);
    }
    assert_eq!(Big::TOTAL_LENGTH_END, 15);
    assert_eq!(
        Little::peek_total_length(&[0, 0, 0, 1, 2, 0, 0]),
        Some(0x0201)
    );
}
