//! Tests the codec and the typed stubs with the golden frames in `vectors/`, accepted and rejected.

use crate::support;
use crate::support::Type;
use crate::tally::Tally;
use fc_generated::{Fc, FrameHeader};
use fc_runtime::{
    BodyError, Bytes64, Decoder, Encoder, Extra, FrameError, FrameId, Header, Json, Protocol,
    transcode,
};
use fc_spec::model::{Kind, Model, Operation};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

/// The parts of a decoded frame.
struct Parts {
    header: FrameHeader,
    id: FrameId,
    body: Vec<u8>,
}

#[test]
fn every_vector_holds() {
    let model = support::model(&support::root());
    let folder = support::root().join("fc-generated/vectors");
    let mut frames = Tally::of("frames");
    let [mut all_accepted, mut all_rejected] = ["accepted", "rejected"].map(Tally::of);
    for operation in model
        .operations
        .iter()
        .map(|operation| operation.name.as_str())
        .chain(["frames"])
    {
        let text = fs::read_to_string(folder.join(format!("{operation}.json")))
            .expect("its vectors exist");
        let file: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(file["format"], 1);
        match model.operation(operation) {
            Some(operation) => has_its_cases(operation, &file),
            None => has_frames_of_every_kind(&file),
        }
        let is_message = model.operation(operation).is_some();
        for vector in file["accepted"].as_array().unwrap() {
            accepted(&model, operation, vector);
            let tally = if is_message {
                &mut all_accepted
            } else {
                &mut frames
            };
            tally.held(1);
        }
        for vector in file["rejected"].as_array().unwrap() {
            let error = rejected(&model, operation, vector);
            assert_eq!(
                error,
                vector["error"].as_str(),
                "{operation}: {}",
                vector["name"]
            );
            let tally = if is_message {
                &mut all_rejected
            } else {
                &mut frames
            };
            tally.held(1);
        }
    }
}

/// Defines messages with one key of each type. `of_one_key` returns the function that reads and writes one, by the name
/// of the key's type.
macro_rules! of_one_key {
    ($($message:ident of $ty:ty: $($name:literal)|*;)*) => {
        $(
            #[derive(Clone, Debug, PartialEq, fc_derive::Message)]
            struct $message {
                value: Option<$ty>,
                #[fc(extra)]
                extra: Extra,
            }
        )*

        fn of_one_key(ty: &str) -> fn(&[u8]) -> Result<Vec<u8>, BodyError> {
            match ty {
                $($($name)|* => transcode::<$message>,)*
                other => panic!("{other}"),
            }
        }
    };
}

of_one_key! {
    OfI8 of i8: "i8";
    OfI16 of i16: "i16";
    OfI32 of i32: "i32";
    OfI64 of i64: "i64" | "timestamp_ms" | "timestamp_s";
    OfU8 of u8: "u8";
    OfU16 of u16: "u16";
    OfU32 of u32: "u32";
    OfU64 of u64: "u64";
    OfF32 of f32: "f32";
    OfF64 of f64: "f64";
    OfString of String: "string";
    OfBytes of Bytes64: "base64";
    OfJson of Json: "json";
    OfObject of OfI32: "object";
}

/// `bodies.json` has bodies that are edge cases of JSON. Each is refused, or read and written again, as the file
/// expects.
#[test]
fn every_body_is_read_as_the_rules_say() {
    let path = support::root().join("fc-generated/vectors/bodies.json");
    let file: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    assert_eq!(file["format"], 1);
    let mut tally = Tally::of("bodies");
    let mut seen = BTreeSet::new();
    for (list, key) in [("accepted", "written"), ("rejected", "error")] {
        for vector in file[list].as_array().unwrap() {
            let bytes = unhex(vector["bytes"].as_str().unwrap());
            let read = of_one_key(vector["type"].as_str().unwrap());
            let found = match read(&bytes) {
                Ok(written) => ("accepted", String::from_utf8(written).unwrap()),
                Err(error) => ("rejected", error.name().to_owned()),
            };
            let wanted = vector[key].as_str().unwrap();
            assert_eq!(found, (list, wanted.to_owned()), "{vector}");
            assert!(seen.insert(vector["name"].to_string()), "{vector}");
            tally.held(1);
        }
    }
    assert!(seen.len() > 200);
}

