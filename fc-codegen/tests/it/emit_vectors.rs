//! Reads the golden frames with a second, independent reader.
//!
//! The reader has two fixed layouts and shares no code with the composer. A mistake in one therefore does not hide in
//! the other.

use crate::docs_support::{artifact, fixture, golden, model, project};
use fc_codegen::emit::vectors;
use fc_codegen::target::Targets;
use fc_reflect::sample::{Profile, Samples};
use fc_spec::model::{Direction, JsonRule, Kind, Model};
use flate2::read::GzDecoder;
use md5::{Digest as _, Md5};
use serde::de::IgnoredAny;
use serde_json::Value;
use std::fmt::Write as _;
use std::io::Read as _;

/// The offsets and values of a layout.
struct Layout {
    header: usize,
    big_endian: bool,
    heads: [[u8; 2]; 2],
    kind: usize,
    kinds: [u8; 4],
    reserved: u8,
    code: usize,
    encoding: usize,
    plain: u8,
    gzip: u8,
    total: usize,
    plain_length: usize,
    digest: usize,
    frame_bytes: usize,
    inflated_bytes: usize,
    zero_plain_length: bool,
}

const FC: Layout = Layout {
    header: 35,
    big_endian: true,
    heads: [[0xFC, 0xAA], [0xEE, 0xAA]],
    kind: 2,
    kinds: [0, 1, 2, 3],
    reserved: 2,
    code: 3,
    encoding: 9,
    plain: 0,
    gzip: 1,
    total: 11,
    plain_length: 15,
    digest: 19,
    frame_bytes: 16_777_216,
    inflated_bytes: 67_108_864,
    zero_plain_length: true,
};

const LAMP: Layout = Layout {
    header: 37,
    big_endian: false,
    heads: [[0x51, 0x3E], [0x52, 0x3C]],
    kind: 6,
    kinds: [0x10, 0x11, 0x12, 0x13],
    reserved: 0x13,
    code: 11,
    encoding: 7,
    plain: 4,
    gzip: 5,
    total: 2,
    plain_length: 17,
    digest: 21,
    frame_bytes: 65_536,
    inflated_bytes: 262_144,
    zero_plain_length: false,
};

/// The content of a frame.
struct Opened {
    response: bool,
    kind: u8,
    code: usize,
    data: Vec<u8>,
}

impl Layout {
    /// Reads a frame that fills the whole input, or returns the name of its error.
    fn open(&self, frame: &[u8]) -> Result<Opened, &'static str> {
        let head = self.heads.iter().position(|head| frame.starts_with(head));
        let begins = self.heads.iter().any(|head| head.starts_with(frame));
        let Some(head) = head else {
            return Err(if begins { "truncated" } else { "bad_head" });
        };
        let total = self.int(frame, self.total, 4).ok_or("truncated")?;
        if total < self.header {
            return Err("short_frame");
        }
        if total > self.frame_bytes {
            return Err("frame_too_long");
        }
        if frame.len() < total {
            return Err("truncated");
        }
        assert_eq!(frame.len(), total, "a vector is one frame");
        let kind = frame[self.kind];
        if kind == self.reserved {
            return Err("reserved_kind");
        }
        if !self.kinds.contains(&kind) {
            return Err("unknown_kind");
        }
        let encoding = frame[self.encoding];
        if encoding != self.plain && encoding != self.gzip {
            return Err("unknown_encoding");
        }
        let data = &frame[self.header..];
        if Md5::digest(data)[..] != frame[self.digest..self.digest + 16] {
            return Err("bad_digest");
        }
        let plain_length = self.int(frame, self.plain_length, 4).ok_or("truncated")?;
        let data = self.unpack(encoding, data, plain_length)?;
        let code = self.int(frame, self.code, 2).ok_or("truncated")?;
        Ok(Opened {
            response: head == 1,
            kind,
            code,
            data,
        })
    }

    fn unpack(
        &self,
        encoding: u8,
        data: &[u8],
        plain_length: usize,
    ) -> Result<Vec<u8>, &'static str> {
        if encoding == self.plain {
            let quirk = self.zero_plain_length && plain_length == 0;
            let fits = data.len() == plain_length || quirk;
            return if fits {
                Ok(data.to_vec())
            } else {
                Err("plain_length_mismatch")
            };
        }
        if plain_length > self.inflated_bytes {
            return Err("inflated_too_long");
        }
        let mut out = Vec::new();
        let read = GzDecoder::new(data).read_to_end(&mut out);
        read.map_err(|_| "bad_gzip")?;
        if out.len() == plain_length {
            Ok(out)
        } else {
            Err("plain_length_mismatch")
        }
    }

    fn int(&self, frame: &[u8], at: usize, size: usize) -> Option<usize> {
        let mut bytes = frame.get(at..at + size)?.to_vec();
        if !self.big_endian {
            bytes.reverse();
        }
        Some(
            bytes
                .iter()
                .fold(0, |value, byte| value << 8 | usize::from(*byte)),
        )
    }
}

