#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]

use super::{Deflater, InflateError, Inflater};
use crate::digest::{Compute as _, Md5};
use flate2::read::GzDecoder;
use flate2::{Compression, GzBuilder};
use proptest::collection::vec;
use proptest::prelude::{any, proptest};
use std::io::{Read, Write};

fn inflate(member: &[u8], plain: usize) -> Result<Vec<u8>, InflateError> {
    let mut out = Vec::new();
    Inflater::default().inflate(member, plain, &mut out)?;
    Ok(out)
}

fn member(data: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let shorter = Deflater::new(6).member(data, &mut out);
    assert!(shorter, "{} bytes grew", data.len());
    out
}

#[fc_test::test]
fn round_trip_with_state_reused() {
    let mut deflater = Deflater::new(1);
    let mut inflater = Inflater::default();
    let (mut packed, mut plain) = (Vec::new(), Vec::new());
    for length in [100, 5, 70_000, 1000, 1 << 20] {
        let data: Vec<u8> = (0..length).map(|n: u32| n.to_le_bytes()[1]).collect();
        if deflater.member(&data, &mut packed) {
            assert_eq!(inflater.inflate(&packed, data.len(), &mut plain), Ok(()));
            assert_eq!(plain, data);
            let mut oracle = Vec::new();
            GzDecoder::new(packed.as_slice())
                .read_to_end(&mut oracle)
                .unwrap();
            assert_eq!(oracle, data);
        } else {
            assert_eq!(length, 5);
        }
    }
}

#[fc_test::test]
fn incompressible_data_stays_plain() {
    let mut out = Vec::new();
    assert!(!Deflater::new(9).member(b"", &mut out));
    assert!(!Deflater::new(9).member(b"abc", &mut out));
    let noise: Vec<u8> = (0..1000_u32)
        .flat_map(|n| Md5::of(&n.to_le_bytes()))
        .collect();
    assert!(!Deflater::new(9).member(&noise, &mut out));
}

/// An interrupted compression stays in the state of zlib-rs and adds up until it panics.
#[fc_test::test]
fn plain_data_leaves_the_buffer_unchanged() {
    let noise: Vec<u8> = (0..7_u32).flat_map(|n| Md5::of(&n.to_le_bytes())).collect();
    for level in 0..=9 {
        let mut deflater = Deflater::new(level);
        // Room for data of another length would also be enough for these.
        let mut out = Vec::new();
        for _ in 0..2000 {
            assert!(!deflater.member(&noise, &mut out), "level {level}");
        }
        assert_eq!(
            deflater.member(&[7; 100], &mut out),
            level > 0,
            "level {level}"
        );
    }
}

#[fc_test::test]
fn optional_header_fields_are_skipped() {
    let mut writer = GzBuilder::new()
        .filename("map.json")
        .comment("of floor 3")
        .extra(vec![1, 2, 3])
        .mtime(77)
        .write(Vec::new(), Compression::best());
    writer.write_all(b"hello hello").unwrap();
    let packed = writer.finish().unwrap();
    assert_eq!(inflate(&packed, 11).unwrap(), b"hello hello");
}

#[fc_test::test]
fn lies_and_damage() {
    let data = vec![7; 100_000];
    let packed = member(&data);
    assert_eq!(inflate(&packed, 100_000).unwrap(), data);
    assert_eq!(inflate(&packed, 99_999), Err(InflateError::Length));
    assert_eq!(inflate(&packed, 100_001), Err(InflateError::Length));
    assert_eq!(inflate(&packed, 0), Err(InflateError::Length));
    assert_eq!(inflate(&[], 3), Err(InflateError::Damaged));
    for end in 0..packed.len() {
        assert_eq!(
            inflate(&packed[..end], 100_000),
            Err(InflateError::Damaged),
            "cut at {end}"
        );
    }
    let mut longer = packed.clone();
    longer.push(0);
    assert_eq!(inflate(&longer, 100_000), Err(InflateError::Damaged));
    let mut other_sum = packed.clone();
    let at = other_sum.len() - 8;
    other_sum[at] ^= 1;
    assert_eq!(inflate(&other_sum, 100_000), Err(InflateError::Damaged));
}

#[fc_test::test]
fn a_bomb_takes_no_more_room_than_announced() {
    let packed = member(&vec![0; 50_000_000]);
    let mut out = Vec::new();
    assert_eq!(
        Inflater::default().inflate(&packed, 10_000, &mut out),
        Err(InflateError::Length)
    );
    assert!(out.capacity() <= 20_000, "{}", out.capacity());
}

#[fc_test::test]
fn a_large_announcement_alone_reserves_little() {
    let packed = member(&[0; 100]);
    let mut out = Vec::new();
    assert_eq!(
        Inflater::default().inflate(&packed, 1 << 30, &mut out),
        Err(InflateError::Length)
    );
    assert!(out.capacity() <= 8192, "{}", out.capacity());
}

proptest! {
    #[fc_test::test]
    fn never_panics_and_never_exceeds(bytes in vec(any::<u8>(), 0..200), plain in 0_usize..10_000) {
        let mut member = super::HEADER.to_vec();
        member.extend(bytes);
        if let Ok(out) = inflate(&member, plain) {
            assert_eq!(out.len(), plain);
        }
    }
}
