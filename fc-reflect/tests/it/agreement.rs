//! Decodes the same bytes with the generated package and with the model at run time. Both must agree.
//!
//! The frames are random changes of the committed vectors. `FC_FRAMES=1000000` sets their number, and `FC_SEED` selects
//! others.

use crate::mutate;
use crate::mutate::Random;
use crate::support::typed::{Typed, Verdict};
use crate::support::{self, hex, number};
use fc_generated::Fc;
use fc_reflect::{Decoded, Direction, Error, Limits, Packing, Reflector};
use fc_runtime::{Allowance, Encoder, FrameId, Gzip, Protocol as _};
use std::collections::BTreeMap;

#[test]
fn typed_and_reflected_decoding_agree() {
    let model = support::specs::model();
    let reflector = Reflector::new(&model);
    let allowance = Fc::DEFAULTS.limits.json();
    // One frame in eight is read with narrow limits.
    let narrow = Limits {
        json_depth: 4,
        json_values: 12,
        ..Limits::of(&model)
    };
    let narrow_allowance = Allowance {
        depth: narrow.json_depth,
        values: narrow.json_values,
        ..Allowance::ANY
    };
    let narrow = Reflector::new(&model).limits(narrow);
    let typed = Typed::new(&model);
    let files = support::vectors();
    let seeds = mutate::seeds(&files, &reflector);
    let count = number("FC_FRAMES", 20_000);
    let first = number("FC_SEED", 0).wrapping_mul(1 << 32);
    let mut found: BTreeMap<&str, u64> = BTreeMap::new();
    for seed in first..first + count {
        let bytes = mutate::frame(&mut Random(seed), &seeds, &reflector);
        let (reflector, allowance) = if seed % 8 == 0 {
            (&narrow, narrow_allowance)
        } else {
            (&reflector, allowance)
        };
        let wanted = typed.verdict(&bytes, allowance);
        let decoded = reflector.decode(&bytes);
        let verdict = verdict(&decoded);
        *found.entry(wanted.name()).or_default() += 1;
        assert_eq!(verdict, wanted, "seed {seed}: {}", hex(&bytes));
        if let Ok(decoded) = decoded {
            written_alike(
                reflector,
                &decoded,
                &format!("seed {seed}: {}", hex(&bytes)),
            );
        }
    }
    println!("{count} frames: {found:?}");
    // A useful mix has enough accepted frames, and refusals for many reasons.
    assert!(found["taken"] * 10 > count && found.len() > 20, "{found:?}");
}

/// Returns the result of the model at run time as a verdict of the typed side.
fn verdict(decoded: &Result<Decoded<'_>, Error>) -> Verdict {
    match decoded {
        Ok(decoded) => {
            let id = decoded.frame.id;
            let message = decoded.message.as_ref();
            let data = match message {
                Some(message) if decoded.frame.operation.is_some() => {
                    message.canonical().expect("it has been read").into_bytes()
                }
                _ => decoded.frame.data.clone(),
            };
            Verdict::Taken {
                response: id.direction == Direction::Response,
                kind: id.kind,
                code: id.code,
                id: id.id,
                data,
            }
        }
        Err(error) => {
            let offset = match error {
                Error::Body { error, .. } => error.offset(),
                Error::Frame(_) => 0,
            };
            Verdict::Refused(error.name(), error.path().to_owned(), offset)
        }
    }
}

/// Checks that both sides encode a message to the same frame, compressed or not. The canonical text encodes to that
/// frame too.
fn written_alike(reflector: &Reflector<'_>, decoded: &Decoded<'_>, place: &str) {
    let id = decoded.frame.id;
    let data = match (&decoded.message, decoded.frame.operation) {
        (Some(message), Some(_)) => message.canonical().expect("it has been read").into_bytes(),
        (Some(_), None) => return,
        (None, _) => decoded.frame.data.clone(),
    };
    let typed_id = FrameId {
        response: id.direction == Direction::Response,
        kind: id.kind,
        code: id.code,
        id: id.id,
    };
    let sent = |packing, data: &[u8]| {
        let frame = reflector.encode(id, data, packing);
        hex(&frame.unwrap_or_else(|error| panic!("{error}: {place}")))
    };
    let wanted = |mut encoder: Encoder<Fc>| {
        let mut wanted = Vec::new();
        let done = encoder.bytes(&mut wanted, typed_id, &data);
        done.expect("it is short");
        hex(&wanted)
    };
    let plain = wanted(Encoder::new());
    assert_eq!(sent(Packing::Plain, &decoded.frame.data), plain, "{place}");
    assert_eq!(sent(Packing::Plain, &data), plain, "{place}");
    // Creating a compressor is slow, so only some messages are compressed.
    if data.len() % 8 == 0 {
        let gzip = Gzip {
            from_bytes: 0,
            level: 1,
        };
        let packing = Packing::Gzip { level: 1 };
        let packed = wanted(Encoder::new().gzip(gzip));
        assert_eq!(sent(packing, &data), packed, "{place}");
    }
}
