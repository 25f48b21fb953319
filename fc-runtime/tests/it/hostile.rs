//! Peers that send nonsense, too much, too little or too slowly: bounded memory, their own
//! connection only.

use crate::common::net::{Robot, loopback, service};
use crate::common::{self, Echo, LIMITS, Toy, ToyHeader, answer_to, command, frame, until};
use fc_runtime::digest::{DigestAlgorithm as _, Md5};
use fc_runtime::{ClientConfig, Command, Encoder, FrameId, Gzip, Header, Limits, Protocol};
use std::time::Duration;
use tokio::io::AsyncWriteExt;
use tokio::time::Instant;

/// A frame whose header lies.
fn lie(id: FrameId, body: &[u8], change: impl FnOnce(&mut ToyHeader)) -> Vec<u8> {
    let mut bytes = frame(id, body);
    let mut header = ToyHeader::read(&bytes).unwrap();
    change(&mut header);
    header.write(&mut bytes);
    bytes
}

#[fc_test::test]
async fn wrong_head_or_length_closes_only_its_connection() {
    let robot = Robot::start(loopback(), service).await;
    let innocent = robot.connect().await;
    let id = command(Echo::CODE, 1);
    for bytes in [
        b"GET / HTTP/1.1".to_vec(),
        lie(id, b"{}", |h| h.total = 3),
        lie(id, b"{}", |h| h.total = u32::MAX),
    ] {
        let mut app = robot.raw();
        app.send(&bytes).await;
        assert_eq!(app.recv().await, None);
        let request = Echo {
            text: "still here".into(),
        };
        assert!(innocent.call(&request).await.is_ok());
    }
    assert_eq!(robot.handle.counters().bad_frames, 3);
}

#[fc_test::test]
async fn invalid_frame_of_known_length_is_answered() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let id = command(Echo::CODE, 5);
    for bytes in [
        lie(id, b"{}", |h| h.digest[0] ^= 1),
        lie(id, b"{}", |h| h.encoding = 99),
        lie(id, b"{}", |h| h.encoding = Toy::GZIP.unwrap()),
        lie(id, b"{}", |h| h.plain = 99),
    ] {
        app.send(&bytes).await;
        assert_eq!(app.result().await, (answer_to(id), 71));
    }
    // An answer echoes the kind, whatever it was.
    for (kind, name) in [(43, "reserved_kind"), (99, "unknown_kind")] {
        let id = FrameId { kind, ..id };
        app.send_frame(id, "{}").await;
        assert_eq!(app.recv().await, Some((answer_to(id), name.to_owned())));
    }
    app.send_frame(id, "no json").await;
    assert_eq!(app.result().await, (answer_to(id), 73));
    app.send_frame(id, r#"{"text":"fine"}"#).await;
    assert_eq!(app.result().await, (answer_to(id), 7));
}

#[fc_test::test]
async fn unsolicited_responses_are_ignored() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let id = command(Echo::CODE, 5);
    app.send_frame(answer_to(id), "{}").await;
    app.send(&lie(answer_to(id), b"{}", |h| h.digest[0] ^= 1))
        .await;
    app.send_frame(id, r#"{"text":"fine"}"#).await;
    assert_eq!(app.result().await, (answer_to(id), 7));
}

#[fc_test::test]
async fn frames_in_single_bytes_and_in_one_piece() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let ids: Vec<_> = (0..50).map(|id| command(Echo::CODE, id)).collect();
    let bytes: Vec<u8> = ids
        .iter()
        .flat_map(|id| frame(*id, br#"{"text":"x"}"#))
        .collect();
    app.send(&bytes).await;
    for id in &ids {
        assert_eq!(app.result().await, (answer_to(*id), 7));
    }
    for byte in bytes {
        app.send(&[byte]).await;
        tokio::task::yield_now().await;
    }
    for id in &ids {
        assert_eq!(app.result().await, (answer_to(*id), 7));
    }
}

#[fc_test::test]
async fn a_bomb_is_refused() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let id = command(Echo::CODE, 5);
    let mut bomb = Vec::new();
    let mut encoder = Encoder::<Toy>::new().gzip(Gzip {
        from_bytes: 0,
        level: 9,
    });
    encoder
        .bytes(
            &mut bomb,
            id,
            &vec![b' '; LIMITS.inflated_bytes as usize + 1],
        )
        .unwrap();
    app.send(&bomb).await;
    assert_eq!(app.result().await, (answer_to(id), 71));
    // The same, but it lies about its length.
    let (front, data) = bomb.split_at_mut(ToyHeader::LEN);
    let mut header = ToyHeader::read(front).unwrap();
    header.plain = 100;
    header.digest = Md5::digest(data);
    header.write(front);
    app.send(&bomb).await;
    assert_eq!(app.result().await, (answer_to(id), 71));
}

