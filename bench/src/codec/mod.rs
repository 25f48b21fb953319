//! Measures the codec on one thread: frames to typed messages and back.

mod allocations;
mod frames;
mod mavlink;
pub mod reference;

pub use allocations::print as print_allocations;

use crate::measure::{Case, Effort, measure};
use crate::report::{Section, Table, Target, Text, digits, ratio, seconds, t};
use ::mavlink::MavlinkReader;
use fc_bench_cases::messages;
use fc_generated::Fc;
use fc_runtime::{Decoder, Encoder, FrameId, Message};
use frames::{GZIP, encoded, read};
use reference::Reference;
use std::hint::black_box;

/// Length of a frame header, in bytes.
const HEADER: usize = 35;

/// Seconds of the floor and of fc for one message.
struct Pair {
    name: Text,
    /// Length of the frame, in bytes.
    bytes: usize,
    reference: f64,
    ours: f64,
}

impl Pair {
    fn ratio(&self) -> f64 {
        self.ours / self.reference
    }
}

/// The four measurements of one message.
struct Measured {
    decode: Pair,
    encode: Pair,
    decode_gzip: Pair,
    encode_gzip: Pair,
}

fn measure_message<R>(name: &Text, id: FrameId, message: &R::Ours, effort: Effort) -> Measured
where
    R: Reference,
    R::Ours: Message + Clone,
{
    let envelope = messages::envelope();
    let theirs = R::of(message);
    let plain = encoded(None, id, message);
    let packed = encoded(Some(GZIP), id, message);
    let body = plain.len() - HEADER;
    let mut written = Vec::new();
    reference::encode(&theirs, &mut written);
    assert!(written[HEADER..] == plain[HEADER..], "reference and codec write the same text");

    let (mut decoder, mut unpacker) = (Decoder::<Fc>::new(), Decoder::<Fc>::new());
    let (mut encoder, mut packer) = (Encoder::<Fc>::new(), Encoder::<Fc>::new().gzip(GZIP));
    let mut gzip_in = reference::Gzip::new(GZIP.level);
    let mut gzip_out = reference::Gzip::new(GZIP.level);
    let mut outs: [Vec<u8>; 4] = Default::default();
    let [out0, out1, out2, out3] = &mut outs;
    let (plain_frame, packed_frame) = (&plain, &packed);
    let (envelope, theirs) = (&envelope, &theirs);
    let seconds = measure(
        vec![
            Case::new(move || drop(black_box(reference::decode::<R>(black_box(plain_frame))))),
            Case::new(move || {
                decoder.push(black_box(plain_frame));
                drop(black_box(read::<R::Ours>(&mut decoder)));
            }),
            Case::new(move || {
                reference::encode(black_box(theirs), out0);
                black_box(&*out0);
            }),
            Case::new(move || {
                out1.clear();
                encoder.message(out1, id, black_box(envelope), black_box(message)).expect("it fits");
                black_box(&*out1);
            }),
            Case::new(move || drop(black_box(gzip_in.decode::<R>(black_box(packed_frame), body)))),
            Case::new(move || {
                unpacker.push(black_box(packed_frame));
                drop(black_box(read::<R::Ours>(&mut unpacker)));
            }),
            Case::new(move || {
                gzip_out.encode(black_box(theirs), out2);
                black_box(&*out2);
            }),
            Case::new(move || {
                out3.clear();
                packer.message(out3, id, black_box(envelope), black_box(message)).expect("it fits");
                black_box(&*out3);
            }),
        ],
        effort,
    );
    let pair =
        |bytes: usize, at: usize| Pair { name: name.clone(), bytes, reference: seconds[at], ours: seconds[at + 1] };
    Measured {
        decode: pair(plain.len(), 0),
        encode: pair(plain.len(), 2),
        decode_gzip: pair(packed.len(), 4),
        encode_gzip: pair(packed.len(), 6),
    }
}

fn table(title: Text, pairs: &[(&Pair, Text)]) -> Table {
    let columns = vec![
        t("消息", "message"),
        t("编码", "encoding"),
        t("帧字节数", "bytes of the frame"),
        t("下限 R", "floor R"),
        "fc".into(),
        "fc / R".into(),
        t("fc，MB/s", "fc, MB/s"),
    ];
    let mut table = Table::new(title, columns);
    for (pair, encoding) in pairs {
        table.row(vec![
            pair.name.clone(),
            encoding.clone(),
            pair.bytes.to_string().into(),
            seconds(pair.reference).into(),
            seconds(pair.ours).into(),
            ratio(pair.ours, pair.reference).into(),
            digits(pair.bytes as f64 / pair.ours / 1e6).into(),
        ]);
    }
    table
}

/// Returns the seconds to parse and to serialize a MAVLink ODOMETRY message, and its length in bytes.
fn mavlink(effort: Effort) -> (f64, f64, usize) {
    let message = mavlink::message();
    let mut one = Vec::new();
    mavlink::write(&message, &mut one);
    let length = one.len();
    let mut reader = MavlinkReader::new(mavlink::Endless::new(one.repeat(64)));
    let mut out = Vec::new();
    let seconds = measure(
        vec![
            Case::new(move || {
                black_box(mavlink::read(&mut reader));
            }),
            Case::new(move || {
                out.clear();
                mavlink::write(black_box(&message), &mut out);
                black_box(&out);
            }),
        ],
        effort,
    );
    (seconds[0], seconds[1], length)
}

