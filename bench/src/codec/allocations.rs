//! Allocations per frame, which the twin counts.

use super::frames::{GZIP, encoded, read};
use crate::report::{Table, Text, t};
use crate::twin::{self, Allocations};
use fc_bench_cases::messages;
use fc_generated::Fc;
use fc_runtime::{Decoder, Encoder, FrameId, Gzip, Message};
use std::hint::black_box;
use std::process::Command;

/// Number of counted frames. As many frames before them let the buffers grow.
const FRAMES: usize = 16;

/// Names of the messages that the twin prints.
const NAMES: &[&str] = &["small", "medium", "medium_text", "large", "small gzip", "medium gzip"];

fn count(mut work: impl FnMut()) -> Allocations {
    for _ in 0..FRAMES {
        work();
    }
    let before = twin::allocations();
    for _ in 0..FRAMES {
        work();
    }
    let after = twin::allocations();
    Allocations { new: (after.new - before.new) / FRAMES, resized: (after.resized - before.resized) / FRAMES }
}

/// Prints a line for each message, with the allocations of its values, of decoding and of encoding. Only the twin
/// counts them.
pub fn print() {
    let station = messages::station_id();
    let small = messages::small(messages::STATION);
    let medium = messages::medium();
    print_one(NAMES[0], None, station, &small);
    print_one(NAMES[1], None, station, &medium);
    print_one(NAMES[2], None, station, &messages::medium_text());
    print_one(NAMES[3], None, messages::map_id(), &messages::large());
    print_one(NAMES[4], Some(GZIP), station, &small);
    print_one(NAMES[5], Some(GZIP), station, &medium);
}

fn print_one<M: Message + Clone>(name: &str, gzip: Option<Gzip>, id: FrameId, message: &M) {
    let envelope = messages::envelope();
    let own = count(|| drop(black_box((envelope.clone(), message.clone()))));
    let frame = encoded(gzip, id, message);
    let mut decoder = Decoder::<Fc>::new();
    let decoding = count(|| {
        decoder.push(&frame);
        drop(black_box(read::<M>(&mut decoder)));
    });
    let mut encoder = Encoder::<Fc>::new().gzip(gzip);
    let mut out = Vec::new();
    let encoding = count(|| {
        out.clear();
        encoder.message(&mut out, id, &envelope, message).expect("it fits");
    });
    let counts = [own.new, decoding.new, decoding.resized, encoding.new, encoding.resized];
    let counts = counts.map(|count| count.to_string()).join(" ");
    println!("{name}: {counts}");
}

/// Runs the twin. Returns the table, and the most allocations of a frame in addition to those of its values.
pub fn table() -> (Table, f64) {
    let output = Command::new(twin::program()).arg("codec-allocations").output().expect("the twin runs");
    let text = String::from_utf8_lossy(&output.stdout);
    let columns = vec![
        t("消息", "message"),
        t("值自身", "the values' own"),
        t("解码", "decode"),
        t("其中扩容", "of them growing lists"),
        t("编码", "encode"),
        t("多出", "besides"),
    ];
    let mut table = Table::new(t("每帧的分配次数", "Allocations per frame"), columns);
    let mut most = 0.0_f64;
    for line in text.lines() {
        let Some((name, counts)) = line.split_once(": ") else { continue };
        let counts: Vec<i64> = counts.split(' ').filter_map(|count| count.parse().ok()).collect();
        let &[own, decoded, grown, encoded, regrown] = counts.as_slice() else { continue };
        let besides = (decoded - own).max(0) + encoded + regrown;
        most = most.max(besides as f64);
        table.row(vec![
            title(name),
            own.to_string().into(),
            (decoded + grown).to_string().into(),
            grown.to_string().into(),
            (encoded + regrown).to_string().into(),
            besides.to_string().into(),
        ]);
    }
    assert_eq!(table.rows.len(), NAMES.len(), "the twin counted all messages");
    (table, most)
}

fn title(name: &str) -> Text {
    match name {
        "small" => t("小", "small"),
        "medium" => t("中", "medium"),
        "medium_text" => t("中，数字为字符串", "medium, numbers in strings"),
        "large" => t("大", "large"),
        "small gzip" => t("小，gzip", "small, gzip"),
        other => t("中，gzip", other.to_owned().replace(" gzip", ", gzip")),
    }
}
