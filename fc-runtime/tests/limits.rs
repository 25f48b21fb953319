//! Every limit one below, at and one beyond it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::indexing_slicing,
    clippy::cast_possible_truncation,
    reason = "a test may"
)]

mod common;

use common::net::{Raw, Robot, app_of_raw, loopback, nowhere, service};
use common::{
    Echo, EchoReply, LIMITS, Moved, Toy, ToyHeader, ToyRequest, answer_to, command, frame, report,
    until,
};
use fc_derive::Message;
use fc_runtime::json::from_str;
use fc_runtime::{
    AckOutcome, Audience, CallError, ClientConfig, Command, Decoder, Encoder, Extra, FrameId, Gzip,
    Header, Limits, Protocol, Report, Request, ServerConfig, read_enveloped,
};
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use tokio::io::DuplexStream;
use tokio::sync::Semaphore;
use tokio::task::JoinSet;
use tokio::time::{Instant, sleep};

/// One below a limit, the limit, one beyond it; and whether that is within.
fn around(limit: usize) -> [(usize, bool); 3] {
    [(limit - 1, true), (limit, true), (limit + 1, false)]
}

/// The same for times: what comes exactly at the end of a wait is not tested, it is a matter of who
/// is asked first.
fn around_time(limit: Duration) -> [(Duration, bool); 2] {
    let ms = Duration::from_millis(1);
    [(limit.saturating_sub(ms), true), (limit + ms, false)]
}

fn echo(text: &str) -> Echo {
    Echo {
        text: text.to_owned(),
    }
}

