//! Compares the decoders of other languages with the one in Rust, on the same bytes.
//!
//! `FC_JUDGES='python=stubs/python/run judge;cpp=stubs/cpp/run judge'` lists the judges, each with its command from the
//! project's root. `FC_FRAMES` and `FC_SEED` are as in `agreement`. Alternatively, `FC_FOREIGN` names a folder of JSON
//! files. All decoders must accept the files called `y_…` and refuse those called `n_…`.
//!
//! A judge reads frames in hex, one per line. It writes one line for each frame, a list in JSON:
//!
//! - `["refused", "out_of_range", "data.mode"]`: the name of the error, and the path in the body. The path is empty if
//!   the frame itself is wrong.
//! - `["message", 0, 1, 2564, 7, "{…}"]`: 1 for a response, then kind, code and ID of the header, and the encoded
//!   message.
//! - `["bytes", 0, 3, 513, 7, "0a0b"]`: the same for a frame without a message, with its data in hex.

use crate::mutate::{self, Random};
use crate::support::typed::{Typed, Verdict};
use crate::support::{self, hex, number};
use fc_generated::{Fc, FrameHeader};
use fc_reflect::Reflector;
use fc_runtime::{Encoder, FrameId, Header as _, Protocol as _};
use fc_spec::model::{self, Model};
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::Value;
use serde_json::value::RawValue;
use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader, BufWriter, Write as _};
use std::iter::zip;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread;
use std::{fmt, fs};

#[test]
fn judges_agree() {
    let Ok(judges) = std::env::var("FC_JUDGES") else {
        println!("skipped: FC_JUDGES names no decoder in another language");
        return;
    };
    let model = support::specs::model();
    let reflector = Reflector::new(&model);
    let seeds = mutate::seeds(&support::vectors(), &reflector);
    let typed = Typed::new(&model);
    let foreign = std::env::var("FC_FOREIGN").map(|folder| foreign_frames(&folder, &model));
    let (first, count) = match &foreign {
        Ok(frames) => (0, frames.len() as u64),
        Err(_) => (
            number("FC_SEED", 0).wrapping_mul(1 << 32),
            number("FC_FRAMES", 20_000),
        ),
    };
    let frame = |number: u64| match &foreign {
        Ok(frames) => frames[usize::try_from(number).unwrap()].1.clone(),
        Err(_) => mutate::frame(&mut Random(number), &seeds, &reflector),
    };
    for (number, (name, bytes)) in foreign.iter().flatten().enumerate() {
        let verdict = typed.verdict(bytes, Fc::DEFAULTS.limits.json());
        let is_taken = matches!(verdict, Verdict::Taken { .. });
        // Odd frames have the JSON as a value. Even frames have it as a body, which must be an object and may be empty.
        let is_value = number % 2 == 1;
        let expected = name.starts_with("y_");
        if is_value && (expected || name.starts_with("n_")) {
            assert_eq!(is_taken, expected, "{name}");
        }
    }
    for judge in judges.split(';') {
        let (name, command) = judge.split_once('=').expect("name=command");
        let mut child = start(command);
        let frames = child.stdin.take().expect("a pipe");
        let mut answers = BufReader::new(child.stdout.take().expect("a pipe")).lines();
        let mut found: BTreeMap<&str, u64> = BTreeMap::new();
        // The first disagreement of each kind, and their number.
        let mut faults: BTreeMap<String, (String, u64)> = BTreeMap::new();
        thread::scope(|scope| {
            let frame = &frame;
            let mut listening = Listening {
                judge: &mut child,
                is_content: false,
            };
            scope.spawn(move || send(frames, (first..first + count).map(frame)));
            for seed in first..first + count {
                let bytes = frame(seed);
                let wanted = typed.verdict(&bytes, Fc::DEFAULTS.limits.json());
                *found.entry(wanted.name()).or_default() += 1;
                let answer = answers.next().map(|line| line.expect("a line of text"));
                if answer
                    .as_ref()
                    .is_some_and(|line| agrees(&wanted, line, packed(&bytes)))
                {
                    continue;
                }
                let said = answer.as_deref().map_or_else(|| "nothing".into(), summary);
                let kind = format!("{}, where {name} says {said}", wanted.name());
                let first = || {
                    let bytes = hex(&bytes);
                    format!("seed {seed}: {answer:?}\nwanted {wanted:?}\nof {bytes}")
                };
                faults.entry(kind).or_insert_with(|| (first(), 0)).1 += 1;
                if answer.is_none() {
                    break;
                }
            }
            listening.is_content = faults.is_empty();
        });
        for (kind, (first, times)) in &faults {
            println!("{times} times {kind}, first with {first}\n");
        }
        assert!(faults.is_empty(), "{name} disagrees");
        assert!(child.wait().expect("it ends").success(), "{name}");
        println!("{name}: {count} frames: {found:?}");
        let is_varied = found["taken"] * 10 > count && found.len() > 20;
        assert!(is_varied || foreign.is_ok(), "{found:?}");
    }
}

