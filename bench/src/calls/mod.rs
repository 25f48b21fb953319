//! Measures calls over loopback. Server and driver are separate processes with one core each.

pub mod fc;
mod frames;
mod grpc;
mod naive;
mod peer;
mod raw;
mod tables;
mod tarpc_peer;

use crate::cost::Meter;
use crate::process::{Process, cores};
use crate::report::{Section, t};
use crate::twin;
use fc::Answers;
use peer::{Measured, Question, SCENARIOS, Scenario, drive};
use std::cell::Cell;
use std::io::{Read as _, stdin};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use tables::{Peers, Round};
use tarpc_peer::Format;

/// Peers in the order of the report: the floors, fc, the others.
const PEERS: &[&str] = &["raw", "raw-mux", "fc", "fc-naive", "tonic", "tarpc-bincode", "tarpc-json"];

/// Returns the peers of a scenario. Lone small calls add two floors, and large responses add `fc-prepared`.
fn peers(scenario: Scenario) -> Vec<&'static str> {
    let more: &[&str] = match (scenario.name, scenario.question) {
        ("one", _) => &["raw-md5", "raw-codec"],
        (_, Question::Large) => &["fc-prepared"],
        _ => &[],
    };
    PEERS.iter().chain(more).copied().collect()
}

/// Time for each peer in each scenario, over all rounds, in seconds.
const MEASURED: f64 = 3.0;

/// Creates a runtime with one thread or with two workers.
pub fn runtime(multi_thread: bool) -> tokio::runtime::Runtime {
    let mut builder = if multi_thread {
        let mut builder = tokio::runtime::Builder::new_multi_thread();
        builder.worker_threads(2);
        builder
    } else {
        tokio::runtime::Builder::new_current_thread()
    };
    builder.enable_all().build().expect("runtime")
}

/// Runs `serve PEER single|threads`. Prints the address of the server.
///
/// After the line `go`, prints `ready` and measures until the input ends. Then prints CPU seconds and allocations.
pub fn serve(peer: &str, multi_thread: bool) {
    let runtime = runtime(multi_thread);
    let (address, serving) = runtime.block_on(async {
        match peer {
            "raw" | "raw-mux" => raw::serve().await,
            "raw-md5" => frames::serve(frames::Work::Digest).await,
            "raw-codec" => frames::serve(frames::Work::Codec).await,
            "fc" => fc::serve(Answers::Made).await,
            "fc-prepared" => fc::serve(Answers::Prepared).await,
            "fc-naive" => naive::serve().await,
            "tonic" => grpc::serve().await,
            "tarpc-bincode" => tarpc_peer::serve(Format::Bincode).await,
            "tarpc-json" => tarpc_peer::serve(Format::Json).await,
            other => panic!("no peer {other}"),
        }
    });
    println!("{address}");
    std::thread::spawn(|| {
        let mut line = String::new();
        stdin().read_line(&mut line).expect("input");
        let meter = Meter::start();
        println!("ready");
        stdin().lock().read_to_string(&mut line).expect("input");
        println!("{} {}", meter.cpu(), meter.allocations());
        std::process::exit(0);
    });
    if multi_thread {
        runtime.block_on(async { tokio::spawn(serving).await.expect("served") });
    } else {
        runtime.block_on(serving);
    }
}

/// Runs `drive PEER ADDRESS SCENARIO CALLS`. Prints seconds, p50, p99, CPU seconds and allocations.
pub fn run_driver(peer: &str, address: SocketAddr, scenario: &str, calls: usize) {
    let scenario = *SCENARIOS.iter().find(|known| known.name == scenario).expect("a scenario");
    let runtime = runtime(scenario.multi_thread);
    let meter = Cell::new(Meter::start());
    let ready = || meter.set(Meter::start());
    let mut measured = runtime.block_on(go(peer, address, scenario, calls, ready));
    let meter = meter.get();
    let (cpu, allocations) = (meter.cpu(), meter.allocations());
    measured.latencies.sort_by(f32::total_cmp);
    let at = |share: f64| measured.latencies[((measured.latencies.len() - 1) as f64 * share) as usize];
    println!("{} {} {} {cpu} {allocations}", measured.wall.as_secs_f64(), at(0.5), at(0.99));
}

async fn go(peer: &str, address: SocketAddr, scenario: Scenario, calls: usize, ready: impl FnOnce()) -> Measured {
    match peer {
        // One caller sends a whole window at once, so that keeping calls apart costs the floor nothing.
        "raw" => {
            let window = scenario.in_flight;
            let single = Scenario { in_flight: 1, ..scenario };
            drive(address, single, calls / window, ready, raw::Plain::connect, move |connection, question| {
                connection.call(question, window)
            })
            .await
        }
        "raw-mux" => drive(address, scenario, calls, ready, raw::Mux::connect, raw::Mux::call).await,
        "raw-md5" => {
            let connect = |at| frames::Caller::connect(at, frames::Work::Digest);
            drive(address, scenario, calls, ready, connect, frames::Caller::call).await
        }
        "raw-codec" => {
            let connect = |at| frames::Caller::connect(at, frames::Work::Codec);
            drive(address, scenario, calls, ready, connect, frames::Caller::call).await
        }
        "fc" | "fc-prepared" => drive(address, scenario, calls, ready, fc::connect, fc::call).await,
        "fc-naive" => drive(address, scenario, calls, ready, naive::connect, naive::call).await,
        "tonic" => drive(address, scenario, calls, ready, grpc::connect, grpc::call).await,
        "tarpc-bincode" => {
            let connect = |at| tarpc_peer::connect(at, Format::Bincode);
            drive(address, scenario, calls, ready, connect, tarpc_peer::call).await
        }
        "tarpc-json" => {
            let connect = |at| tarpc_peer::connect(at, Format::Json);
            drive(address, scenario, calls, ready, connect, tarpc_peer::call).await
        }
        other => panic!("no peer {other}"),
    }
}