#[fc_test::test]
async fn frame_bytes() {
    let limits = Limits {
        frame_bytes: 1000,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    for (length, within) in around(1000) {
        let body = format!(r#"{{"text":"{:1$}"}}"#, "", length - ToyHeader::LEN - 11);
        let bytes = frame(command(Echo::CODE, 1), body.as_bytes());
        assert_eq!(bytes.len(), length);
        // Received and read.
        let mut decoder = Decoder::<Toy>::new().limits(&limits);
        decoder.push(&bytes);
        let name = decoder.next().map_err(|error| error.name());
        assert_eq!(name.is_ok(), within);
        assert!(within || name.err() == Some("frame_too_long"));
        // Written.
        let mut encoder = Encoder::<Toy>::new().frame_bytes(1000);
        let written = encoder.bytes(&mut Vec::new(), command(1, 1), body.as_bytes());
        assert_eq!(written.is_ok(), within);
        // Received by a robot: a length beyond the limit is not believed, and ends the connection.
        let mut app = robot.raw();
        app.send(&bytes).await;
        let heard = app.recv().await.map(|(_, body)| body);
        // The answer is longer than the request and does not fit; it is replaced by a result.
        let is_result = heard.map(|body| body.contains(r#""result":71"#));
        assert_eq!(is_result, within.then_some(true));
    }
    assert_eq!(robot.handle.counters().bad_frames, 1);
}

#[fc_test::test]
fn inflated_bytes() {
    let limits = Limits {
        inflated_bytes: 5000,
        ..LIMITS
    };
    for (length, within) in around(5000) {
        let mut bytes = Vec::new();
        let gzip = Gzip {
            from_bytes: 0,
            level: 9,
        };
        let mut encoder = Encoder::<Toy>::new().gzip(gzip);
        encoder
            .bytes(&mut bytes, command(1, 1), &vec![b' '; length])
            .unwrap();
        let mut decoder = Decoder::<Toy>::new().limits(&limits);
        decoder.push(&bytes);
        match decoder.next() {
            Ok(frame) => assert!(within && frame.unwrap().body().len() == length),
            Err(error) => assert!(!within && error.name() == "inflated_too_long"),
        }
    }
}

#[fc_test::test]
fn inflate_ratio() {
    let free = Limits::INFLATE_FREE as usize;
    let ratio = |inflate_ratio| Limits {
        inflate_ratio,
        ..LIMITS
    };
    let frame = |id, length: usize| {
        let mut bytes = Vec::new();
        let gzip = Gzip {
            from_bytes: 0,
            level: 9,
        };
        let mut encoder = Encoder::<Toy>::new().gzip(gzip);
        encoder.bytes(&mut bytes, id, &vec![b' '; length]).unwrap();
        bytes
    };
    let outcome = |bytes: &[u8], limits: &Limits| {
        let mut decoder = Decoder::<Toy>::new().limits(limits);
        decoder.push(bytes);
        decoder.next().map(|_| ()).map_err(|error| error.name())
    };
    let long = frame(command(1, 1), 2 * free);
    let packed = long.len() - ToyHeader::LEN;
    let least = (2 * free).div_ceil(packed);
    for (limit, within) in around(least) {
        // Here it is what is sent that stays and the limit that moves.
        let expected = if limit < least {
            Err("inflates_too_much")
        } else {
            Ok(())
        };
        assert_eq!(
            outcome(&long, &ratio(limit as u32)),
            expected,
            "{limit} {within}"
        );
    }
    // What is short may be blank, and so may be what is no text.
    for (length, within) in around(free) {
        let expected = if within {
            Ok(())
        } else {
            Err("inflates_too_much")
        };
        assert_eq!(
            outcome(&frame(command(1, 1), length), &ratio(256)),
            expected
        );
    }
    let picture = FrameId {
        kind: Toy::STREAM,
        ..command(1, 1)
    };
    assert_eq!(outcome(&frame(picture, 2 * free), &ratio(256)), Ok(()));
}

/// The same text with a place for unknown keys, which count no less where they are kept.
#[derive(Clone, Debug, PartialEq, Message)]
struct Kept {
    text: String,
    #[fc(extra)]
    extra: Extra,
}

#[fc_test::test]
async fn json_values() {
    let limits = Limits {
        json_values: 10,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let mut app = robot.raw();
    // The key of the text is one of them.
    let bodies: [fn(usize) -> String; 5] = [
        |n| format!(r#"{{"text":"x"{}}}"#, r#","a":[]"#.repeat(n - 1)),
        |n| format!(r#"{{{}"text":"x"}}"#, r#""a":0,"#.repeat(n - 1)),
        |n| format!(r#"{{"text":"x","a":[{}]}}"#, vec!["[]"; n - 2].join(",")),
        |n| {
            format!(
                r#"{{"text":"x","a":{{{}}}}}"#,
                vec![r#""":0"#; n - 2].join(",")
            )
        },
        |n| format!(r#"{{{}"text":"x"}}"#, r#""a\u0078":"y","#.repeat(n - 1)),
    ];
    for (values, within) in around(10) {
        for body in bodies {
            let text = body(values);
            let read = read_enveloped::<ToyRequest, Echo>(text.as_bytes(), limits.json());
            let name = read.map_err(|error| error.name()).map(|_| ());
            let kept = read_enveloped::<ToyRequest, Kept>(text.as_bytes(), limits.json());
            let expected = if within {
                Ok(())
            } else {
                Err("too_many_values")
            };
            assert_eq!(name, expected, "{text}");
            let body = kept.and_then(|read| read.body);
            assert_eq!(body.map_err(|error| error.name()).map(|_| ()), expected);
            let id = command(Echo::CODE, values as u32);
            app.send_frame(id, &text).await;
            let expected = if within { 7 } else { 73 };
            assert_eq!(app.result().await, (answer_to(id), expected), "{text}");
        }
        let lists = format!("[{}]", vec!["0"; values].join(","));
        let lists = from_str::<Vec<u8>>(&lists, limits.json());
        assert_eq!(lists.is_ok(), within);
    }
}

#[fc_test::test]
fn json_list_bytes() {
    // Four items at first, then as many again: 4, 8, 16.
    for (limit, within) in around(16 * size_of::<u64>()) {
        let limits = Limits {
            json_list_bytes: limit,
            ..LIMITS
        };
        let text = format!("[{}]", ["10000000"; 16].join(","));
        let read = from_str::<Vec<u64>>(&text, limits.json());
        let expected = if limit < 16 * size_of::<u64>() {
            Err("lists_too_large")
        } else {
            Ok(16)
        };
        assert_eq!(
            read.map(|read| read.len()).map_err(|error| error.name()),
            expected
        );
        assert!(within || limit > 128);
    }
    // Those in each other are counted together.
    let text = format!("[{}]", ["[10000000]"; 4].join(","));
    let limits = |json_list_bytes| Limits {
        json_list_bytes,
        ..LIMITS
    };
    // The last makes room for two alone: no more can come.
    let needed = 4 * size_of::<Vec<u64>>() + (4 + 4 + 4 + 2) * size_of::<u64>();
    let read = |limit| from_str::<Vec<Vec<u64>>>(&text, limits(limit).json());
    assert!(read(needed).is_ok());
    assert_eq!(read(needed - 1).unwrap_err().name(), "lists_too_large");
}

#[fc_test::test]
async fn json_depth() {
    let limits = Limits {
        json_depth: 10,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let mut app = robot.raw();
    for (depth, within) in around(10) {
        let (open, close) = ("[".repeat(depth - 1), "]".repeat(depth - 1));
        let text = format!(r#"{{"text":"x","deep":{open}{close}}}"#);
        match read_enveloped::<ToyRequest, Echo>(text.as_bytes(), limits.json()) {
            Ok(_) => assert!(within),
            Err(error) => assert!(!within && error.name() == "too_deep"),
        }
        let id = command(Echo::CODE, depth as u32);
        app.send_frame(id, &text).await;
        let expected = if within { 7 } else { 73 };
        assert_eq!(app.result().await, (answer_to(id), expected));
    }
}

#[fc_test::test(start_paused = true)]
async fn in_flight_at_the_app() {
    for (calls, within) in around(4) {
        let limits = Limits {
            in_flight: 4,
            ..LIMITS
        };
        let (app, _robot) = app_of_raw(ClientConfig::new().limits(limits));
        let mut ends = JoinSet::new();
        for _ in 0..calls {
            let app = app.clone();
            ends.spawn(async move { app.call(&echo("x")).await.unwrap_err() });
        }
        let ends = ends.join_all().await;
        let busy = ends
            .iter()
            .filter(|end| matches!(end, CallError::Busy(busy) if busy.limit == 4))
            .count();
        assert_eq!(busy, usize::from(!within));
        assert!(
            ends.iter()
                .all(|end| ["busy", "timeout"].contains(&end.name()))
        );
    }
}

#[fc_test::test]
async fn in_flight_at_the_robot() {
    for (calls, within) in around(4) {
        let gate = Arc::new(Semaphore::new(0));
        let (now, most) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let handlers = (Arc::clone(&gate), Arc::clone(&now), Arc::clone(&most));
        let slow = move |request: Request<'_, Toy>| {
            let (gate, now, most) = handlers.clone();
            request.handle(move |_, Echo { text }| async move {
                most.fetch_max(now.fetch_add(1, Ordering::Relaxed) + 1, Ordering::Relaxed);
                gate.acquire().await.unwrap().forget();
                now.fetch_sub(1, Ordering::Relaxed);
                Ok(EchoReply { text })
            })
        };
        let limits = Limits {
            in_flight: 4,
            ..LIMITS
        };
        let robot = Robot::start(loopback().limits(limits), slow).await;
        let app = robot.pipe(ClientConfig::new());
        let mut ends = JoinSet::new();
        for _ in 0..calls {
            let app = app.clone();
            ends.spawn(async move { app.call(&echo("x")).await.unwrap() });
        }
        until(|| now.load(Ordering::Relaxed) == calls.min(4)).await;
        // The one too many waits in the socket, and is served in its turn.
        assert!(within || robot.handle.counters().in_flight_reached > 0);
        gate.add_permits(calls);
        assert_eq!(ends.join_all().await.len(), calls);
        assert_eq!(most.load(Ordering::Relaxed), calls.min(4));
    }
}

#[fc_test::test]
async fn queued_reports_at_the_app() {
    for (reports, within) in around(4) {
        let limits = Limits {
            queued_reports: 4,
            ..LIMITS
        };
        let (app, mut robot) = app_of_raw(ClientConfig::new().limits(limits));
        let _receiver = app.reports();
        for id in 0..reports {
            robot
                .send_frame(report(Moved::CODE, id as u32), r#"{"metres":1}"#)
                .await;
        }
        let seen = || app.counters().reports + app.counters().reports_refused;
        until(|| seen() == reports as u64).await;
        assert_eq!(app.counters().reports_refused, u64::from(!within));
    }
}

#[fc_test::test]
async fn queued_bytes_at_the_app() {
    for (bytes, within) in around(300) {
        let (app, mut robot) = app_of_raw(ClientConfig::new().queued_bytes(300));
        let mut reports = app.reports();
        for (id, length) in [(1, 100), (2, 100), (3, bytes - 200)] {
            let text = format!(r#"{{"metres":1{:1$}}}"#, "", length - 12);
            assert_eq!(text.len(), length);
            robot.send_frame(report(Moved::CODE, id), &text).await;
        }
        until(|| app.counters().reports + app.counters().reports_refused == 3).await;
        assert_eq!(app.counters().reports_refused, u64::from(!within));
        // What has been taken makes room again.
        reports.recv().await.unwrap();
        robot
            .send_frame(report(Moved::CODE, 4), r#"{"metres":1}"#)
            .await;
        until(|| app.counters().reports == 3 + u64::from(within)).await;
    }
}

/// A robot with one app that acknowledges nothing, and the pushes made to it.
async fn pushed(
    config: ServerConfig,
    reports: usize,
) -> (Robot, JoinSet<AckOutcome>, Raw<DuplexStream>) {
    let robot = Robot::start(config, service).await;
    let app = robot.raw();
    let mut pushes = JoinSet::new();
    for _ in 0..reports {
        let handle = robot.handle.clone();
        let metres = Moved { metres: 1 };
        pushes.spawn(async move {
            let mut outcomes = handle.push(Audience::All, &metres).await.unwrap();
            outcomes.remove(0).outcome
        });
        // Each is on its way before the next.
        tokio::task::yield_now().await;
        tokio::task::yield_now().await;
    }
    (robot, pushes, app)
}

async fn dropped(mut pushes: JoinSet<AckOutcome>, app: Raw<DuplexStream>) -> usize {
    drop(app);
    let mut outcomes = Vec::new();
    while let Some(outcome) = pushes.join_next().await {
        outcomes.push(outcome.unwrap());
    }
    let dropped = |outcome: &&AckOutcome| **outcome == AckOutcome::Dropped;
    outcomes.iter().filter(dropped).count()
}

#[fc_test::test]
async fn queued_reports_at_the_robot() {
    for (reports, within) in around(4) {
        let limits = Limits {
            queued_reports: 4,
            in_flight: 1,
            ..LIMITS
        };
        // One is in flight, the others wait.
        let (robot, pushes, app) = pushed(loopback().limits(limits), 1 + reports).await;
        assert_eq!(dropped(pushes, app).await, usize::from(!within));
        assert_eq!(robot.handle.counters().reports_dropped, u64::from(!within));
    }
}

#[fc_test::test]
async fn queued_bytes_at_the_robot() {
    let (_robot, _pushes, mut app) = pushed(loopback(), 1).await;
    let length = app.recv().await.unwrap().1.len();
    for (bytes, within) in [
        (3 * length + 1, true),
        (3 * length, true),
        (3 * length - 1, false),
    ] {
        let (robot, pushes, app) = pushed(loopback().queued_bytes(bytes), 3).await;
        assert_eq!(dropped(pushes, app).await, usize::from(!within));
        assert_eq!(robot.handle.counters().reports_dropped, u64::from(!within));
    }
}

#[fc_test::test]
async fn acknowledged_reports_make_room() {
    let robot = Robot::start(loopback().queued_bytes(200), service).await;
    let app = robot.pipe(ClientConfig::new());
    let mut reports = app.reports();
    for _ in 0..100 {
        let acknowledged = robot.handle.push(Audience::All, &Moved { metres: 1 }).await;
        assert_eq!(acknowledged.unwrap()[0].outcome, AckOutcome::Acknowledged);
        reports.recv().await.unwrap();
    }
}

#[fc_test::test]
async fn connections() {
    let limits = Limits {
        connections: 4,
        ..LIMITS
    };
    for data in [false, true] {
        let robot = Robot::start(loopback().limits(limits), service).await;
        let mut kept = Vec::new();
        for number in 1..=5 {
            let (app, end) = tokio::io::duplex(1000);
            let served = if data {
                robot.handle.serve_data(end, nowhere())
            } else {
                robot.handle.serve(end, nowhere())
            };
            assert_eq!(served.is_some(), number <= 4, "connection {number}");
            let mut app = Raw::new(app);
            if number <= 4 {
                // A silent one would give way.
                app.speak(data).await;
            }
            kept.push(app);
        }
        assert_eq!(robot.handle.counters().connections_refused, 1);
    }
}

#[fc_test::test]
async fn connections_per_address() {
    let config = loopback().connections_per_address(3);
    for data in [false, true] {
        let robot = Robot::start(config.clone(), service).await;
        let mut kept = Vec::new();
        for (address, served) in [
            ("192.0.2.1", true),
            ("192.0.2.1", true),
            ("192.0.2.1", true),
            ("192.0.2.1", false),
            // Others have their own.
            ("192.0.2.2", true),
            ("2001:db8::1", true),
        ] {
            let (app, end) = tokio::io::duplex(1000);
            // Its port does not matter.
            let address = SocketAddr::new(address.parse().unwrap(), 1000 + kept.len() as u16);
            let id = if data {
                robot.handle.serve_data(end, address)
            } else {
                robot.handle.serve(end, address)
            };
            assert_eq!(id.is_some(), served, "{address}");
            let mut app = Raw::new(app);
            if served {
                // A silent one would give way.
                app.speak(data).await;
            }
            kept.push(app);
        }
        assert_eq!(robot.handle.counters().connections_refused, 1);
    }
}

/// Sends a request with a break at byte `at`, and says whether it was answered.
async fn answered(robot: &Robot, at: usize, wait: Duration) -> bool {
    let bytes = frame(command(Echo::CODE, 1), br#"{"text":"x"}"#);
    let mut app = robot.raw();
    app.send(&bytes[..at]).await;
    sleep(wait).await;
    let (mut from, mut to) = tokio::io::split(app.stream);
    let _ = tokio::io::AsyncWriteExt::write_all(&mut to, &bytes[at..]).await;
    let mut byte = [0];
    matches!(
        tokio::io::AsyncReadExt::read(&mut from, &mut byte).await,
        Ok(1)
    )
}

#[fc_test::test(start_paused = true)]
async fn the_time_for_a_header_a_frame_and_silence() {
    let limit = Duration::from_secs(7);
    let forever = Duration::from_secs(1_000_000);
    let waits = loopback()
        .header_timeout(forever)
        .stall_timeout(forever)
        .idle_timeout(None);
    let header = waits.clone().header_timeout(limit);
    let stall = waits.clone().stall_timeout(limit);
    let idle = waits.idle_timeout(Some(limit));
    for (config, at) in [(header, 1), (stall, ToyHeader::LEN), (idle, 0)] {
        for (wait, within) in around_time(limit) {
            let robot = Robot::start(config.clone(), service).await;
            assert_eq!(answered(&robot, at, wait).await, within, "{at} {wait:?}");
            let timed_out = robot.handle.counters().connections_timed_out;
            assert!(timed_out == u64::from(!within) || at == 0, "{timed_out}");
        }
    }
}

/// Sends a long frame piece by piece, one every five seconds; whether it has come as a whole.
async fn comes_slowly(data: bool, piece: usize) -> bool {
    let config = loopback()
        .stall_timeout(Duration::from_secs(7))
        .least_rate(100);
    let robot = Robot::start(config, service).await;
    let _streams = robot.handle.streams();
    let (mut app, id) = if data {
        let picture = FrameId {
            kind: Toy::STREAM,
            ..command(0x0C01, 1)
        };
        (robot.raw_data(), picture)
    } else {
        (robot.raw(), command(Echo::CODE, 1))
    };
    let bytes = frame(id, format!(r#"{{"text":"{:8000}"}}"#, "").as_bytes());
    let (start, rest) = bytes.split_at(4000);
    app.send(start).await;
    for piece in rest.chunks(piece).take(20) {
        sleep(Duration::from_secs(5)).await;
        if tokio::io::AsyncWriteExt::write_all(&mut app.stream, piece)
            .await
            .is_err()
        {
            break;
        }
    }
    sleep(Duration::from_secs(1)).await;
    let counters = robot.handle.counters();
    let whole = counters.stream_frames_in + counters.calls_succeeded == 1;
    assert_eq!(counters.connections_timed_out, u64::from(!whole));
    whole
}

/// Reads what is long piece by piece, one every five seconds; whether the robot has put up with it.
async fn is_read_slowly(data: bool, piece: usize) -> bool {
    let config = loopback()
        .stall_timeout(Duration::from_secs(7))
        .least_rate(100);
    let robot = Robot::start(config, service).await;
    let mut app = if data { robot.raw_data() } else { robot.raw() };
    if data {
        let long = vec![0; 200_000];
        let sent = robot.handle.send_stream(Audience::All, 0x0C01, 1, &long);
        assert_eq!(sent.await, Ok(1));
    } else {
        let text = format!(r#"{{"text":"{}"}}"#, "x".repeat(200_000));
        app.send_frame(command(Echo::CODE, 1), &text).await;
    }
    let mut read = vec![0; piece];
    for _ in 0..5 {
        sleep(Duration::from_secs(5)).await;
        let read = tokio::io::AsyncReadExt::read_exact(&mut app.stream, &mut read);
        read.await.unwrap();
    }
    robot.handle.counters().connections_timed_out == 0
}

#[fc_test::test(start_paused = true)]
async fn least_rate() {
    for data in [false, true] {
        assert!(is_read_slowly(data, 700).await);
        assert!(!is_read_slowly(data, 699).await);
        // 700 bytes in seven seconds, in which one piece comes.
        assert!(comes_slowly(data, 700).await);
        assert!(!comes_slowly(data, 699).await);
        assert!(!comes_slowly(data, 1).await);
    }
}

#[fc_test::test(start_paused = true)]
async fn handler_and_call_time() {
    let limit = Duration::from_secs(7);
    for (wait, within) in around_time(limit) {
        let slow = move |request: Request<'_, Toy>| {
            request.handle(move |_, Echo { text }| async move {
                sleep(wait).await;
                Ok(EchoReply { text })
            })
        };
        let robot = Robot::start(loopback().handler_timeout(limit), slow).await;
        let app = robot.pipe(ClientConfig::new().call_timeout(limit * 2));
        let start = Instant::now();
        let end = app.call(&echo("x")).await;
        let refused = matches!(end, Err(CallError::Refused(refusal)) if refusal.code == 72);
        assert_eq!(refused, !within);
        assert!(start.elapsed() >= wait.min(limit));

        let robot = Robot::start(loopback().handler_timeout(limit * 2), slow).await;
        let app = robot.pipe(ClientConfig::new().call_timeout(limit));
        let end = app.call(&echo("x")).await;
        assert_eq!(end == Err(CallError::Timeout), !within);
        assert_eq!(end.is_ok(), within);
    }
}