/// Wraps each file of a folder in requests of an unknown command: once as the body, and once as the value of a key.
/// Each request comes with the name of its file.
fn foreign_frames(folder: &str, model: &Model) -> Vec<(String, Vec<u8>)> {
    let files = fs::read_dir(folder).expect("the folder of FC_FOREIGN");
    let mut files: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    files.sort();
    let taken = model.taken_codes();
    let mut codes = (0..=u16::MAX).filter(|code| !taken.contains(code));
    let id = FrameId {
        response: false,
        kind: Fc::COMMAND,
        code: codes.next().expect("a free code"),
        id: 1,
    };
    let envelope = model.envelope.request.iter();
    let envelope = envelope.map(|it| (it.wire.clone(), model::Value::from(&it.example)));
    let envelope = model::Value::Object(envelope.collect()).to_string();
    let beside = match envelope.strip_suffix('}').expect("an object") {
        "{" => "{\"value\":".to_owned(),
        some => format!("{some},\"value\":"),
    };
    let frames = files.iter().flat_map(|file| {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let text = fs::read(file).unwrap();
        let wrapped = [beside.as_bytes(), &*text, b"}"].concat();
        [text, wrapped].map(|body| {
            let mut frame = Vec::new();
            let encoded = Encoder::<Fc>::new().bytes(&mut frame, id, &body);
            encoded.expect("it is short");
            (name.clone().into_owned(), frame)
        })
    });
    frames.collect()
}

/// Kills a judge that disagrees or whose output is invalid. Such a judge may stop reading, which would block the
/// writer.
struct Listening<'c> {
    judge: &'c mut Child,
    is_content: bool,
}

impl Drop for Listening<'_> {
    fn drop(&mut self) {
        if !self.is_content {
            // The judge may have ended already.
            let _ = self.judge.kill();
        }
    }
}

fn start(command: &str) -> Child {
    let mut shell = Command::new("bash");
    shell
        .args(["-c", command])
        .current_dir(support::specs::root());
    let piped = shell.stdin(Stdio::piped()).stdout(Stdio::piped());
    piped.spawn().expect("bash")
}

/// Writes the frames. It stops early when the judge no longer reads; the responses show the reason.
fn send(pipe: ChildStdin, frames: impl Iterator<Item = Vec<u8>>) {
    let mut pipe = BufWriter::new(pipe);
    for bytes in frames {
        if writeln!(pipe, "{}", hex(&bytes)).is_err() {
            return;
        }
    }
}

/// Returns the verdict of a judge's line without its details.
fn summary(line: &str) -> String {
    match serde_json::from_str::<Value>(line) {
        Ok(Value::Array(answer)) => {
            let word = |at: usize| answer.get(at).and_then(Value::as_str).unwrap_or_default();
            word(usize::from(word(0) == "refused")).to_owned()
        }
        _ => "what is no list".into(),
    }
}

/// Returns `true` if the header marks the data as compressed.
fn packed(bytes: &[u8]) -> bool {
    FrameHeader::read(bytes).is_some_and(|header| Some(header.encoding()) == Fc::GZIP)
}

/// Returns `true` if a judge's line matches the expected verdict.
fn agrees(wanted: &Verdict, line: &str, packed: bool) -> bool {
    let Ok(Value::Array(answer)) = serde_json::from_str(line) else {
        return false;
    };
    let word = |at: usize| answer.get(at).and_then(Value::as_str);
    let int = |at: usize| answer.get(at).and_then(Value::as_u64);
    match wanted {
        Verdict::Refused(name, path, _) => {
            // A judge need not locate malformed JSON. Paths with escapes are not compared, because this side keeps keys
            // as written.
            let knows_place = word(2) != Some("") && !path.contains('\\');
            // Data that is too long and also damaged may get either name. That depends on how far a library has
            // inflated it.
            let name_agrees = word(1) == Some(name)
                || (packed && *name == "plain_length_mismatch" && word(1) == Some("bad_gzip"));
            word(0) == Some("refused") && name_agrees && (!knows_place || word(2) == Some(path))
        }
        Verdict::Taken {
            response,
            kind,
            code,
            id,
            data,
        } => {
            let header = [
                u64::from(*response),
                (*kind).into(),
                (*code).into(),
                (*id).into(),
            ];
            let same = (1..)
                .zip(header)
                .all(|(at, wanted)| int(at) == Some(wanted));
            let text = word(5).unwrap_or_default();
            same && match word(0) {
                Some("message") => same_text(data, text.as_bytes()),
                Some("bytes") => hex(data) == text,
                _ => false,
            }
        }
    }
}

/// Compares two JSON values with the same order of keys. Numbers and strings may be spelled differently. Data that
/// passes through unread may contain half of a surrogate pair or a duplicate key, which `Value` cannot hold.
fn same_text(one: &[u8], other: &[u8]) -> bool {
    let value = |bytes| serde_json::from_slice::<&RawValue>(bytes).ok();
    one == other || value(one).is_some_and(|one| value(other).is_some_and(|other| same(one, other)))
}