#[fc_test::test(start_paused = true)]
async fn a_header_in_drops_is_not_waited_for() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let start = Instant::now();
    let bytes = frame(command(1, 1), b"{}");
    for byte in &bytes[..20] {
        if app
            .stream
            .write_all(std::slice::from_ref(byte))
            .await
            .is_err()
        {
            break;
        }
        tokio::time::sleep(Duration::from_secs(1)).await;
    }
    assert_eq!(app.recv().await, None);
    assert_eq!(
        start.elapsed().as_secs(),
        7,
        "five seconds, one in which the robot says goodbye, and the drop that noticed"
    );
    assert_eq!(robot.handle.counters().connections_timed_out, 1);
}

#[fc_test::test(start_paused = true)]
async fn stalled_or_trickling_body_times_out() {
    for drops in [0, 10] {
        let robot = Robot::start(loopback(), service).await;
        let mut app = robot.raw();
        let start = Instant::now();
        let bytes = frame(command(Echo::CODE, 1), br#"{"text":"drop by drop"}"#);
        let (front, body) = bytes.split_at(ToyHeader::LEN);
        app.send(front).await;
        for byte in &body[..drops] {
            tokio::time::sleep(Duration::from_secs(20)).await;
            let drop = std::slice::from_ref(byte);
            if app.stream.write_all(drop).await.is_err() {
                break;
            }
        }
        assert_eq!(app.recv().await, None);
        let noticed = if drops == 0 { 30 } else { 40 };
        assert_eq!(
            start.elapsed().as_secs(),
            noticed,
            "after 30 s, and the drop that noticed"
        );
        assert_eq!(robot.handle.counters().connections_timed_out, 1);
    }
}

#[fc_test::test(start_paused = true)]
async fn idle_connections_end_if_they_are_to() {
    let idle = loopback().idle_timeout(Some(Duration::from_secs(60)));
    let robot = Robot::start(idle, service).await;
    let mut app = robot.raw();
    let start = Instant::now();
    for id in 0..3 {
        tokio::time::sleep(Duration::from_secs(40)).await;
        app.send_frame(command(Echo::CODE, id), r#"{"text":"x"}"#)
            .await;
        app.result().await;
    }
    assert_eq!(app.recv().await, None);
    assert_eq!(start.elapsed().as_secs(), 120 + 60);

    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    tokio::time::sleep(Duration::from_secs(100_000)).await;
    app.send_frame(command(Echo::CODE, 1), r#"{"text":"x"}"#)
        .await;
    assert_eq!(app.result().await.1, 7);
}

#[fc_test::test(start_paused = true)]
async fn an_app_that_does_not_read_is_neither_read_nor_kept() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let start = Instant::now();
    let text = "x".repeat(30_000);
    let request = frame(
        command(Echo::CODE, 1),
        format!(r#"{{"text":"{text}"}}"#).as_bytes(),
    );
    let mut sent = 0;
    let writing = async {
        while app.stream.write_all(&request).await.is_ok() {
            sent += request.len();
        }
    };
    writing.await;
    assert_eq!(
        start.elapsed().as_secs(),
        30 + 1,
        "the stall and the goodbye"
    );
    assert!(sent < 1 << 20, "{sent} bytes were taken of it");
    assert_eq!(robot.handle.counters().connections_timed_out, 1);
}

#[fc_test::test(start_paused = true)]
async fn an_app_that_reads_slowly_is_kept() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let text = "x".repeat(1_000_000);
    app.send_frame(command(Echo::CODE, 1), &format!(r#"{{"text":"{text}"}}"#))
        .await;
    let mut left = 1_000_000_usize;
    let mut bytes = [0; 64 * 1024];
    while left > 0 {
        tokio::time::sleep(Duration::from_secs(20)).await;
        let read = tokio::io::AsyncReadExt::read(&mut app.stream, &mut bytes)
            .await
            .unwrap();
        assert!(read > 0);
        left = left.saturating_sub(read);
    }
    assert_eq!(robot.handle.counters().connections_timed_out, 0);
}

#[fc_test::test]
async fn flood_of_reports_costs_bounded_memory() {
    let limits = Limits {
        queued_reports: 10,
        ..LIMITS
    };
    let (app, mut robot) = common::net::app_of_raw(ClientConfig::new().limits(limits));
    let _receiver = app.reports();
    // The robot never reads its acknowledgements, and the app reads on.
    for id in 0..20_000 {
        robot
            .send_frame(common::report(1, id), r#"{"metres":1}"#)
            .await;
    }
    until(|| app.counters().reports + app.counters().reports_refused >= 20_000).await;
    assert_eq!(app.counters().reports, 10);
    assert!(app.counters().bytes_out < 1 << 20);
}
