//! Useless work is paid for by waiting, and other connections do not wait.

use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{Echo, Toy, answer_to, command, frame};
use fc_runtime::{ClientConfig, Command, Encoder, FrameId, Gzip, Protocol};
use std::time::Duration;
use tokio::io::DuplexStream;
use tokio::time::{Instant, advance};

/// So many frames that cannot be used are free.
const FREE: usize = 256;

fn echo() -> Echo {
    Echo { text: "x".into() }
}

/// Frames that cannot be used, each with what it is, and whether it is answered.
fn unusable() -> [(&'static str, Vec<u8>, bool); 5] {
    let id = command(Echo::CODE, 1);
    let mut damaged = frame(id, b"{}");
    *damaged.last_mut().unwrap() ^= 1;
    [
        ("damaged", damaged, true),
        (
            "of no known command",
            frame(command(0xEEEE, 1), b"{}"),
            true,
        ),
        ("with an invalid body", frame(id, b"[]"), true),
        (
            "of a stream",
            frame(
                FrameId {
                    kind: Toy::STREAM,
                    ..id
                },
                b"{}",
            ),
            true,
        ),
        ("an answer to nothing", frame(answer_to(id), b"{}"), false),
    ]
}

/// Returns the milliseconds until the last of these frames is handled.
async fn handled(app: &mut Raw<DuplexStream>, bad: &[u8], count: usize, answered: bool) -> u128 {
    let start = Instant::now();
    for _ in 0..count {
        app.send(bad).await;
        if answered {
            app.recv().await.expect("an answer");
        }
    }
    app.send(&frame(command(Echo::CODE, 2), br#"{"text":"x"}"#))
        .await;
    let (id, _) = app.recv().await.expect("an answer");
    assert_eq!(id, answer_to(command(Echo::CODE, 2)));
    start.elapsed().as_millis()
}

#[fc_test::test(start_paused = true)]
async fn useless_frame_costs_a_millisecond_after_256() {
    let robot = Robot::start(loopback(), service).await;
    let other = robot.pipe(ClientConfig::new());
    for (what, bad, answered) in unusable() {
        for more in [0, 1, 10] {
            let mut app = robot.raw();
            let waited = handled(&mut app, &bad, FREE + more, answered).await;
            // A timer rings a millisecond late at most.
            let least = more as u128;
            assert!(
                (least..=2 * least).contains(&waited),
                "{what}, {more} more: {waited}"
            );
            // The others are not kept waiting.
            let start = Instant::now();
            assert!(other.call(&echo()).await.is_ok());
            assert_eq!(start.elapsed().as_millis(), 0);
            // Paid penalties are free again.
            advance(Duration::from_millis(100)).await;
            assert_eq!(handled(&mut app, &bad, 90, answered).await, 0, "{what}");
        }
    }
    assert_eq!(robot.handle.counters().connections_paced, 5 * 11);
}

#[fc_test::test(start_paused = true)]
async fn useful_frames_cost_no_time() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.pipe(ClientConfig::new());
    let start = Instant::now();
    for _ in 0..4 * FREE {
        assert!(app.call(&echo()).await.is_ok());
    }
    assert_eq!(start.elapsed().as_millis(), 0);
    assert_eq!(robot.handle.counters().connections_paced, 0);
}

#[fc_test::test(start_paused = true)]
async fn the_data_port_keeps_the_same_pace() {
    let robot = Robot::start(loopback(), service).await;
    let (_, bad, _) = &unusable()[0];
    let mut app = robot.raw_data();
    let start = Instant::now();
    for count in 1..=FREE + 10 {
        app.send(bad).await;
        app.recv().await.expect("an answer");
        if count == FREE {
            assert_eq!(start.elapsed().as_millis(), 0);
        }
    }
    // The last has been answered, and not been paid for.
    let waited = start.elapsed().as_millis();
    assert!((9..=18).contains(&waited), "{waited}");
}

#[fc_test::test(start_paused = true)]
async fn inflated_bytes_cost_time() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let gzip = Gzip {
        from_bytes: 0,
        level: 9,
    };
    let mut bomb = Vec::new();
    let mut encoder = Encoder::<Toy>::new().gzip(gzip);
    let plain = 8 << 20;
    encoder
        .bytes(&mut bomb, command(Echo::CODE, 1), &vec![b' '; plain])
        .unwrap();
    let start = Instant::now();
    for _ in 0..3 {
        app.send(&bomb).await;
    }
    for _ in 0..3 {
        assert_eq!(app.result().await.1, 73);
    }
    // Twice 8 MiB at a rate of 128 MiB per second. Other connections do not wait.
    let waited = start.elapsed().as_millis();
    assert!((120..=130).contains(&waited), "{waited}");
    let other = robot.pipe(ClientConfig::new());
    let start = Instant::now();
    app.send(&bomb).await;
    app.result().await;
    assert!(other.call(&echo()).await.is_ok());
    assert!(start.elapsed() < Duration::from_millis(70));
}