/// Cases that each side of every operation has: in frames, and in bodies.
const ACCEPTED: [&str; 2] = ["plain", "gzip"];
const ACCEPTED_BODIES: [&str; 4] = ["plain", "unknown_keys", "minimal", "maximal"];
const REJECTED: [&str; 5] = [
    "bad_head",
    "short_frame",
    "truncated",
    "unknown_encoding",
    "bad_digest",
];
const REJECTED_BODIES: [&str; 3] = ["bad_json", "not_an_object", "too_deep"];

/// Asserts that a file has the required cases, because an empty file would prove nothing.
fn has_its_cases(operation: &Operation, file: &Value) {
    assert_eq!(file["operation"], operation.name.as_str());
    let coded = operation.code.value.is_some();
    let typed = operation.kind() != Kind::Stream;
    // A stream has only one direction.
    let sides = if typed {
        &["request", "response"][..]
    } else {
        &["request"]
    };
    for side in sides {
        let names = |list: &str, key: &str| -> BTreeSet<String> {
            let vectors = file[list].as_array().unwrap().iter();
            vectors
                .filter(|vector| vector["direction"] == *side)
                .map(|vector| vector[key].as_str().unwrap().to_owned())
                .collect()
        };
        let accepted = names("accepted", "case");
        let rejected = names("rejected", "name");
        let mut wanted_accepted = Vec::new();
        let mut wanted_rejected = Vec::new();
        if coded {
            wanted_accepted.extend(ACCEPTED);
            wanted_rejected.extend(REJECTED);
        }
        if typed {
            wanted_accepted.extend(ACCEPTED_BODIES);
            wanted_rejected.extend(REJECTED_BODIES);
        }
        for case in wanted_accepted {
            assert!(
                accepted.contains(case),
                "{}: {side}: {case}",
                operation.name
            );
        }
        for case in wanted_rejected {
            let name = format!("{side}_{case}");
            assert!(rejected.contains(&name), "{}: {name}", operation.name);
        }
    }
}

/// Asserts that there are frames of each kind in both directions: plain, compressed and empty.
fn has_frames_of_every_kind(file: &Value) {
    let names = |list: &str| -> BTreeSet<&str> {
        let vectors = file[list].as_array().unwrap().iter();
        vectors
            .map(|vector| vector["name"].as_str().unwrap())
            .collect()
    };
    let accepted = names("accepted");
    for kind in ["command", "report", "stream"] {
        for side in ["request", "response"] {
            for case in ["", "_gzip", "_empty"] {
                let name = format!("{kind}_{side}{case}");
                assert!(accepted.contains(name.as_str()), "frames: {name}");
            }
        }
    }
    assert!(names("rejected").len() >= REJECTED.len(), "frames");
}