#[test]
fn vectors_are_as_they_were() {
    let artifacts = vectors::emit(&model(&fixture()), &Targets::default());
    for name in ["frames", "set_level", "dim", "firmware"] {
        let path = format!("fc-generated/vectors/{name}.json");
        golden(&format!("vectors/{name}.json"), artifact(&artifacts, &path));
    }
}

#[test]
fn vectors_are_the_same_each_time() {
    let model = model(&project());
    assert_eq!(
        vectors::emit(&model, &Targets::default()),
        vectors::emit(&model, &Targets::default())
    );
}

#[test]
fn every_vector_matches_its_description() {
    for (root, layout) in [(project(), FC), (fixture(), LAMP)] {
        let model = model(&root);
        for artifact in vectors::emit(&model, &Targets::default()) {
            let file: Value =
                serde_json::from_str(&artifact.contents).expect("a vector file is JSON");
            assert_eq!(file["format"], 1, "{}", artifact.path);
            if artifact.path == BODIES {
                continue;
            }
            for entry in entries(&file, "accepted") {
                let place = format!("{} {}", artifact.path, entry["name"]);
                accepted(&layout, &file, entry, &place);
            }
            for entry in entries(&file, "rejected") {
                let place = format!("{} {}", artifact.path, entry["name"]);
                rejected(&layout, &model, entry, &place);
            }
        }
    }
}

const BODIES: &str = "fc-generated/vectors/bodies.json";

/// A vector has an error of JSON syntax exactly if another reader of the grammar refuses its body. Every rule has
/// accepted and refused vectors.
#[test]
fn bodies_match_their_description() {
    const OF_THE_TEXT: [&str; 3] = ["not_utf8", "bad_json", "not_an_object"];
    let artifacts = vectors::emit(&model(&fixture()), &Targets::default());
    let file: Value = serde_json::from_str(artifact(&artifacts, BODIES)).expect("JSON");
    for list in ["accepted", "rejected"] {
        for rule in JsonRule::ALL.iter().copied() {
            let of_rule = |entry: &Value| {
                let name = entry["name"].as_str().unwrap_or_default();
                name.starts_with(&format!("{}_", rule.name()))
            };
            assert!(entries(&file, list).any(of_rule), "{list}: {rule:?}");
        }
        for entry in entries(&file, list) {
            let bytes = unhex(entry["bytes"].as_str().expect("bytes"));
            let wanted = entry["error"].as_str();
            let wanted = wanted.filter(|name| OF_THE_TEXT.contains(name));
            assert_eq!(grammar_fault(&bytes), wanted, "{entry}");
            assert_eq!(entry["text"], *String::from_utf8_lossy(&bytes), "{entry}");
        }
    }
}

/// Returns the syntax error of a body, whatever its keys are.
fn grammar_fault(bytes: &[u8]) -> Option<&'static str> {
    let text = match std::str::from_utf8(bytes) {
        Ok("") => return None,
        Ok(text) => text,
        Err(_) => return Some("not_utf8"),
    };
    match serde_json::from_str::<IgnoredAny>(text) {
        Err(_) => Some("bad_json"),
        Ok(_) if !text.trim_start().starts_with('{') => Some("not_an_object"),
        Ok(_) => None,
    }
}

#[test]
fn every_side_of_every_operation_has_its_cases() {
    for root in [project(), fixture()] {
        every_side_has_its_cases(&model(&root));
    }
}

fn every_side_has_its_cases(model: &Model) {
    // The bytes of a stream are not JSON, and streams have no response.
    const JSON: (&[&str], &[&str]) = (
        &["request", "response"],
        &[
            "plain",
            "unknown_keys",
            "minimal",
            "maximal",
            "bad_json",
            "not_an_object",
        ],
    );
    const BYTES: (&[&str], &[&str]) = (&["request"], &["plain", "gzip", "bad_digest"]);
    let artifacts = vectors::emit(model, &Targets::default());
    for operation in &model.operations {
        // An operation without a code has no frame.
        if operation.kind() == Kind::Stream && operation.code.value.is_none() {
            continue;
        }
        let path = format!("fc-generated/vectors/{}.json", operation.name);
        let file: Value = serde_json::from_str(artifact(&artifacts, &path)).expect("JSON");
        let names: Vec<&str> = ["accepted", "rejected"]
            .iter()
            .flat_map(|list| entries(&file, list))
            .filter_map(|entry| entry["name"].as_str())
            .collect();
        let (sides, cases) = match operation.kind() {
            Kind::Stream => BYTES,
            Kind::Command | Kind::Report => JSON,
        };
        for side in sides {
            for case in cases {
                let wanted = format!("{side}_{case}");
                assert!(names.contains(&wanted.as_str()), "{path} lacks {wanted}");
            }
        }
        let mut unique = names.clone();
        unique.sort_unstable();
        unique.dedup();
        assert_eq!(unique.len(), names.len(), "{path} has a name twice");
    }
}

