//! The memory that apps make a robot hold, and the connections closed when it is short.

use crate::common::log::{Log, alone};
use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{self, Echo, EchoReply, Go, LIMITS, Toy, answer_to, command, frame, until};
use fc_runtime::{
    AckOutcome, Audience, Command, Encoder, FrameId, Gzip, Limits, Protocol, Request, ServerConfig,
    ServerCounters,
};
use std::future::poll_fn;
use std::net::{Ipv4Addr, SocketAddr};
use std::pin::pin;
use std::sync::Arc;
use std::task::Poll;
use std::time::Duration;
use tokio::io::{AsyncWriteExt, DuplexStream};
use tokio::sync::Semaphore;
use tracing::Level;

const KIB: usize = 1 << 10;
const MIB: usize = 1 << 20;

/// Memory limit of the robots in these tests.
const MEMORY: usize = 8 * MIB;

/// Any transport.
const NEEDED: usize = 128 * KIB;

fn config() -> ServerConfig {
    let limits = Limits {
        connections: 64,
        ..LIMITS
    };
    loopback().limits(limits).memory(MEMORY)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Port {
    Command,
    Data,
}

const PORTS: [Port; 2] = [Port::Command, Port::Data];

/// A peer at one of the ports, with its own address.
fn connect(robot: &Robot, port: Port, address: u8) -> Raw<DuplexStream> {
    let (app, stream) = tokio::io::duplex(64 * KIB);
    let address = SocketAddr::from((Ipv4Addr::new(10, 0, 0, address), 9));
    let id = match port {
        Port::Command => robot.handle.serve(stream, address),
        Port::Data => robot.handle.serve_data(stream, address),
    };
    id.unwrap();
    Raw::new(app)
}

/// All of a frame of `length` bytes but the last.
fn unfinished(port: Port, length: usize) -> Vec<u8> {
    let kind = match port {
        Port::Command => Toy::COMMAND,
        Port::Data => Toy::STREAM,
    };
    let id = FrameId {
        kind,
        ..command(Echo::CODE, 1)
    };
    let mut bytes = frame(id, &vec![b' '; length - 37]);
    bytes.pop();
    bytes
}

/// Sends until the robot takes no more. Returns `true` if everything was sent. The test fails if the robot takes
/// nothing for a long time without closing.
async fn try_send(app: &mut Raw<DuplexStream>, bytes: &[u8]) -> bool {
    let mut sending = pin!(app.stream.write_all(bytes));
    for _ in 0..100_000 {
        let polled = poll_fn(|cx| Poll::Ready(sending.as_mut().poll(cx))).await;
        if let Poll::Ready(sent) = polled {
            return sent.is_ok();
        }
        tokio::task::yield_now().await;
    }
    panic!("the robot takes no more");
}

fn echo(length: usize) -> Echo {
    Echo {
        text: "x".repeat(length),
    }
}

fn text(length: usize) -> String {
    format!(r#"{{"text":"{}"}}"#, "x".repeat(length))
}

#[fc_test::test]
async fn one_host_cannot_hold_more_than_the_budget() {
    let _alone = alone();
    for port in PORTS {
        let robot = Robot::start(config(), service).await;
        let innocent = robot.connect().await;
        let mut held = Vec::new();
        for address in 0..20 {
            let mut app = connect(&robot, port, address);
            try_send(&mut app, &unfinished(port, MIB)).await;
            held.push(app);
            assert!(robot.handle.memory() <= MEMORY);
            assert!(innocent.call(&echo(40 * KIB)).await.is_ok());
        }
        let ServerCounters {
            connections_evicted,
            ..
        } = robot.handle.counters();
        assert!(connections_evicted >= 10, "{connections_evicted}");
        drop(held);
        until(|| robot.handle.memory() < NEEDED + 64 * KIB).await;
    }
}

async fn largest_connection_is_closed(port: Port) {
    let log = Log::listen(Level::WARN);
    let robot = Robot::start(config(), service).await;
    let mut lesser = Vec::new();
    for address in 0..7 {
        let mut app = connect(&robot, port, address);
        assert!(try_send(&mut app, &unfinished(port, 700 * KIB)).await);
        lesser.push(app);
    }
    let mut greatest = connect(&robot, port, 99);
    assert!(try_send(&mut greatest, &unfinished(port, MIB)).await);
    until(|| robot.handle.memory() > 5 * MIB + 700 * KIB).await;
    // The next request exceeds the limit.
    let mut next = connect(&robot, port, 100);
    assert!(try_send(&mut next, &unfinished(port, 700 * KIB)).await);
    let mut last = connect(&robot, port, 101);
    assert!(try_send(&mut last, &unfinished(port, 700 * KIB)).await);
    assert_eq!(greatest.recv().await, None);
    assert_eq!(robot.handle.counters().connections_evicted, 1);
    let lines = log.take();
    assert_eq!(lines.len(), 1, "{lines:#?}");
    for word in ["closed: memory is short", "peer=10.0.0.99:9", "bytes=1"] {
        assert!(lines[0].contains(word), "{lines:#?}");
    }
    // The others go on.
    for app in &mut lesser {
        assert!(try_send(app, b" ").await);
    }
}

#[fc_test::test]
async fn command_connection_with_most_memory_is_closed() {
    largest_connection_is_closed(Port::Command).await;
}

#[fc_test::test]
async fn data_connection_with_most_memory_is_closed() {
    largest_connection_is_closed(Port::Data).await;
}

/// A connection to a silent app holds no memory. Otherwise many of them would use up the memory, and free and request
/// it again endlessly.
#[fc_test::test]
async fn silent_connections_hold_no_memory() {
    let _alone = alone();
    let limits = Limits {
        connections: 200,
        ..LIMITS
    };
    let robot = Robot::start(config().limits(limits), service).await;
    let mut crowd = Vec::new();
    for number in 0..250 {
        crowd.push(connect(&robot, PORTS[number % 2], 1));
    }
    let app = robot.connect().await;
    assert!(app.call(&echo(400 * KIB)).await.is_ok());
    app.close();
    until(|| robot.handle.connections().len() == 125).await;
    assert_eq!(robot.handle.memory(), 0);
    // A connection that sent little holds little.
    for (number, peer) in crowd.iter_mut().enumerate() {
        peer.speak(number % 2 == 1).await;
    }
    let held = robot.handle.memory();
    assert!(held < 250 * 4 * KIB, "{held} bytes");
    assert_eq!(robot.handle.counters().connections_evicted, 0);
}

/// Memory that an app has used before does not count against it.
#[fc_test::test]
async fn unused_memory_is_released_first() {
    let _alone = alone();
    let robot = Robot::start(config(), service).await;
    let mut apps = Vec::new();
    for _ in 0..12 {
        let app = robot.connect().await;
        assert!(app.call(&echo(400 * KIB)).await.is_ok());
        apps.push(app);
        assert!(robot.handle.memory() <= MEMORY);
    }
    for app in &apps {
        assert!(app.call(&echo(400 * KIB)).await.is_ok());
        assert!(robot.handle.memory() <= MEMORY);
        assert_eq!(app.state().connects(), 1);
    }
    assert_eq!(robot.handle.counters().connections_evicted, 0);
}

/// Answers when it is let.
fn slow(
    permits: &Arc<Semaphore>,
) -> impl Fn(Request<'_, Toy>) -> fc_runtime::Handling + Send + Sync + 'static {
    let permits = Arc::clone(permits);
    move |request| {
        let permits = Arc::clone(&permits);
        match request.code() {
            Echo::CODE => request.handle(|_, Echo { text }| async move {
                permits.acquire().await.unwrap().forget();
                Ok(EchoReply { text })
            }),
            _ => request.handle_raw(|_, request| async move {
                permits.acquire().await.unwrap().forget();
                Ok(fc_runtime::RawAnswer(request.text))
            }),
        }
    }
}

#[fc_test::test]
async fn requests_in_the_hands_of_handlers_count() {
    let _alone = alone();
    let permits = Arc::new(Semaphore::new(0));
    let robot = Robot::start(config(), slow(&permits)).await;
    let mut greedy = connect(&robot, Port::Command, 1);
    let mut modest = connect(&robot, Port::Command, 2);
    modest
        .send_frame(command(Echo::CODE, 1), &text(100 * KIB))
        .await;
    let request = frame(command(Echo::CODE, 1), text(200 * KIB).as_bytes());
    for _ in 0..60 {
        try_send(&mut greedy, &request).await;
        assert!(robot.handle.memory() <= MEMORY);
    }
    assert_eq!(greedy.recv().await, None);
    assert_eq!(robot.handle.counters().connections_evicted, 1);
    // The request is gone with the connection, and the other app gets its response.
    until(|| robot.handle.memory() < MIB).await;
    permits.add_permits(1);
    assert_eq!(
        modest.result().await,
        (answer_to(command(Echo::CODE, 1)), 7)
    );
}

#[fc_test::test(start_paused = true)]
async fn a_handler_that_runs_on_keeps_its_charge() {
    let _alone = alone();
    let permits = Arc::new(Semaphore::new(0));
    let robot = Robot::start(config(), slow(&permits)).await;
    let mut app = connect(&robot, Port::Command, 1);
    app.send_frame(command(Go::CODE, 1), &text(300 * KIB)).await;
    until(|| robot.handle.memory() >= 300 * KIB).await;
    drop(app);
    // It is waited for as long as a handler may take.
    tokio::time::sleep(Toy::DEFAULTS.handler_timeout + Duration::from_millis(1)).await;
    until(|| robot.handle.counters().handlers_abandoned == 1).await;
    until(|| robot.handle.memory() < 400 * KIB).await;
    assert!(robot.handle.memory() >= 300 * KIB);
    permits.add_permits(1);
    until(|| robot.handle.memory() == 0).await;
}

#[fc_test::test]
async fn lists_count_with_their_final_size() {
    #[derive(Clone, Debug, PartialEq, fc_derive::Message, fc_derive::Command)]
    #[fc(code = 0x0103, name = "lists", effect = "read", response = common::Done)]
    struct Lists {
        items: Vec<Vec<u64>>,
    }

    let _alone = alone();
    let permits = Arc::new(Semaphore::new(0));
    let robot = Robot::start(config(), {
        let permits = Arc::clone(&permits);
        move |request: Request<'_, Toy>| {
            let permits = Arc::clone(&permits);
            request.handle(|_, lists: Lists| async move {
                permits.acquire().await.unwrap().forget();
                drop(lists);
                Ok(common::Done {})
            })
        }
    })
    .await;
    let mut app = connect(&robot, Port::Command, 1);
    let items = vec!["[]"; 10_000].join(",");
    let id = command(Lists::CODE, 1);
    app.send_frame(id, &format!(r#"{{"items":[{items}]}}"#))
        .await;
    until(|| robot.handle.memory() > 10_000 * size_of::<Vec<u64>>()).await;
    permits.add_permits(1);
    assert_eq!(app.result().await, (answer_to(id), 7));
    until(|| robot.handle.memory() < 10_000 * size_of::<Vec<u64>>()).await;
}

#[fc_test::test]
async fn streams_count_until_they_are_taken() {
    let _alone = alone();
    let robot = Robot::start(config(), service).await;
    let mut streams = robot.handle.streams();
    let mut bytes = unfinished(Port::Data, MIB);
    bytes.push(b' ');
    // There is no receiver, but all frames are received one after the other.
    let mut apps = Vec::new();
    for address in 0..6 {
        let mut app = connect(&robot, Port::Data, address);
        let bytes = bytes.clone();
        apps.push(tokio::spawn(async move {
            let sent = app.stream.write_all(&bytes).await;
            // Stays connected.
            (sent, app)
        }));
        for _ in 0..1000 {
            tokio::task::yield_now().await;
            assert!(robot.handle.memory() <= MEMORY);
        }
    }
    until(|| robot.handle.counters().stream_frames_in == 6).await;
    let held = robot.handle.memory();
    assert!(held >= 6 * MIB, "{held}");
    for _ in 0..6 {
        let stream = streams.recv().await.unwrap();
        assert!(robot.handle.memory() >= MIB, "it is counted in our hands");
        drop(stream);
    }
    assert_eq!(robot.handle.counters().connections_evicted, 0);
    until(|| robot.handle.memory() < 6 * NEEDED).await;
}

/// At most half of the memory is held by streams that the robot does not take. The rest is freed with their
/// connections.
#[fc_test::test(start_paused = true)]
async fn unread_streams_block_no_connection() {
    let _alone = alone();
    let robot = Robot::start(config(), service).await;
    let innocent = robot.connect().await;
    let _streams = robot.handle.streams();
    // Four of them would be nearly all there is.
    let mut bytes = Vec::new();
    let gzip = Gzip {
        from_bytes: 0,
        level: 9,
    };
    let id = FrameId {
        kind: Toy::STREAM,
        ..command(Echo::CODE, 1)
    };
    Encoder::<Toy>::new()
        .gzip(gzip)
        .bytes(&mut bytes, id, &vec![b' '; 1700 * KIB])
        .unwrap();
    let mut apps = Vec::new();
    for address in 0..20 {
        let mut app = connect(&robot, Port::Data, address);
        try_send(&mut app, &bytes).await;
        apps.push(app);
        assert!(innocent.call(&echo(100 * KIB)).await.is_ok());
        assert!(robot.handle.memory() <= MEMORY);
    }
    assert!(robot.handle.counters().connections_evicted > 10);
}

#[fc_test::test]
async fn reports_that_wait_close_no_connection() {
    let _alone = alone();
    let robot = Robot::start(config(), service).await;
    let mut app = connect(&robot, Port::Command, 1);
    app.speak(false).await;
    // Most of it is held by others.
    let mut pieces = Vec::new();
    for address in 2..7 {
        let mut piece = connect(&robot, Port::Command, address);
        assert!(try_send(&mut piece, &unfinished(Port::Command, MIB)).await);
        pieces.push(piece);
    }
    until(|| robot.handle.memory() > 4 * MIB + 512 * KIB).await;
    let report = Text {
        text: "x".repeat(200 * KIB),
    };
    let id = robot.handle.connections()[0].0;
    let mut pushing = Vec::new();
    for _ in 0..20 {
        let (handle, report) = (robot.handle.clone(), report.clone());
        pushing.push(tokio::spawn(async move {
            handle.push(Audience::One(id), &report).await.unwrap()
        }));
        tokio::task::yield_now().await;
        assert!(robot.handle.memory() <= MEMORY);
    }
    until(|| robot.handle.counters().reports_dropped >= 5).await;
    assert_eq!(robot.handle.counters().connections_evicted, 0);
    drop(app);
    for pushed in pushing {
        let outcome = &pushed.await.unwrap()[0].outcome;
        assert!(
            matches!(outcome, AckOutcome::Dropped | AckOutcome::Closed),
            "{outcome:?}"
        );
    }
}

/// A report of any size.
#[derive(Clone, Debug, PartialEq, fc_derive::Message, fc_derive::Report)]
#[fc(code = 0x0B02, name = "text")]
struct Text {
    text: String,
}

#[fc_test::test]
async fn unread_responses_count_as_memory() {
    let _alone = alone();
    let robot = Robot::start(config(), service).await;
    let request = frame(command(Echo::CODE, 1), text(700 * KIB).as_bytes());
    let mut apps = Vec::new();
    for address in 0..20 {
        let mut app = connect(&robot, Port::Command, address);
        try_send(&mut app, &request).await;
        apps.push(app);
        for _ in 0..100 {
            tokio::task::yield_now().await;
        }
        assert!(robot.handle.memory() <= MEMORY);
    }
    assert!(robot.handle.counters().connections_evicted > 5);
}

#[fc_test::test]
async fn a_text_that_could_not_be_read_alone_is_refused() {
    let _alone = alone();
    let robot = Robot::start(config(), service).await;
    let gzip = Gzip {
        from_bytes: 0,
        level: 9,
    };
    let id = command(Echo::CODE, 1);
    for (length, code) in [(900 * KIB, 7), (1100 * KIB, 71)] {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::<Toy>::new().gzip(gzip);
        encoder
            .bytes(&mut bytes, id, text(length).as_bytes())
            .unwrap();
        let mut app = connect(&robot, Port::Command, 1);
        app.send(&bytes).await;
        assert_eq!(app.result().await, (answer_to(id), code));
    }
    assert_eq!(robot.handle.counters().connections_evicted, 0);
}
