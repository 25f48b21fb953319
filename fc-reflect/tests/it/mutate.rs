//! Changes frames at random: bytes, header fields, compressed data, and bodies by their grammar. Most results are still
//! frames, and many bodies are still JSON.

use crate::support::{cases, unhex};
use fc_generated::{Fc, FrameHeader};
use fc_reflect::{FrameId, Packing, Reflector};
use fc_runtime::digest::{DigestAlgorithm as _, Md5};
use fc_runtime::{Header as _, Protocol as _};
use serde_json::Value;

/// A generator of random numbers (`SplitMix64`). The same seed gives the same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// Returns a number below `limit`, which must not be 0.
    pub fn below(&mut self, limit: usize) -> usize {
        usize::try_from(self.next() % limit as u64).unwrap()
    }

    pub fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    pub fn pick<'a, T>(&mut self, items: &'a [T]) -> &'a T {
        &items[self.below(items.len())]
    }
}

/// The material for random frames.
pub struct Seeds {
    /// Whole frames.
    pub frames: Vec<Vec<u8>>,
    /// Header and data of the vectors that decoders accept.
    pub good: Vec<(FrameId, Vec<u8>)>,
    /// Header and data of the vectors whose body decoders refuse.
    pub bad: Vec<(FrameId, Vec<u8>)>,
    /// Keys of all bodies.
    pub keys: Vec<String>,
}

/// Returns a frame made from one of the seeds.
pub fn frame(random: &mut Random, seeds: &Seeds, reflector: &Reflector<'_>) -> Vec<u8> {
    if random.one_in(10) {
        let mut bytes = random.pick(&seeds.frames).clone();
        for _ in 0..=random.below(3) {
            change_a_byte(random, &mut bytes);
        }
        return bytes;
    }
    let some = if random.one_in(6) {
        &seeds.bad
    } else {
        &seeds.good
    };
    let (mut id, data) = random.pick(some).clone();
    if random.one_in(20) {
        // Combines the data with the header of another operation.
        id = random.pick(&seeds.good).0;
    }
    let mut data = match serde_json::from_slice(&data) {
        Ok(Value::Object(object)) => body(random, seeds, Value::Object(object)).into_bytes(),
        _ => data,
    };
    if random.one_in(12) {
        change_a_byte(random, &mut data);
    }
    let packing = if random.one_in(8) {
        Packing::Gzip { level: 6 }
    } else {
        Packing::Plain
    };
    let Ok(mut bytes) = reflector.seal(id, &data, packing) else {
        return data;
    };
    match random.below(16) {
        0 => change_the_header(random, &mut bytes),
        1 => change_sent_bytes(random, &mut bytes),
        _ => {}
    }
    bytes
}

/// Changes, inserts or removes one byte, or truncates the bytes.
fn change_a_byte(random: &mut Random, bytes: &mut Vec<u8>) {
    const BYTES: &[u8] = b"\x00\x01\x7F\x80\xFF{}[]\",:\\0e- \n";
    if bytes.is_empty() {
        bytes.push(b'{');
        return;
    }
    // Half of the changes hit the header, although it is short.
    let reach = if random.one_in(2) {
        FrameHeader::LEN
    } else {
        bytes.len()
    };
    let at = random.below(reach.min(bytes.len()));
    match random.below(6) {
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes[at] = *random.pick(BYTES),
        2 => bytes.insert(at, *random.pick(BYTES)),
        3 => drop(bytes.remove(at)),
        4 => bytes.truncate(at),
        _ => bytes[at] = random.next().to_le_bytes()[0],
    }
}

/// Changes one byte of the header in any field.
fn change_the_header(random: &mut Random, bytes: &mut [u8]) {
    let at = random.below(FrameHeader::LEN);
    bytes[at] = match random.below(3) {
        0 => bytes[at] ^ (1 << random.below(8)),
        1 => bytes[at].wrapping_add(1),
        _ => random.next().to_le_bytes()[0],
    };
}

/// Changes the data as sent and writes a header whose length and digest fit the new data.
fn change_sent_bytes(random: &mut Random, bytes: &mut Vec<u8>) {
    let Some(header) = FrameHeader::read(bytes) else {
        return;
    };
    let mut sent = bytes.split_off(FrameHeader::LEN);
    for _ in 0..=random.below(2) {
        // Most changes hit the header and trailer of the gzip member, although they are short.
        let at = match random.below(4) {
            _ if sent.is_empty() => break,
            0 | 1 => random.below(sent.len().min(12)),
            2 => sent.len() - 1 - random.below(sent.len().min(9)),
            _ => random.below(sent.len()),
        };
        match random.below(4) {
            0 => sent.truncate(at),
            1 => sent.insert(at, random.next().to_le_bytes()[0]),
            _ => sent[at] ^= 1 << random.below(8),
        }
    }
    let encoding = match header.encoding() {
        other if !random.one_in(6) => other,
        Fc::PLAIN => Fc::GZIP.unwrap_or(Fc::PLAIN),
        _ => Fc::PLAIN,
    };
    let head = if header.head() == Fc::RESPONSE_HEAD {
        Fc::RESPONSE_HEAD
    } else {
        Fc::REQUEST_HEAD
    };
    let plain = match random.below(8) {
        0 => 0,
        1 => header.plain_length() + 1,
        2 => 70_000_000,
        3 => 2_000_000,
        _ => header.plain_length(),
    };
    let total = u32::try_from(FrameHeader::LEN + sent.len()).unwrap();
    let mut header = FrameHeader::new(head, header.kind(), header.code(), header.id(), encoding);
    header.seal(total, plain, Md5::digest(&sent));
    assert!(header.write(bytes));
    bytes.extend(sent);
}

