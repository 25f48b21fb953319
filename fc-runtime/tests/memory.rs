//! The memory of messages, measured by an allocator.

#![allow(clippy::unwrap_used, reason = "a test may")]

#[allow(
    dead_code,
    clippy::expect_used,
    clippy::indexing_slicing,
    reason = "a part of it is used here"
)]
#[path = "it/common/mod.rs"]
mod common;

use common::Toy;
use fc_derive::{Message, OneOf, OpenEnum};
use fc_runtime::json::{decode, to_vec};
use fc_runtime::{Allowance, Bytes64, Decoder, Encoder, Extra, Gzip, Json, read_enveloped};
use peak_alloc::PeakAlloc;
use std::sync::{Mutex, PoisonError};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Tests of one process share its allocator.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Returns the result of `work`, the peak memory during it, and the memory of its result, in bytes beyond those held
/// before.
fn measured<T>(work: impl FnOnce() -> T) -> (T, usize, usize) {
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let result = work();
    let peak = ALLOCATOR.peak_usage().saturating_sub(before);
    let held = ALLOCATOR.current_usage().saturating_sub(before);
    (result, peak, held)
}

const MIB: usize = 1 << 20;

#[derive(Clone, Debug, PartialEq, Message)]
struct Open {
    known: Option<i64>,
    #[fc(extra)]
    extra: Extra,
}

/// An object of `members`, so many that the text has `length` bytes or a few less.
fn object_of(member: &str, length: usize) -> String {
    let members = vec![member; length.saturating_sub(2) / (member.len() + 1)];
    format!("{{{}}}", members.join(","))
}

#[fc_test::test]
fn unknown_keys_cost_their_text() {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    for member in [
        "\"a\":[]",
        "\"a\":{}",
        "\"\":0",
        "\"\\u0061\":\"b\"",
        "\"\\n\":[1]",
    ] {
        let text = object_of(member, MIB);
        let (open, peak, held) =
            measured(|| decode::<Open>(text.as_bytes(), Allowance::depth(64)).unwrap());
        // A growing buffer is in memory twice while it is moved.
        assert!(
            held <= text.len() + 1024,
            "{member}: {held} of {}",
            text.len()
        );
        assert!(
            peak <= text.len() * 2 + 1024,
            "{member}: {peak} of {}",
            text.len()
        );
        assert!(to_vec(&open).len() <= text.len());
    }
}