/// Compares the JSON of each profile, which shows the constraints of a field.
#[test]
fn samples_keep_to_the_constraints() {
    let model = model(&fixture());
    let samples = Samples::new(&model);
    let operation = model.operation("set_level").expect("the fixture has it");
    let mut out = String::new();
    for direction in Direction::ALL.iter().copied() {
        for profile in [
            Profile::Example,
            Profile::Full,
            Profile::Minimal,
            Profile::Maximal,
        ] {
            let message = samples.message(operation, direction, profile);
            let side = direction.name();
            writeln!(out, "{side} {profile:?}\n{}\n", message.pretty())
                .expect("a String takes all");
        }
    }
    golden("samples.txt", &out);
}

fn entries<'a>(file: &'a Value, list: &str) -> impl Iterator<Item = &'a Value> {
    file[list].as_array().expect("a list").iter()
}

fn accepted(layout: &Layout, file: &Value, entry: &Value, place: &str) {
    let body = match entry["frame"].as_str() {
        Some(frame) => {
            let opened = layout
                .open(&unhex(frame))
                .unwrap_or_else(|error| panic!("{place}: {error}"));
            assert_eq!(opened.response, entry["direction"] == "response", "{place}");
            if let Some(code) = file["code"].as_u64() {
                assert_eq!(opened.code as u64, code, "{place}");
            }
            if let Some(header) = entry.get("header") {
                assert_eq!(opened.kind, header["kind"], "{place}");
                assert_eq!(opened.code, header["code"], "{place}");
            }
            if let Some(data) = entry["data"].as_str() {
                assert_eq!(opened.data, unhex(data), "{place}");
                return;
            }
            String::from_utf8(opened.data).expect("JSON is UTF-8")
        }
        None => entry["text"]
            .as_str()
            .expect("a frame or a text")
            .to_owned(),
    };
    let parsed: Value =
        serde_json::from_str(&body).unwrap_or_else(|error| panic!("{place}: {error}"));
    assert_eq!(parsed, entry["body"], "{place}");
    assert_ne!(entry.get("canonical"), entry.get("body"), "{place}");
}

fn rejected(layout: &Layout, model: &Model, entry: &Value, place: &str) {
    const OF_FRAMES: [&str; 11] = [
        "bad_head",
        "short_frame",
        "frame_too_long",
        "truncated",
        "unknown_kind",
        "reserved_kind",
        "unknown_encoding",
        "bad_digest",
        "bad_gzip",
        "plain_length_mismatch",
        "inflated_too_long",
    ];
    let wanted = entry["error"].as_str().expect("an error");
    let data = match entry["frame"].as_str() {
        Some(frame) => match layout.open(&unhex(frame)) {
            Ok(opened) => opened.data,
            Err(error) => return assert_eq!(error, wanted, "{place}"),
        },
        None => entry["text"]
            .as_str()
            .expect("a frame or a text")
            .as_bytes()
            .to_vec(),
    };
    assert!(!OF_FRAMES.contains(&wanted), "{place} is a sound frame");
    let found = match std::str::from_utf8(&data) {
        Err(_) => "not_utf8",
        Ok(text) => match serde_json::from_str::<Value>(text) {
            Err(_) => "bad_json",
            Ok(value) if !value.is_object() => "not_an_object",
            Ok(value) if depth(&value) > model.limits.json_depth as usize => "too_deep",
            // The other errors depend on types, and the tests of the generated crate check them.
            Ok(_) => {
                return assert!(
                    !["not_utf8", "bad_json", "not_an_object", "too_deep"].contains(&wanted)
                );
            }
        },
    };
    assert_eq!(found, wanted, "{place}");
}

fn depth(value: &Value) -> usize {
    match value {
        Value::Array(items) => 1 + items.iter().map(depth).max().unwrap_or(0),
        Value::Object(entries) => 1 + entries.values().map(depth).max().unwrap_or(0),
        _ => 0,
    }
}

fn unhex(text: &str) -> Vec<u8> {
    let digits = text.as_bytes().chunks(2);
    let byte = |pair: &[u8]| {
        let pair = std::str::from_utf8(pair).expect("hexadecimal is ASCII");
        u8::from_str_radix(pair, 16).expect("two hexadecimal digits")
    };
    digits.map(byte).collect()
}