fn same(one: &RawValue, other: &RawValue) -> bool {
    /// Reads both as `T` and compares them; `false` if one of them is not a `T`.
    fn both<'r, T: Deserialize<'r>>(
        one: &'r RawValue,
        other: &'r RawValue,
        are_same: impl Fn(&T, &T) -> bool,
    ) -> bool {
        let read = |raw: &'r RawValue| serde_json::from_str::<T>(raw.get());
        matches!((read(one), read(other)), (Ok(one), Ok(other)) if are_same(&one, &other))
    }

    let first = |raw: &RawValue| raw.get().as_bytes()[0];
    match (first(one), first(other)) {
        (b'{', b'{') => both(one, other, |Entries(one), Entries(other)| {
            all_same(one, other)
        }),
        (b'[', b'[') => both(one, other, |one: &Vec<_>, other| all_same(one, other)),
        (b'"', b'"') => both(one, other, |Text(one), Text(other)| one == other),
        // This also compares `true`, `false` and `null`, by their spelling.
        _ => same_number(one.get(), other.get()),
    }
}

fn all_same(one: &[&RawValue], other: &[&RawValue]) -> bool {
    one.len() == other.len() && zip(one, other).all(|(one, other)| same(one, other))
}

/// Treats 10, 10.0 and 1e1 as equal. Two integers are compared by their digits, because a double cannot tell large
/// neighbours apart.
fn same_number(one: &str, other: &str) -> bool {
    let is_float = |number: &str| number.contains(['.', 'e', 'E']);
    let value = |number: &str| number.parse().ok().filter(|value: &f64| value.is_finite());
    one == other
        || ((is_float(one) || is_float(other))
            && value(one).is_some_and(|one| value(other) == Some(one)))
}

/// The keys and values of an object in turn, as written.
struct Entries<'r>(Vec<&'r RawValue>);

impl<'r> Deserialize<'r> for Entries<'r> {
    fn deserialize<D: Deserializer<'r>>(deserializer: D) -> Result<Self, D::Error> {
        struct Seen;
        impl<'r> Visitor<'r> for Seen {
            type Value = Entries<'r>;

            fn expecting(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
                text.write_str("an object")
            }

            fn visit_map<A: MapAccess<'r>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some((key, value)) = map.next_entry()? {
                    entries.extend::<[&RawValue; 2]>([key, value]);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(Seen)
    }
}

/// The content of a string in WTF-8, which can hold half of a surrogate pair.
struct Text(Vec<u8>);

impl<'r> Deserialize<'r> for Text {
    fn deserialize<D: Deserializer<'r>>(deserializer: D) -> Result<Self, D::Error> {
        struct Seen;
        impl Visitor<'_> for Seen {
            type Value = Text;

            fn expecting(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
                text.write_str("a text")
            }

            fn visit_bytes<E>(self, bytes: &[u8]) -> Result<Text, E> {
                Ok(Text(bytes.to_vec()))
            }
        }
        deserializer.deserialize_bytes(Seen)
    }
}

#[test]
fn the_same_json_may_be_spelled_otherwise() {
    for (one, other) in [
        (
            r#"{"a": [1, 10.0], "b": null}"#,
            r#"{"a":[1.0,1e1],"b":null}"#,
        ),
        (r#"{"\u0061":"\u00e9\/\n"}"#, r#"{"a":"é/\u000a"}"#),
        (r#"["\ud83d\ude00", "\uD83D"]"#, r#"["😀","\ud83d"]"#),
        (
            r#"{"\udc00":18446744073709551617}"#,
            r#"{"\uDC00":18446744073709551617}"#,
        ),
        ("[1e400, 0.1]", "[1e400,0.10]"),
        (r#"{"k":1,"k":2}"#, r#"{"k":1,"k":2}"#),
    ] {
        assert!(same_text(one.as_bytes(), other.as_bytes()), "{one} {other}");
    }
    for (one, other) in [
        ("9007199254740993", "9007199254740992"),
        ("1e400", "1e401"),
        ("1", "2"),
        ("1", r#""1""#),
        ("true", "false"),
        ("[]", "{}"),
        ("[1,2]", "[1]"),
        ("[1]", "[[1]]"),
        (r#"{"a":1,"b":2}"#, r#"{"b":2,"a":1}"#),
        (r#"{"k":1,"k":2}"#, r#"{"k":1}"#),
        (r#"{"k":1,"k":2}"#, r#"{"k":2,"k":1}"#),
        (r#""\ud83d""#, r#""\ud83c""#),
        (r#"{"\ud83d":1}"#, r#"{"\ud83c":1}"#),
        (r#""\ud83d""#, r#""\ufffd""#),
        ("[1", "[1 "),
    ] {
        assert!(
            !same_text(one.as_bytes(), other.as_bytes()),
            "{one} {other}"
        );
    }
}