/// Many fields, none of them required: `{}` is one.
#[derive(Clone, Debug, Default, PartialEq, Message)]
struct Wide {
    a: Option<String>,
    b: Option<String>,
    c: Option<String>,
    d: Option<String>,
    e: Option<i64>,
    f: Option<i64>,
    g: Option<Vec<Wide>>,
    #[fc(extra)]
    extra: Extra,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Lists {
    wide: Option<Vec<Wide>>,
    numbers: Option<Vec<i64>>,
    nested: Option<Vec<Vec<Vec<i64>>>>,
    text: Option<String>,
    bytes: Option<Bytes64>,
    left: Option<Either>,
    kind: Option<Kind>,
    any: Option<Json>,
}

#[derive(Clone, Debug, PartialEq, OneOf)]
enum Either {
    Left(Left),
    Right(Right),
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Left {
    left: u8,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Right {
    right: u8,
    #[fc(extra)]
    extra: Extra,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = str)]
enum Kind {
    #[fc(value = "on")]
    On,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Required {
    needed: u8,
    #[fc(extra)]
    extra: Extra,
}

/// Texts of about `length` bytes with a large result.
fn bombs(length: usize) -> Vec<(&'static str, String)> {
    let list = |key: &str, item: &str| {
        let items = vec![item; length / (item.len() + 1)].join(",");
        format!("{{\"{key}\":[{items}]}}")
    };
    let long = |start: &str, piece: &str, end: &str| {
        format!("{start}{}{end}", piece.repeat(length / piece.len()))
    };
    let distinct = || {
        let keys = (0..length / 12).map(|key| format!("\"{key:07}\":0"));
        keys.collect::<Vec<_>>().join(",")
    };
    vec![
        ("unknown keys", object_of("\"x\":[]", length)),
        ("empty unknown keys", object_of("\"\":0", length)),
        ("distinct unknown keys", format!("{{{}}}", distinct())),
        (
            "duplicates of a known key",
            object_of("\"text\":\"\"", length),
        ),
        ("duplicates of a list", object_of("\"wide\":[{}]", length)),
        ("empty objects", list("wide", "{}")),
        ("empty objects in lists", list("wide", "{\"g\":[{}]}")),
        ("numbers", list("numbers", "0")),
        ("empty lists", list("nested", "[]")),
        ("lists of empty lists", list("nested", "[[],[]]")),
        ("unknown empty lists", list("x", "[]")),
        ("a string", long("{\"text\":\"", "x", "\"}")),
        ("escapes", long("{\"text\":\"", "\\n", "\"}")),
        ("an escape at last", long("{\"text\":\"", "x", "\\n\"}")),
        ("bytes", long("{\"bytes\":\"", "AAAA", "\"}")),
        (
            "bytes with an escape",
            long("{\"bytes\":\"\\u0041AAA", "AAAA", "\"}"),
        ),
        ("a value of no enum", long("{\"kind\":\"", "x", "\"}")),
        (
            "a value of no enum, escaped",
            long("{\"kind\":\"", "\\n", "\"}"),
        ),
        (
            "a choice of many keys",
            format!("{{\"left\":{{{},\"right\":1}}}}", distinct()),
        ),
        (
            "no choice of many keys",
            format!("{{\"left\":{{{}}}}}", distinct()),
        ),
        ("an open value", long("{\"any\":[", "[],", "[]]}")),
        ("a deep fault", long("{\"any\":[", "[],", "")),
    ]
}

/// Receiving, inflating and reading together, for each byte received or inflated.
const FACTOR: usize = 4;

/// Memory independent of the frame: the receive buffer, the state of the decompressor, and growing lists.
const CONSTANT: usize = MIB / 2;

#[fc_test::test]
fn frame_costs_little_more_than_its_bytes() {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let allowance = Allowance {
        list_bytes: MIB / 8,
        ..Allowance::depth(64)
    };
    for (name, text) in bombs(MIB / 4) {
        for from_bytes in [0, usize::MAX] {
            let gzip = Gzip {
                from_bytes,
                level: 9,
            };
            let mut bytes = Vec::new();
            let mut encoder = Encoder::<Toy>::new().gzip(gzip);
            let id = common::command(1, 1);
            encoder.bytes(&mut bytes, id, text.as_bytes()).unwrap();
            drop(encoder);
            let (_, peak, _) = measured(|| {
                let mut decoder = Decoder::<Toy>::new();
                // In pieces, like from a socket.
                bytes.chunks(1500).for_each(|piece| decoder.push(piece));
                let frame = decoder.next().unwrap().unwrap();
                let read = read_enveloped::<Required, Lists>(frame.body(), allowance);
                // Held together, as while a handler runs.
                (decoder, read)
            });
            let inflated = if from_bytes == 0 { text.len() } else { 0 };
            let allowed = FACTOR * (bytes.len() + inflated) + CONSTANT;
            assert!(peak <= allowed, "{name}: {peak} of {allowed}");
        }
    }
}

#[fc_test::test]
fn no_text_costs_much_more_than_its_length() {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    // Lists have their own limit, which includes their growth.
    let allowance = Allowance {
        list_bytes: MIB / 8,
        ..Allowance::depth(64)
    };
    for (name, text) in bombs(MIB / 4) {
        let bytes = text.as_bytes();
        let allowed = 3 * text.len() + MIB / 4;
        let (_, peak, _) = measured(|| decode::<Lists>(bytes, allowance));
        assert!(peak <= allowed, "{name}: {peak} for {}", text.len());
        let (_, peak, _) = measured(|| read_enveloped::<Required, Lists>(bytes, allowance));
        assert!(
            peak <= allowed,
            "{name}, beside an envelope: {peak} for {}",
            text.len()
        );
        let (_, peak, _) = measured(|| decode::<Required>(bytes, allowance));
        assert!(
            peak <= allowed,
            "{name}, without a required key: {peak} for {}",
            text.len()
        );
    }
}

/// Memory limit of the robots in these tests.
const MEMORY: usize = 16 * MIB;

/// Everything at once: endless frames, bombs of keys, unread responses, waiting requests.
#[fc_test::test]
fn a_robot_stays_within_its_memory() {
    use common::net::{Robot, loopback, service};
    use common::{Echo, LIMITS, command, frame};
    use fc_runtime::{Command, Limits};
    use tokio::io::AsyncWriteExt;

    const PIPE: usize = 64 * 1024;
    const APPS: usize = 40;

    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let id = command(Echo::CODE, 1);
    let mut unfinished = frame(id, &vec![b' '; MIB]);
    unfinished.pop();
    let answered = frame(
        id,
        format!(r#"{{"text":"{}"}}"#, "x".repeat(MIB)).as_bytes(),
    );
    let mut bomb = Vec::new();
    let gzip = Gzip {
        from_bytes: 0,
        level: 9,
    };
    Encoder::<Toy>::new()
        .gzip(gzip)
        .bytes(&mut bomb, id, object_of("\"a\":[]", 2 * MIB).as_bytes())
        .unwrap();
    let attacks = [unfinished, answered, bomb.repeat(4)];
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .unwrap();
    let ((), peak, _) = measured(|| {
        runtime.block_on(async {
            let limits = Limits {
                connections: APPS,
                json_values: usize::MAX,
                ..LIMITS
            };
            let config = loopback().limits(limits).memory(MEMORY);
            let robot = Robot::start(config, service).await;
            let mut apps = Vec::new();
            for attack in attacks.iter().cycle().take(APPS) {
                let (mut app, stream) = tokio::io::duplex(PIPE);
                robot.handle.serve(stream, common::net::nowhere()).unwrap();
                let _ = app.write_all(attack).await;
                for _ in 0..100 {
                    tokio::task::yield_now().await;
                }
                apps.push(app);
            }
            assert!(robot.handle.counters().connections_evicted > 0);
        });
    });
    let pipes = APPS * 2 * PIPE;
    assert!(peak <= MEMORY + pipes, "{peak}");
    assert!(peak > MEMORY / 2, "the attack is one: {peak}");
}