/// Compares the throughput per byte on the wire with MAVLink.
fn per_byte(small: &Measured, effort: Effort) -> (Table, Vec<Target>) {
    let (parse, serialize, length) = mavlink(effort);
    let rate = |bytes: usize, seconds: f64| bytes as f64 / seconds / 1e6;
    let columns = vec![
        t("对象", "what"),
        t("帧字节数", "bytes of the frame"),
        t("解码", "decode"),
        t("解码，MB/s", "decode, MB/s"),
        t("编码", "encode"),
        t("编码，MB/s", "encode, MB/s"),
    ];
    let mut table =
        Table::new(t("每字节：与 MAVLink 2 对比", "Per byte on the wire, compared with MAVLink 2"), columns);
    let pair = (small.decode.ours, small.encode.ours);
    for (name, bytes, (decode, encode)) in [
        (t("MAVLink ODOMETRY", "MAVLink ODOMETRY"), length, (parse, serialize)),
        (t("fc 小帧", "fc small frame"), small.decode.bytes, pair),
    ] {
        table.row(vec![
            name,
            bytes.to_string().into(),
            seconds(decode).into(),
            digits(rate(bytes, decode)).into(),
            seconds(encode).into(),
            digits(rate(bytes, encode)).into(),
        ]);
    }
    let decode = rate(small.decode.bytes, pair.0) / rate(length, parse);
    let encode = rate(small.encode.bytes, pair.1) / rate(length, serialize);
    let targets = vec![
        Target::at_least(
            "T12",
            t("小帧每字节解码 / MAVLink", "small frame per byte, decode / MAVLink"),
            0.8,
            1.0,
            decode,
        ),
        Target::at_least(
            "T12",
            t("小帧每字节编码 / MAVLink", "small frame per byte, encode / MAVLink"),
            0.9,
            1.2,
            encode,
        ),
    ];
    (table, targets)
}

/// Measures this group and returns its section.
pub fn section(quick: bool) -> Section {
    let effort = Effort::of(quick);
    let station = messages::station_id();
    let map = messages::map_id();
    eprintln!("codec: frames");
    let small =
        measure_message::<reference::Small>(&t("小", "small"), station, &messages::small(messages::STATION), effort);
    let medium = measure_message::<reference::Medium>(&t("中", "medium"), station, &messages::medium(), effort);
    let text_name = t("中，数字为字符串", "medium, numbers in strings");
    let text = measure_message::<reference::MediumText>(&text_name, station, &messages::medium_text(), effort);
    let slow = Effort { rounds: effort.rounds.div_ceil(5), ..effort };
    let large = measure_message::<reference::Large>(&t("大", "large"), map, &messages::large(), slow);
    let kept_name = t("大，R 保留 base64 文本", "large, R keeps the base64 text");
    let kept = measure_message::<reference::LargeText>(&kept_name, map, &messages::large(), slow);
    eprintln!("codec: MAVLink");
    let (bytes, byte_targets) = per_byte(&small, effort);
    eprintln!("codec: allocations");
    let (allocations, extra) = allocations::table();

    let all = [&small, &medium, &text, &large, &kept];
    let rows = |plain: fn(&Measured) -> &Pair, packed: fn(&Measured) -> &Pair| {
        let plain = all.iter().map(move |one| (plain(one), t("不压缩", "plain")));
        // The last case has no compressed rows, because they would repeat those of the large message.
        plain.chain(all[..4].iter().map(move |one| (packed(one), "gzip".into()))).collect::<Vec<_>>()
    };
    let decode =
        table(t("解码：帧到带类型的消息", "Decode: frame to typed message"), &rows(|m| &m.decode, |m| &m.decode_gzip));
    let encode =
        table(t("编码：带类型的消息到帧", "Encode: typed message to frame"), &rows(|m| &m.encode, |m| &m.encode_gzip));

    let mut targets = vec![
        Target::at_most("T1", t("解码小帧 / R", "decode small / R"), 1.0, 0.8, small.decode.ratio()),
        Target::at_most("T2", t("解码中帧 / R", "decode medium / R"), 0.92, 0.7, medium.decode.ratio()),
        Target::at_most(
            "T2",
            t("解码中帧（数字为字符串）/ R", "decode medium with numbers in strings / R"),
            0.92,
            0.7,
            text.decode.ratio(),
        ),
        Target::at_most("T3", t("编码小帧 / R", "encode small / R"), 1.05, 0.82, small.encode.ratio()),
        Target::at_most("T3", t("编码中帧 / R", "encode medium / R"), 1.05, 0.82, medium.encode.ratio()),
        Target::at_most("T4", t("解码大帧 / R", "decode large / R"), 1.06, 1.03, large.decode.ratio()),
        Target::at_most("T4", t("编码大帧 / R", "encode large / R"), 1.03, 0.8, large.encode.ratio()),
        Target::at_most(
            "T5",
            t("每帧多出的分配次数", "allocations per frame besides the values' own"),
            0.0,
            0.0,
            extra,
        ),
    ];
    targets.extend(byte_targets);
    Section {
        title: t("帧编解码", "Frame codec"),
        about: t(
            "下限 R 是 `fast-md5` 加 `serde_json`，类型和字节都相同；压缩的帧另用 zlib-rs，并复用其状态。R 没有流、没有\
             上限检查，也不保留未知的键。\n\n\
             小帧是一个站点的响应，中帧列出 150 个站点，大帧是含 1 MiB base64 的地图。除“R 保留 base64 文本”一行外，R \
             也解码 base64。时间是单线程的 CPU 时间，取各轮的中位数。",
            "The floor R is `fast-md5` and `serde_json` over the same types and bytes. Compressed frames also use \
             zlib-rs with reused state. R has no stream and no limits, and does not keep unknown keys.\n\n\
             Small is the response about one station, medium lists 150 stations, and large is a map with 1 MiB of \
             base64. R also decodes the base64, except in the row *R keeps the base64 text*. Times are CPU time of one \
             thread, medians over the rounds.",
        ),
        tables: vec![decode, encode, bytes, allocations],
        targets,
    }
}