fn accepted(model: &Model, operation: &str, vector: &Value) {
    let place = format!("{operation}: {}", vector["name"]);
    let body = match vector["frame"].as_str() {
        Some(frame) => {
            let bytes = unhex(frame);
            let parts = take_apart(&bytes).unwrap_or_else(|error| panic!("{place}: {error}"));
            let is_response = vector["direction"] == "response";
            assert_eq!(parts.id.response, is_response, "{place}");
            if let Some(data) = vector["data"].as_str() {
                assert_eq!(parts.body, unhex(data), "{place}");
            }
            if vector["header"].is_object() {
                compare_header(&parts.header, &vector["header"], &place);
            }
            if let Some(operation) = model.operation(operation) {
                assert_eq!(Some(parts.id.code), operation.code.value, "{place}");
                assert_eq!(parts.id.kind, kind(operation.kind()), "{place}");
            }
            if vector["case"] == "plain" {
                let mut again = Vec::new();
                Encoder::<Fc>::new()
                    .bytes(&mut again, parts.id, &parts.body)
                    .unwrap();
                assert_eq!(
                    hex(&again),
                    frame,
                    "{place}: the encoder writes the same frame"
                );
            }
            parts.body
        }
        None => vector["text"]
            .as_str()
            .expect("a frame or a text")
            .as_bytes()
            .to_vec(),
    };
    if vector["body"].is_null() {
        return;
    }
    let read: Value = serde_json::from_slice(&body).unwrap();
    assert_eq!(read, vector["body"], "{place}");
    let expected = if vector["canonical"].is_null() {
        &vector["body"]
    } else {
        &vector["canonical"]
    };
    let again =
        typed(model, operation, vector)(&body).unwrap_or_else(|error| panic!("{place}: {error}"));
    let again: Value = serde_json::from_slice(&again).unwrap();
    assert_eq!(again, *expected, "{place}");
}

/// Returns the name of the error, if there is one.
fn rejected(model: &Model, operation: &str, vector: &Value) -> Option<&'static str> {
    let body = match vector["frame"].as_str() {
        Some(frame) => match take_apart(&unhex(frame)) {
            Ok(parts) => parts.body,
            Err(error) => return Some(error.name()),
        },
        None => vector["text"]
            .as_str()
            .expect("a frame or a text")
            .as_bytes()
            .to_vec(),
    };
    typed(model, operation, vector)(&body)
        .err()
        .map(|error| error.name())
}

/// Returns the function that reads and writes the bodies of an operation.
fn typed(
    model: &Model,
    operation: &str,
    vector: &Value,
) -> fn(&[u8]) -> Result<Vec<u8>, BodyError> {
    let messages = model.operation(operation).and_then(Operation::messages);
    if vector["direction"] == "response" {
        Type::named(messages.map(|messages| messages.response.ty.name())).response
    } else {
        Type::named(messages.map(|messages| messages.request.ty.name())).request
    }
}

/// Returns the parts of the only frame in `bytes`.
fn take_apart(bytes: &[u8]) -> Result<Parts, FrameError> {
    let mut decoder = Decoder::<Fc>::new();
    decoder.push(bytes);
    let parts = match decoder.next()? {
        Some(frame) => Some(Parts {
            header: frame.header,
            id: frame.id(),
            body: frame.body().to_vec(),
        }),
        None => None,
    };
    decoder.finish()?;
    Ok(parts.expect("a whole frame"))
}

fn compare_header(header: &FrameHeader, expected: &Value, place: &str) {
    for (role, found) in [
        ("kind", u64::from(header.kind())),
        ("code", header.code().into()),
        ("id", header.id().into()),
        ("encoding", header.encoding().into()),
        ("total_length", header.total_length().into()),
        ("plain_length", header.plain_length().into()),
    ] {
        assert_eq!(expected[role].as_u64(), Some(found), "{place}: {role}");
    }
    assert_eq!(
        expected["digest"].as_str(),
        Some(hex(&header.digest()).as_str()),
        "{place}"
    );
    let mut again = vec![0; FrameHeader::LEN];
    assert!(header.write(&mut again));
    assert_eq!(FrameHeader::read(&again), Some(*header), "{place}");
}

fn kind(kind: Kind) -> u8 {
    match kind {
        Kind::Command => Fc::COMMAND,
        Kind::Report => Fc::REPORT,
        Kind::Stream => Fc::STREAM,
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes
        .iter()
        .fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

fn unhex(text: &str) -> Vec<u8> {
    let digits: Vec<u8> = text
        .chars()
        .map(|digit| u8::try_from(digit.to_digit(16).expect("hexadecimal")).unwrap())
        .collect();
    digits
        .chunks(2)
        .map(|pair| pair.iter().fold(0, |byte, digit| byte << 4 | digit))
        .collect()
}
