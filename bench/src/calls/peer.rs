//! The scenarios, and the parts that all peers share: sockets of servers, and a driver that makes calls.

use fc_bench_cases::messages;
use std::future::Future;
use std::net::{Ipv4Addr, SocketAddr};
use std::pin::Pin;
use std::time::{Duration, Instant};
use tokio::net::TcpListener;

/// The address of a server and the future that runs it.
pub type Serving = (SocketAddr, Pin<Box<dyn Future<Output = ()> + Send>>);

/// The kind of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// A request and a response of about 150 bytes.
    Small,
    /// A response with 1 MiB of text.
    Large,
}

/// The number of connections and calls of a driver.
#[derive(Clone, Copy, Debug)]
pub struct Scenario {
    /// Name on the command line.
    pub name: &'static str,
    /// Kind of the calls.
    pub question: Question,
    /// Connections, each with its own callers.
    pub connections: usize,
    /// Calls in flight on each connection.
    pub in_flight: usize,
    /// Run both sides with two workers on any core, instead of one thread on one core each.
    pub multi_thread: bool,
    /// Calls of a first round, whose speed determines the number of calls in the measured rounds.
    pub first: usize,
    /// Rounds for a report. The speed of lone calls depends on how deeply idle cores sleep, and stays high or low for
    /// seconds. Many short rounds give every peer both.
    pub rounds: usize,
}

const ONE: Scenario = Scenario {
    name: "one",
    question: Question::Small,
    connections: 1,
    in_flight: 1,
    multi_thread: false,
    first: 2_000,
    rounds: 5,
};

/// The scenarios in the order of the report.
pub const SCENARIOS: &[Scenario] = &[
    Scenario { name: "pipelined", in_flight: 64, first: 12_800, rounds: 11, ..ONE },
    Scenario { rounds: 21, ..ONE },
    Scenario { name: "many", connections: 100, first: 8_000, ..ONE },
    Scenario { name: "threads", in_flight: 64, multi_thread: true, first: 12_800, ..ONE },
    Scenario { name: "map", question: Question::Large, in_flight: 4, first: 40, ..ONE },
    Scenario { name: "lone-map", question: Question::Large, first: 40, ..ONE },
];

/// Binds the socket of a server to a free port.
pub async fn listen() -> (SocketAddr, TcpListener) {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).await.expect("bind");
    (listener.local_addr().expect("address"), listener)
}

/// Returns 1 MiB of base64 text.
pub fn map_text() -> String {
    use base64::Engine as _;
    base64::engine::general_purpose::STANDARD.encode(messages::picture(messages::PICTURE))
}

/// Microseconds of each call, and the wall time of all.
pub struct Measured {
    pub latencies: Vec<f32>,
    pub wall: Duration,
}

/// Makes the calls of a scenario.
///
/// `connect` opens a connection, and `call` makes one call on it. `drive` calls `ready` when all connections are open.
pub async fn drive<C, Connect, Connecting, Call, Calling>(
    address: SocketAddr,
    scenario: Scenario,
    calls: usize,
    ready: impl FnOnce(),
    connect: Connect,
    call: Call,
) -> Measured
where
    C: Clone + Send + 'static,
    Connect: Fn(SocketAddr) -> Connecting,
    Connecting: Future<Output = C>,
    Call: Fn(C, Question) -> Calling + Clone + Send + 'static,
    Calling: Future<Output = usize> + Send,
{
    let mut connections = Vec::with_capacity(scenario.connections);
    for _ in 0..scenario.connections {
        connections.push(connect(address).await);
    }
    let callers = scenario.connections * scenario.in_flight;
    let share = calls / callers;
    ready();
    let started = Instant::now();
    let tasks: Vec<_> = (0..callers)
        .map(|index| {
            let connection = connections[index % connections.len()].clone();
            let call = call.clone();
            tokio::spawn(async move {
                let mut latencies = Vec::with_capacity(share);
                for _ in 0..share {
                    let at = Instant::now();
                    let bytes = call(connection.clone(), scenario.question).await;
                    assert!(bytes > 0, "an empty answer");
                    latencies.push(at.elapsed().as_secs_f32() * 1e6);
                }
                latencies
            })
        })
        .collect();
    let mut latencies = Vec::with_capacity(calls);
    for task in tasks {
        latencies.extend(task.await.expect("a caller panicked"));
    }
    Measured { latencies, wall: started.elapsed() }
}
