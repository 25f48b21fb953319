//! The section of the packages, with tables and targets.

use super::{Calls, Codec, Peer, Report};
use crate::{Section, Table, Target, Text, digits, ratio, seconds, t, thousands};

/// Returns one section for all languages.
pub(super) fn section(reports: &[Report]) -> Section {
    let mut section = Section {
        title: t("其他语言的包", "Packages of other languages"),
        about: about(),
        tables: vec![machines(reports)],
        targets: reports.iter().flat_map(targets).collect(),
    };
    for report in reports {
        section.tables.push(codec(report));
        section.tables.extend(report.calls.iter().map(|calls| table_of_calls(report, calls)));
    }
    section
}

fn about() -> Text {
    t(
        "每个软件包用 `stubs/LANGUAGE/bench/run` 测量自己，各轮交替进行，取中位数。\n\n\
         **编解码**：`bench/frames` 中的帧，各语言相同。小帧是一个站点的响应，中帧列出 10 个站点，长帧列出 150 个（数字\
         为字符串）。fc 从字节到带类型的消息，再从消息到整帧，包含所有检查。\n\n\
         编解码的下限用语言自己的 JSON 库读写全部正文，计算同样字节的 MD5，读取时核对。它不检查类型、约束和重复的键，整\
         数也可能不精确。\n\n\
         **调用**：经过本机回环，服务端和客户端各为一个进程、各占一个核。CPU 是两个进程之和；Kotlin 的编解码只计所在线\
         程。\n\n\
         - `raw` 收发同样的字节数，一窗请求一次写出，不解析。\n\
         - gRPC 的请求和响应与 fc 字段相同（`bench/proto/bench.proto`）。每次调用都新建响应，由调用方核对。\n\
         - 只有一个在途调用时，C++ 双方都用阻塞的调用。\n\
         - Kotlin 不与 gRPC 比较，而与 `blocking` 比较：阻塞的套接字，每帧一次写、一次读，不解析。",
        "Each package measures itself with `stubs/LANGUAGE/bench/run`, in rounds that take turns. Figures are medians.\n\n\
         **Codec.** The frames in `bench/frames` are the same for every language. Small is the response about one \
         station, medium lists 10 stations, and long lists 150, with numbers in strings. fc goes from bytes to a typed \
         message, and from a message to a whole frame, with all checks.\n\n\
         The floor of the codec reads or writes the whole body with the language's JSON library. It makes the MD5 of \
         the same bytes, and compares it when reading. It does not check types, constraints or repeated keys, and its \
         integers may be inexact.\n\n\
         **Calls.** Calls go over loopback. Server and client are two processes with one core each. CPU is the sum of \
         both; for the codec in Kotlin, it is that of its thread only.\n\n\
         - `raw` moves the same number of bytes, a window of requests in one write, and parses nothing.\n\
         - gRPC has the same fields in request and response as fc (`bench/proto/bench.proto`). Each call gets a new \
         response, and the caller compares it.\n\
         - With one call in flight, both sides in C++ make blocking calls.\n\
         - Kotlin is compared with `blocking` instead of gRPC: blocking sockets, one write and one read per frame, no \
         parsing.",
    )
}

fn machines(reports: &[Report]) -> Table {
    let columns = vec![
        t("语言", "language"),
        t("日期", "date"),
        t("处理器", "processor"),
        t("可用核数", "cores"),
        t("版本", "versions"),
        t("下限的 JSON", "JSON of the floor"),
    ];
    let mut table = Table::new(t("测量环境", "Where it was measured"), columns);
    for report in reports {
        let versions: Vec<String> = report.versions.iter().map(|(name, version)| format!("{name} {version}")).collect();
        table.row(vec![
            report.language.clone().into(),
            report.date.clone().into(),
            report.processor.clone().into(),
            report.cores.to_string().into(),
            versions.join(", ").into(),
            report.json.clone().into(),
        ]);
    }
    table
}

fn name_of(message: &str) -> Text {
    match message {
        "small" => t("小", "small"),
        "medium" => t("中", "medium"),
        "long" => t("长", "long"),
        other => other.to_owned().into(),
    }
}