/// JSON whose scalars and keys keep their encoded spelling.
enum Json {
    Text(String),
    List(Vec<Json>),
    Object(Vec<(String, Json)>),
}

/// Values at the edges of types and grammar.
const VALUES: &[&str] = &[
    "null",
    "true",
    "false",
    "0",
    "-0",
    "1",
    "2",
    "1.0",
    "1e2",
    "5E-1",
    "-1",
    "127",
    "128",
    "255",
    "256",
    "65536",
    "1.5",
    "2147483648",
    "-2147483649",
    "9223372036854775807",
    "9223372036854775808",
    "-9223372036854775809",
    "18446744073709551615",
    "18446744073709551616",
    "1e400",
    "-1e400",
    "1e-400",
    "1e16",
    "0.1",
    "3.4028236e38",
    "100000000000000000000000000.0",
    "0.30000000000000004",
    "123456.789012",
    "1e-7",
    "-0.0",
    r#""""#,
    r#""0x14""#,
    r#""0X1g""#,
    r#""0x+1""#,
    r#""0xFFFFFFFFFFFFFFFFF""#,
    r#"" 1""#,
    r#""1 ""#,
    r#""300x""#,
    r#""99999999999999999999x""#,
    r#""1.0""#,
    r#""-5""#,
    r#""1e400""#,
    r#""1e400x""#,
    r#""true""#,
    r#""false""#,
    r#""truex""#,
    r#""\ud800""#,
    r#""a\ude00""#,
    r#""\ud83d\ude00""#,
    r#""\ud83d\ue000""#,
    r#""\u0000\b\f\n""#,
    r#""aGVsbG8=""#,
    r#""aGVsbG9=""#,
    r#""aGVsbG8""#,
    r#""号""#,
    r#""a\/b\"c""#,
    "{}",
    "[]",
    "{ }",
    "[ ]",
    "[[]]",
    "[1]",
    "[null]",
    r#"{"a":1}"#,
    r#"{"a":1,"a":2}"#,
    r#"{"\ud800":1}"#,
    // These are not JSON.
    "01",
    "+1",
    "1.",
    ".5",
    "1e",
    "nul",
    "NaN",
    "'a'",
    r#""\x41""#,
    r#""\u12""#,
    "\"\t\"",
    "{,}",
    "[1,]",
    "",
];

/// Returns a body with up to three changes.
fn body(random: &mut Random, seeds: &Seeds, value: Value) -> String {
    let mut json = taken(value);
    // Some bodies stay unchanged.
    for _ in 0..random.below(4) {
        change(random, seeds, &mut json, 0);
    }
    let mut out = String::new();
    let spaced = random.one_in(4);
    print(random, spaced, &json, &mut out);
    out
}

fn taken(value: Value) -> Json {
    match value {
        Value::Array(items) => Json::List(items.into_iter().map(taken).collect()),
        Value::Object(keys) => {
            let key = |text: String| Value::String(text).to_string();
            let keys = keys.into_iter();
            Json::Object(
                keys.map(|(name, value)| (key(name), taken(value)))
                    .collect(),
            )
        }
        other => Json::Text(other.to_string()),
    }
}

/// Changes one place of `json`. Places near the root change more often.
fn change(random: &mut Random, seeds: &Seeds, json: &mut Json, depth: usize) {
    let goes_deeper = depth == 0 || !random.one_in(3);
    match json {
        Json::Object(keys) if goes_deeper && !keys.is_empty() => {
            let at = random.below(keys.len());
            if depth > 0 || random.one_in(2) {
                change_keys(random, seeds, keys, at);
            } else {
                change(random, seeds, &mut keys[at].1, depth + 1);
            }
        }
        Json::List(items) if goes_deeper && !items.is_empty() => {
            let at = random.below(items.len());
            match random.below(6) {
                0 => drop(items.remove(at)),
                1 => items.insert(at, some_value(random)),
                _ => change(random, seeds, &mut items[at], depth + 1),
            }
        }
        other => {
            *other = match random.below(12) {
                0 => Json::List(vec![some_value(random), some_value(random)]),
                1 => Json::Object(vec![(some_key(random, seeds), some_value(random))]),
                2 => deep(random),
                _ => some_value(random),
            }
        }
    }
}

