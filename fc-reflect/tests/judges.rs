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

use fc_generated::Fc;
use fc_reflect::Reflector;
use fc_runtime::Protocol as _;
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
        let mut judge = |seed: u64| {
            let bytes = mutate::frame(&mut Random(seed), &seeds, &reflector);
            let wanted = typed.verdict(&bytes, Fc::DEFAULTS.limits.json());
            *found.entry(wanted.name()).or_default() += 1;
            let answer = answers.next().map(|line| line.expect("a line of text"));
            match answer {
                Some(answer) if agrees(&wanted, &answer) => None,
                answer => Some(format!(
                    "{name}, seed {seed}: {answer:?}\nwanted {wanted:?}\nof {}",
                    hex(&bytes)
                )),
            }
        };
        let fault = thread::scope(|scope| {
            let (seeds, reflector) = (&seeds, &reflector);
            scope.spawn(move || send(frames, first..first + count, seeds, reflector));
            let fault = (first..first + count).find_map(&mut judge);
            if fault.is_some() {
                // It may not read on, and then nobody could go on writing.
                child.kill().expect("it is there");
            }
            fault
        });
        assert!(fault.is_none(), "{}", fault.unwrap_or_default());
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

/// Whether a judge's line says what is wanted.
fn agrees(wanted: &Verdict, line: &str) -> bool {
    let Ok(Value::Array(answer)) = serde_json::from_str(line) else {
        return false;
    };
    let word = |at: usize| answer.get(at).and_then(Value::as_str);
    let int = |at: usize| answer.get(at).and_then(Value::as_u64);
    match wanted {
        Verdict::Refused(name, path, _) => {
            // Of what is no JSON, a judge need not know where in the message it is. Here a key stands as it was written.
            let knows_place = word(2) != Some("") && !path.contains('\\');
            word(0) == Some("refused")
                && word(1) == Some(name)
                && (!knows_place || word(2) == Some(path))
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

/// The same JSON: numbers and texts may be spelled in other ways.
fn same_text(one: &[u8], other: &[u8]) -> bool {
    let read = |text| serde_json::from_slice::<Value>(text).ok();
    one == other
        || read(one).is_some_and(|one| read(other).is_some_and(|other| same_value(&one, &other)))
}

fn same_value(one: &Value, other: &Value) -> bool {
    match (one, other) {
        // 10 is 10.0.
        (Value::Number(one), Value::Number(other)) if one.is_f64() != other.is_f64() => {
            one.as_f64() == other.as_f64()
        }
        (Value::Array(one), Value::Array(other)) => {
            let same = |(one, other)| same_value(one, other);
            one.len() == other.len() && one.iter().zip(other).all(same)
        }
        (Value::Object(one), Value::Object(other)) => {
            let same = |(key, one)| other.get(key).is_some_and(|other| same_value(one, other));
            one.len() == other.len() && one.iter().all(same)
        }
        _ => one == other,
    }
}
