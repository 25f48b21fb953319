//! Decoders in other languages make the same of the same bytes as the one in Rust.
//!
//! `FC_JUDGES='python=stubs/python/run judge;cpp=stubs/cpp/run judge'` names them, each with its command from the
//! project's root. `FC_FRAMES` and `FC_SEED` are as in `agreement`.
//!
//! A judge reads frames, each in hex on a line of its own, and answers each with a line, a list in JSON:
//!
//! - `["refused", "out_of_range", "data.mode"]`: the error's name, and the path in the body, empty for the frame's own;
//! - `["message", 0, 1, 2564, 7, "{…}"]`: 1 for a response, kind, code and id of the header, and the message as it is
//!   written again;
//! - `["bytes", 0, 3, 513, 7, "0a0b"]`: the same of what has no message: its data in hex.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    clippy::unwrap_used,
    missing_docs,
    reason = "tests"
)]

#[path = "agreement/mutate.rs"]
mod mutate;
mod support;

use fc_generated::{Fc, FrameHeader};
use fc_reflect::Reflector;
use fc_runtime::{Header as _, Protocol as _};
use mutate::{Random, Seeds};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader, BufWriter, Write as _};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread;
use support::typed::{Typed, Verdict};
use support::{hex, number};

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
    let count = number("FC_FRAMES", 20_000);
    let first = number("FC_SEED", 0).wrapping_mul(1 << 32);
    for judge in judges.split(';') {
        let (name, command) = judge.split_once('=').expect("name=command");
        let mut child = start(command);
        let frames = child.stdin.take().expect("a pipe");
        let mut answers = BufReader::new(child.stdout.take().expect("a pipe")).lines();
        let mut found: BTreeMap<&str, u64> = BTreeMap::new();
        // The first of each kind of disagreement, and how many there are of it.
        let mut faults: BTreeMap<String, (String, u64)> = BTreeMap::new();
        thread::scope(|scope| {
            let (seeds, reflector) = (&seeds, &reflector);
            scope.spawn(move || send(frames, first..first + count, seeds, reflector));
            for seed in first..first + count {
                let bytes = mutate::frame(&mut Random(seed), seeds, reflector);
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
        });
        for (kind, (first, times)) in &faults {
            println!("{times} times {kind}, first with {first}\n");
        }
        assert!(faults.is_empty(), "{name} disagrees");
        assert!(child.wait().expect("it ends").success(), "{name}");
        println!("{name}: {count} frames: {found:?}");
        assert!(found["taken"] * 10 > count && found.len() > 20, "{found:?}");
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

/// Ends early where nobody reads any more; the reason shows in the answers.
fn send(
    pipe: ChildStdin,
    numbers: impl Iterator<Item = u64>,
    seeds: &Seeds,
    reflector: &Reflector<'_>,
) {
    let mut pipe = BufWriter::new(pipe);
    for seed in numbers {
        let bytes = mutate::frame(&mut Random(seed), seeds, reflector);
        if writeln!(pipe, "{}", hex(&bytes)).is_err() {
            return;
        }
    }
}

/// What a judge's line says, without its details.
fn summary(line: &str) -> String {
    match serde_json::from_str::<Value>(line) {
        Ok(Value::Array(answer)) => match answer[0].as_str() {
            Some("refused") => answer[1].as_str().unwrap_or_default().to_owned(),
            word => word.unwrap_or_default().to_owned(),
        },
        _ => "what is no list".into(),
    }
}

/// Whether the data of a frame is said to be compressed.
fn packed(bytes: &[u8]) -> bool {
    FrameHeader::read(bytes).is_some_and(|header| Some(header.encoding()) == Fc::GZIP)
}

/// Whether a judge's line says what is wanted.
fn agrees(wanted: &Verdict, line: &str, packed: bool) -> bool {
    let Ok(Value::Array(answer)) = serde_json::from_str(line) else {
        return false;
    };
    let word = |at: usize| answer.get(at).and_then(Value::as_str);
    let int = |at: usize| answer.get(at).and_then(Value::as_u64);
    match wanted {
        Verdict::Refused(name, path, _) => {
            // Of what is no JSON, a judge need not know where in the message it is. Here a key stands as it was written.
            let knows_place = word(2) != Some("") && !path.contains('\\');
            // What is too long and damaged besides may be called either: it depends on how far a library has unpacked it.
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

/// The same JSON, token by token: numbers and texts may be spelled in other ways. What is passed on as it came may hold what
/// no reader takes for a value, such as half of a surrogate pair.
fn same_text(one: &[u8], other: &[u8]) -> bool {
    let text = |bytes| std::str::from_utf8(bytes).ok();
    one == other
        || text(one)
            .is_some_and(|one| text(other).is_some_and(|other| tokens(one) == tokens(other)))
}

enum Token<'t> {
    Mark(char),
    /// `true`, `false`, `null`.
    Word(&'t str),
    Number(&'t str),
    /// In UTF-16, which has room for halves of pairs.
    Text(Vec<u16>),
}

impl PartialEq for Token<'_> {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Number(one), Self::Number(other)) => same_number(one, other),
            (Self::Mark(one), Self::Mark(other)) => one == other,
            (Self::Word(one), Self::Word(other)) => one == other,
            (Self::Text(one), Self::Text(other)) => one == other,
            _ => false,
        }
    }
}

/// 10 is 10.0 and 1e1. Past what a double tells from its neighbours, integers are compared by their digits.
fn same_number(one: &str, other: &str) -> bool {
    let is_float = |number: &str| number.contains(['.', 'e', 'E']);
    let value = |number: &str| number.parse().ok().filter(|value: &f64| value.is_finite());
    one == other
        || ((is_float(one) || is_float(other))
            && value(one).is_some_and(|one| value(other) == Some(one)))
}

fn tokens(mut text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    loop {
        text = text.trim_ascii_start();
        let Some(first) = text.chars().next() else {
            return tokens;
        };
        let (token, length) = match first {
            '"' => {
                let mut escaped = false;
                let end = text.bytes().skip(1).position(|byte| {
                    let ends = byte == b'"' && !escaped;
                    escaped = byte == b'\\' && !escaped;
                    ends
                });
                let end = end.expect("a closing quote") + 1;
                (Token::Text(units(&text[1..end])), end + 1)
            }
            '-' | '0'..='9' | 'a'..='z' => {
                let ends = |it: char| !it.is_ascii_alphanumeric() && !"+-.".contains(it);
                let word = &text[..text.find(ends).unwrap_or(text.len())];
                let token = if first.is_ascii_alphabetic() {
                    Token::Word(word)
                } else {
                    Token::Number(word)
                };
                (token, word.len())
            }
            mark => (Token::Mark(mark), mark.len_utf8()),
        };
        tokens.push(token);
        text = &text[length..];
    }
}

/// What stands between the quotes of a text.
fn units(text: &str) -> Vec<u16> {
    let mut units = Vec::new();
    let mut rest = text.chars();
    while let Some(character) = rest.next() {
        let character = if character == '\\' {
            match rest.next().expect("an escape") {
                'u' => {
                    let digits: String = rest.by_ref().take(4).collect();
                    units.push(u16::from_str_radix(&digits, 16).expect("four hex digits"));
                    continue;
                }
                'b' => '\u{8}',
                'f' => '\u{c}',
                'n' => '\n',
                'r' => '\r',
                't' => '\t',
                other => other,
            }
        } else {
            character
        };
        units.extend_from_slice(character.encode_utf16(&mut [0; 2]));
    }
    units
}