fn change_keys(random: &mut Random, seeds: &Seeds, keys: &mut Vec<(String, Json)>, at: usize) {
    match random.below(9) {
        0 => drop(keys.remove(at)),
        1 => {
            let twice = keys[at].0.clone();
            let place = random.below(keys.len() + 1);
            keys.insert(place, (twice, some_value(random)));
        }
        2 => keys[at].0 = some_key(random, seeds),
        3 => keys[at].0 = escaped(random, &keys[at].0),
        4 => {
            let place = random.below(keys.len() + 1);
            keys.insert(place, (some_key(random, seeds), some_value(random)));
        }
        5 => {
            for last in (1..keys.len()).rev() {
                keys.swap(last, random.below(last + 1));
            }
        }
        _ => change(random, seeds, &mut keys[at].1, 1),
    }
}

fn some_value(random: &mut Random) -> Json {
    Json::Text((*random.pick(VALUES)).to_owned())
}

/// Returns a key: mostly one of the spec in quotes, sometimes another or an invalid one.
fn some_key(random: &mut Random, seeds: &Seeds) -> String {
    const OTHERS: &[&str] = &[
        r#""x""#,
        r#""""#,
        r#""a\"b""#,
        r#""号""#,
        r#""\ud800""#,
        "a",
        r#""a\u0001""#,
        r#""0123456789012345678901234567890123456789012345678901234567890123号456789""#,
    ];
    if random.one_in(4) {
        return (*random.pick(OTHERS)).to_owned();
    }
    Value::String(random.pick(&seeds.keys).clone()).to_string()
}

/// Escapes one character of a key, which leaves its meaning unchanged.
fn escaped(random: &mut Random, key: &str) -> String {
    let characters: Vec<char> = key.chars().collect();
    if characters.len() < 3 {
        return key.to_owned();
    }
    let at = 1 + random.below(characters.len() - 2);
    let escape = |(place, character): (usize, &char)| match u16::try_from(u32::from(*character)) {
        Ok(unit) if place == at && character.is_alphanumeric() => format!("\\u{unit:04X}"),
        _ => character.to_string(),
    };
    characters.iter().enumerate().map(escape).collect()
}

/// Returns a list nested about as deep as the limit.
fn deep(random: &mut Random) -> Json {
    let depth = 58 + random.below(10);
    Json::Text("[".repeat(depth) + &"]".repeat(depth))
}

fn print(random: &mut Random, spaced: bool, json: &Json, out: &mut String) {
    const SPACES: &[&str] = &[" ", "\n", "\t", " \r\n"];
    if spaced && random.one_in(3) {
        let space: &&str = random.pick(SPACES);
        out.push_str(space);
    }
    match json {
        Json::Text(text) => out.push_str(text),
        Json::List(items) => {
            out.push('[');
            for (index, item) in items.iter().enumerate() {
                if index > 0 {
                    out.push(',');
                }
                print(random, spaced, item, out);
            }
            out.push(']');
        }
        Json::Object(keys) => {
            out.push('{');
            for (index, (key, value)) in keys.iter().enumerate() {
                if index > 0 {
                    out.push(',');
                }
                out.push_str(key);
                if spaced && random.one_in(3) {
                    out.push(' ');
                }
                out.push(':');
                print(random, spaced, value, out);
            }
            out.push('}');
        }
    }
    if spaced && random.one_in(4) {
        out.push(' ');
    }
}

/// Collects the seeds from the committed vectors.
pub fn seeds(files: &[(String, Value)], reflector: &Reflector<'_>) -> Seeds {
    let mut seeds = Seeds {
        frames: Vec::new(),
        good: Vec::new(),
        bad: Vec::new(),
        keys: Vec::new(),
    };
    for (_, file) in files {
        for list in ["accepted", "rejected"] {
            for vector in cases(file, list) {
                let Some(frame) = vector["frame"].as_str() else {
                    continue;
                };
                let frame = unhex(frame);
                if let Ok(taken) = reflector.frame(&frame) {
                    if let Ok(value) = serde_json::from_slice(&taken.data) {
                        collect_keys(&value, &mut seeds.keys);
                    }
                    let data = (taken.id, taken.data);
                    match list {
                        "accepted" => seeds.good.push(data),
                        _ => seeds.bad.push(data),
                    }
                }
                seeds.frames.push(frame);
            }
        }
    }
    seeds.keys.sort();
    seeds.keys.dedup();
    seeds
}

fn collect_keys(value: &Value, keys: &mut Vec<String>) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| collect_keys(item, keys)),
        Value::Object(object) => {
            for (key, value) in object {
                keys.push(key.clone());
                collect_keys(value, keys);
            }
        }
        _ => {}
    }
}
