//! The tables and targets of the calls.

use super::peer::Scenario;
use crate::report::{Table, Target, Text, digits, median, ratio, t, thousands};

/// The figures of one round of a peer.
#[derive(Clone, Copy, Default)]
pub struct Round {
    /// Calls per second.
    pub per_second: f64,
    /// Median latency, in microseconds.
    pub p50: f64,
    /// 99th percentile of the latency, in microseconds.
    pub p99: f64,
    /// CPU time of both processes per call, in microseconds.
    pub cpu: f64,
    /// Allocations of the client per call.
    pub client_allocations: f64,
    /// Allocations of the server per call.
    pub server_allocations: f64,
}

/// All rounds of all peers.
pub struct Peers(Vec<Peer>);

struct Peer {
    name: &'static str,
    rounds: Vec<Round>,
    counted: Option<Round>,
}

impl Peers {
    /// Creates peers without rounds.
    pub fn new(names: &[&'static str]) -> Self {
        Self(names.iter().map(|name| Peer { name, rounds: Vec::new(), counted: None }).collect())
    }

    fn get(&self, name: &str) -> &Peer {
        self.0.iter().find(|peer| peer.name == name).expect("a peer")
    }

    fn get_mut(&mut self, name: &str) -> &mut Peer {
        self.0.iter_mut().find(|peer| peer.name == name).expect("a peer")
    }

    /// Adds a measured round.
    pub fn add(&mut self, name: &str, round: Round) {
        self.get_mut(name).rounds.push(round);
    }

    /// Sets the round of the twin. Only its allocations are used.
    pub fn count(&mut self, name: &str, round: Round) {
        self.get_mut(name).counted = Some(round);
    }

    fn median(&self, name: &str, figure: fn(&Round) -> f64) -> f64 {
        median(self.get(name).rounds.iter().map(figure))
    }

    fn ratio(&self, base: &str, figure: fn(&Round) -> f64) -> f64 {
        self.median("fc", figure) / self.median(base, figure)
    }
}

fn rate(round: &Round) -> f64 {
    round.per_second
}

fn cpu(round: &Round) -> f64 {
    round.cpu
}

fn title(scenario: Scenario) -> Text {
    match scenario.name {
        "one" => t("1 个连接，逐个调用", "1 connection, one call at a time"),
        "pipelined" => t("1 个连接，64 个调用在途", "1 connection, 64 calls in flight"),
        "many" => t("100 个连接，各逐个调用", "100 connections, one call at a time on each"),
        "threads" => t("多线程，1 个连接，64 个调用在途", "Several threads, 1 connection, 64 calls in flight"),
        "lone-map" => t("1 MiB 的响应，逐个调用", "Responses of 1 MiB, one call at a time"),
        _ => t("1 MiB 的响应，4 个调用在途", "Responses of 1 MiB, 4 calls in flight"),
    }
}

/// Returns the table of a scenario.
pub fn table(scenario: Scenario, peers: &Peers) -> Table {
    let columns = vec![
        "".into(),
        t("次/秒", "calls/s"),
        "× raw".into(),
        "× raw-mux".into(),
        "× tonic".into(),
        "× tarpc-bincode".into(),
        "p50, µs".into(),
        "p99, µs".into(),
        t("CPU µs/次", "CPU µs/call"),
        "CPU × raw-mux".into(),
        "CPU × tonic".into(),
        t("分配/次，客户端 + 服务端", "allocations/call, client + server"),
    ];
    let mut table = Table::new(title(scenario), columns);
    for peer in &peers.0 {
        let of = |base: &str, figure: fn(&Round) -> f64| -> Text {
            ratio(median(peer.rounds.iter().map(figure)), peers.median(base, figure)).into()
        };
        let figure = |figure: fn(&Round) -> f64| median(peer.rounds.iter().map(figure));
        let counted = peer.counted.map_or("–".to_owned(), |round| {
            format!("{:.1} + {:.1}", round.client_allocations, round.server_allocations)
        });
        // With several calls in flight, the latency of `raw` is that of a whole window, so the table omits it.
        let window = peer.name == "raw" && scenario.in_flight > 1;
        let latency = |value: f64| if window { "–".into() } else { digits(value).into() };
        table.row(vec![
            peer.name.into(),
            thousands(figure(rate)).into(),
            of("raw", rate),
            of("raw-mux", rate),
            of("tonic", rate),
            of("tarpc-bincode", rate),
            latency(figure(|round| round.p50)),
            latency(figure(|round| round.p99)),
            digits(figure(cpu)).into(),
            of("raw-mux", cpu),
            of("tonic", cpu),
            counted.into(),
        ]);
    }
    table
}

/// Allocations of the values of a response on each side: the name and the result text.
const OWN: f64 = 2.0;

/// Returns the targets T5 to T11 and T16.
#[allow(clippy::too_many_lines, reason = "a table")]
pub fn targets(measured: &[(Scenario, Peers)]) -> Vec<Target> {
    let find = |name: &str| &measured.iter().find(|(scenario, _)| scenario.name == name).expect("a scenario").1;
    let (pipelined, one, many, threads, map, lone_map) =
        (find("pipelined"), find("one"), find("many"), find("threads"), find("map"), find("lone-map"));
    let counted = pipelined.get("fc").counted.unwrap_or_default();
    let (client, server) = (counted.client_allocations - OWN, counted.server_allocations - OWN);
    vec![
        Target::at_most(
            "T5",
            t("每次调用多出的分配，客户端", "allocations per call besides the values', client"),
            2.0,
            1.0,
            client.round(),
        ),
        Target::at_most(
            "T5",
            t("每次调用多出的分配，服务端", "allocations per call besides the values', server"),
            1.0,
            0.0,
            server.round(),
        ),
        Target::at_least(
            "T6",
            t("64 在途，次/秒 × tonic", "64 in flight, calls/s × tonic"),
            5.0,
            6.5,
            pipelined.ratio("tonic", rate),
        ),
        Target::at_least(
            "T6",
            t("64 在途，次/秒 × tarpc-bincode", "64 in flight, calls/s × tarpc-bincode"),
            1.5,
            1.8,
            pipelined.ratio("tarpc-bincode", rate),
        ),
        Target::at_most(
            "T7",
            t("64 在途，CPU × raw-mux", "64 in flight, CPU × raw-mux"),
            2.8,
            2.3,
            pipelined.ratio("raw-mux", cpu),
        ),
        Target::at_most(
            "T7",
            t("64 在途，CPU × tonic", "64 in flight, CPU × tonic"),
            0.25,
            0.2,
            pipelined.ratio("tonic", cpu),
        ),
        Target::at_most(
            "T8",
            t("逐个调用，p50 × raw", "one at a time, p50 × raw"),
            1.1,
            1.03,
            one.ratio("raw", |round| round.p50),
        ),
        Target::at_most(
            "T8",
            t("逐个调用，p99 × raw", "one at a time, p99 × raw"),
            1.15,
            1.03,
            one.ratio("raw", |round| round.p99),
        ),
        Target::at_most(
            "T8",
            t("逐个调用，CPU × tonic", "one at a time, CPU × tonic"),
            0.8,
            0.72,
            one.ratio("tonic", cpu),
        ),
        Target::at_least(
            "T9",
            t("100 连接，次/秒 × raw", "100 connections, calls/s × raw"),
            0.72,
            0.82,
            many.ratio("raw", rate),
        ),
        Target::at_least(
            "T9",
            t("100 连接，次/秒 × tonic", "100 connections, calls/s × tonic"),
            2.7,
            3.1,
            many.ratio("tonic", rate),
        ),
        Target::at_least(
            "T9",
            t("100 连接，次/秒 × tarpc-bincode", "100 connections, calls/s × tarpc-bincode"),
            1.1,
            1.2,
            many.ratio("tarpc-bincode", rate),
        ),
        Target::at_least(
            "T10",
            t("多线程，次/秒 × tonic", "several threads, calls/s × tonic"),
            3.5,
            4.2,
            threads.ratio("tonic", rate),
        ),
        Target::at_least(
            "T10",
            t("多线程，次/秒 × tarpc-bincode", "several threads, calls/s × tarpc-bincode"),
            1.6,
            1.9,
            threads.ratio("tarpc-bincode", rate),
        ),
        Target::at_least(
            "T11",
            t("1 MiB 响应，次/秒 × tonic", "1 MiB responses, calls/s × tonic"),
            0.52,
            0.6,
            map.ratio("tonic", rate),
        ),
        Target::at_least(
            "T11",
            t("1 MiB 响应，次/秒 × fc-naive", "1 MiB responses, calls/s × fc-naive"),
            1.2,
            1.3,
            map.ratio("fc-naive", rate),
        ),
        Target::at_least(
            "T11",
            t("1 MiB 响应，次/秒 × tarpc-json", "1 MiB responses, calls/s × tarpc-json"),
            1.3,
            1.4,
            map.ratio("tarpc-json", rate),
        ),
        Target::at_least(
            "T16",
            t("1 MiB 响应，逐个调用，次/秒 × tonic", "1 MiB responses one at a time, calls/s × tonic"),
            0.6,
            1.0,
            lone_map.ratio("tonic", rate),
        ),
        Target::at_least(
            "T16",
            t(
                "1 MiB 响应，逐个调用，预先准备，次/秒 × tonic",
                "1 MiB responses one at a time, prepared, calls/s × tonic",
            ),
            0.6,
            1.0,
            lone_map.median("fc-prepared", rate) / lone_map.median("tonic", rate),
        ),
    ]
}
