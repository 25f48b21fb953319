//! Frames into bytes.

use crate::common::{Toy, command, report};
use fc_runtime::{Encoder, FrameError, Gzip};

#[fc_test::test]
fn a_frame_that_does_not_fit_is_not_written() {
    let mut out = b"before".to_vec();
    let mut encoder = Encoder::<Toy>::new().frame_bytes(100);
    encoder.bytes(&mut out, command(1, 1), &[0; 63]).unwrap();
    let length = out.len();
    let error = encoder
        .bytes(&mut out, command(1, 2), &[0; 64])
        .unwrap_err();
    assert_eq!(
        error,
        FrameError::FrameTooLong {
            total: 101,
            limit: 100
        }
    );
    assert_eq!(out.len(), length);
    assert_eq!(
        encoder.prepare(|out| out.resize(64, 0)).unwrap_err().name(),
        "frame_too_long"
    );
}

#[fc_test::test]
fn a_panic_while_writing_leaves_no_part_of_a_frame() {
    let mut out = b"before".to_vec();
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        let _ = Encoder::<Toy>::new().frame(&mut out, command(1, 1), |out| {
            out.push(1);
            panic!("in the middle");
        });
    }));
    assert!(result.is_err());
    assert_eq!(out, b"before");
}

#[fc_test::test]
fn a_prepared_body_makes_the_same_frames() {
    for body in [&b"small"[..], &[b'a'; 5000]] {
        let mut encoder = Encoder::<Toy>::new().gzip(Gzip::default());
        let prepared = encoder.prepare(|out| out.extend_from_slice(body)).unwrap();
        for id in [report(3, 4), command(5, 6)] {
            let (mut once, mut again) = (b"before".to_vec(), b"before".to_vec());
            encoder.prepared(&mut once, id, &prepared);
            encoder.bytes(&mut again, id, body).unwrap();
            assert_eq!(once, again);
        }
    }
}