fn round(program: &Path, peer: &str, scenario: Scenario, calls: usize) -> Round {
    let cores = if scenario.multi_thread { (None, None) } else { cores() };
    let threads = if scenario.multi_thread { "threads" } else { "single" };
    let mut server = Process::start(program, &["serve", peer, threads], cores.0);
    let address = server.line();
    server.tell("go");
    server.line();
    let driver = Process::start(program, &["drive", peer, &address, scenario.name, &calls.to_string()], cores.1);
    let driven = driver.end();
    let served = server.end();
    let calls = calls as f64;
    Round {
        per_second: calls / driven[0],
        p50: driven[1],
        p99: driven[2],
        cpu: (driven[3] + served[0]) * 1e6 / calls,
        client_allocations: driven[4] / calls,
        server_allocations: served[1] / calls,
    }
}

/// Rounds down to a number of calls that all callers can share equally, at least one each.
fn whole(calls: f64, scenario: Scenario) -> usize {
    let callers = scenario.connections * scenario.in_flight;
    (calls as usize / callers).max(1) * callers
}

fn measure(scenario: Scenario, quick: bool, own: &Path, twin: &Path) -> Peers {
    let rounds = if quick { 2 } else { scenario.rounds };
    let seconds = if quick { 0.2 } else { MEASURED / rounds as f64 };
    let names = peers(scenario);
    let counts: Vec<usize> = names
        .iter()
        .map(|peer| {
            eprintln!("calls: {}: how fast is {peer}?", scenario.name);
            let first = round(own, peer, scenario, whole(scenario.first as f64, scenario));
            whole(first.per_second * seconds, scenario)
        })
        .collect();
    let mut peers = Peers::new(&names);
    for turn in 1..=rounds {
        eprintln!("calls: {}: round {turn} of {rounds}", scenario.name);
        for (peer, &calls) in names.iter().zip(&counts) {
            peers.add(peer, round(own, peer, scenario, calls));
        }
    }
    if !scenario.multi_thread {
        eprintln!("calls: {}: allocations", scenario.name);
        for peer in &names {
            peers.count(peer, round(twin, peer, scenario, whole(scenario.first as f64, scenario)));
        }
    }
    peers
}

/// Measures this group and returns its section.
pub fn section(quick: bool) -> Section {
    let own: PathBuf = std::env::current_exe().expect("own path");
    let twin = twin::program();
    let measured: Vec<(Scenario, Peers)> =
        SCENARIOS.iter().map(|scenario| (*scenario, measure(*scenario, quick, &own, &twin))).collect();
    Section {
        title: t("调用", "Calls"),
        about: t(
            "调用经过本机回环，服务端和客户端各为一个进程、各占一个核。“多线程”一组除外：两端各有两个工作线程，不绑核。\
             CPU 是两个进程之和。\n\n\
             - `raw` 是下限：字节数相同，不解析，一窗请求一次写出。\n\
             - `raw-mux` 加上共享一个连接的代价：每次调用一个任务、一个通道、一个 oneshot。\n\
             - `raw-md5` 只加上一次调用的四个摘要。\n\
             - `raw-codec` 用编解码器读写每一帧，没有会话。逐个调用时，报文格式本身至少需要这么多。\n\
             - `fc-naive` 是同一协议的简单手写版本：每个请求一个任务，每帧一次写，用 `md-5` 和 `serde_json`。\n\
             - `fc-prepared` 的机器人对大响应只编码和计算摘要一次。\n\n\
             小响应约 150 字节，大响应含 1 MiB 文本。fc 和 `fc-naive` 还把文本从 base64 解码成图片，其他各方只交付文\
             本。",
            "Calls go over loopback. Server and client are two processes with one core each. With several threads, \
             each side has two workers on any core. CPU is the sum of both processes.\n\n\
             - `raw` is the floor: the same number of bytes, no parsing, and a window of requests in one write.\n\
             - `raw-mux` adds the cost of sharing a connection: a task, a channel and a oneshot per call.\n\
             - `raw-md5` adds only the four digests of a call.\n\
             - `raw-codec` reads and writes each frame with the codec, without a session. It shows the least cost of \
             the wire format for a lone call.\n\
             - `fc-naive` is a simple hand-written version of the protocol: a task per request, a write per frame, \
             `md-5` and `serde_json`.\n\
             - `fc-prepared` has a robot that encodes and digests a large response only once.\n\n\
             Small responses have about 150 bytes, large ones 1 MiB of text. fc and `fc-naive` also decode that text \
             from base64 into the picture. The others deliver the text.",
        ),
        tables: measured.iter().map(|(scenario, peers)| tables::table(*scenario, peers)).collect(),
        targets: tables::targets(&measured),
    }
}
