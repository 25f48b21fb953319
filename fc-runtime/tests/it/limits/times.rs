//! Limits of durations and rates.

use crate::common::net::{Robot, loopback, service};
use crate::common::{Echo, EchoReply, Toy, ToyHeader, command, frame};
use crate::limits::echo;
use fc_runtime::{Audience, CallError, ClientConfig, Command, FrameId, Header, Protocol, Request};
use std::time::Duration;
use tokio::time::{Instant, sleep};

/// Values just within and just beyond a limit, with the expected result. The exact end of a wait is not tested, because
/// the order of polls decides it.
fn around_time(limit: Duration) -> [(Duration, bool); 2] {
    let ms = Duration::from_millis(1);
    [(limit.saturating_sub(ms), true), (limit + ms, false)]
}

/// Sends a request with a pause at byte `at`. Returns `true` if the robot answers.
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

/// Reads a long response in pieces, one every five seconds. Returns `true` if the robot accepts that.
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