fn codec(report: &Report) -> Table {
    let title = t(format!("{}：编解码", report.language), format!("{}: codec", report.language));
    let columns = vec![
        t("消息", "message"),
        t("帧字节数", "bytes of the frame"),
        t("下限解码", "floor, decode"),
        t("fc 解码", "fc, decode"),
        t("× 下限", "× floor"),
        t("fc 解码，条/秒", "fc, decoded/s"),
        t("下限编码", "floor, encode"),
        t("fc 编码", "fc, encode"),
        t("× 下限", "× floor"),
        t("fc 编码，条/秒", "fc, encoded/s"),
    ];
    let mut table = Table::new(title, columns);
    for Codec { message, bytes, decode, encode } in &report.codec {
        let mut row = vec![name_of(message), bytes.to_string().into()];
        for beside in [decode, encode] {
            row.extend([
                seconds(beside.least / 1e6).into(),
                seconds(beside.fc / 1e6).into(),
                ratio(beside.fc, beside.least).into(),
                thousands(1e6 / beside.fc).into(),
            ]);
        }
        table.row(row);
    }
    table
}

fn peer<'a>(calls: &'a Calls, name: &str) -> Option<&'a Peer> {
    calls.peers.iter().find(|peer| peer.name == name)
}

fn table_of_calls(report: &Report, calls: &Calls) -> Table {
    let title = t(
        format!("{}：{} 个调用在途", report.language, calls.in_flight),
        format!("{}: calls, {} in flight", report.language, calls.in_flight),
    );
    let columns = vec![
        "".into(),
        t("次/秒", "calls/s"),
        t(format!("× {}", report.grpc), format!("× {}", report.grpc)),
        "p50, µs".into(),
        "p99, µs".into(),
        t("CPU µs/次", "CPU µs/call"),
        t(format!("CPU × {}", report.grpc), format!("CPU × {}", report.grpc)),
    ];
    let grpc = peer(calls, &report.grpc);
    let of_grpc = |figure: fn(&Peer) -> f64| grpc.map_or(f64::NAN, figure);
    let mut table = Table::new(title, columns);
    for peer in &calls.peers {
        let time = |value: Option<f64>| value.map_or("–".to_owned(), digits);
        table.row(vec![
            peer.name.clone().into(),
            thousands(peer.rate).into(),
            ratio(peer.rate, of_grpc(|peer| peer.rate)).into(),
            time(peer.p50).into(),
            time(peer.p99).into(),
            digits(peer.cpu).into(),
            ratio(peer.cpu, of_grpc(|peer| peer.cpu)).into(),
        ]);
    }
    table
}

/// Returns the targets of a package, from its goals.
fn targets(report: &Report) -> Vec<Target> {
    let language = &report.language;
    let mut targets = Vec::new();
    if let Some(goal) = report.goals.codec {
        for Codec { message, decode, encode, .. } in report.codec.iter().filter(|codec| codec.message != "long") {
            let name = name_of(message);
            let chinese = name.get(crate::Language::Chinese);
            let english = name.get(crate::Language::English);
            for (what, beside) in [
                (
                    t(format!("{language}：解码{chinese}帧 / 下限"), format!("{language}: decode {english} / floor")),
                    decode,
                ),
                (
                    t(format!("{language}：编码{chinese}帧 / 下限"), format!("{language}: encode {english} / floor")),
                    encode,
                ),
            ] {
                targets.push(Target::at_most("P1", what, goal, 1.0, beside.fc / beside.least));
            }
        }
    }
    if let (Some(goal), Some(calls)) = (report.goals.calls, report.calls.iter().max_by_key(|calls| calls.in_flight)) {
        let rate = |name: &str| peer(calls, name).map_or(f64::NAN, |peer| peer.rate);
        let (in_flight, grpc) = (calls.in_flight, &report.grpc);
        let what = t(
            format!("{language}：{in_flight} 在途，次/秒 × {grpc}"),
            format!("{language}: {in_flight} in flight, calls/s × {grpc}"),
        );
        targets.push(Target::at_least("P2", what, goal, 2.0 * goal, rate("fc") / rate(grpc)));
    }
    targets
}
