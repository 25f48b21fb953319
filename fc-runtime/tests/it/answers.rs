//! Executed requests are answered, however the app ends.

use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{Done, Echo, Go, Toy, command, frame, until};
use fc_runtime::{Audience, Command, Handling, Refusal, Request};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::Semaphore;

/// Requests with the ids from 0 on, one behind the other.
fn requests(count: u32) -> Vec<u8> {
    (0..count)
        .flat_map(|id| frame(command(Echo::CODE, id), br#"{"text":"x"}"#))
        .collect()
}

/// The ids that are answered with success until the robot closes the connection.
async fn answered<S: AsyncRead + AsyncWrite + Unpin>(app: &mut Raw<S>) -> BTreeSet<u32> {
    let mut ids = BTreeSet::new();
    while let Some((id, body)) = app.recv().await {
        if body.contains(r#""result":7,"#) {
            ids.insert(id.id);
        }
    }
    ids
}

/// Bytes that an app sends after its last request.
const ENDS: [(&str, &[u8]); 4] = [
    ("nothing", b""),
    ("half a head", b"<"),
    ("half a frame", b"<?>\x80\x00\x00\x00"),
    ("garbage", b"GET / HTTP/1.1\r\n\r\n"),
];

#[fc_test::test]
async fn requests_and_the_end_of_the_stream() {
    let robot = Robot::start(loopback(), service).await;
    for (name, end) in ENDS {
        for count in [1, 5, 200] {
            let mut app = Raw::new(TcpStream::connect(robot.command).await.unwrap());
            let mut bytes = requests(count);
            bytes.extend_from_slice(end);
            app.send(&bytes).await;
            app.stream.shutdown().await.unwrap();
            let answered = answered(&mut app).await;
            assert_eq!(answered.len(), count as usize, "{count} and {name}");
        }
    }
}

#[fc_test::test]
async fn requests_before_invalid_bytes_are_answered() {
    let robot = Robot::start(loopback(), service).await;
    for count in [10, 500] {
        let mut app = Raw::new(TcpStream::connect(robot.command).await.unwrap());
        let mut bytes = requests(count);
        // More than the robot reads at once: closing with it unread would reset the connection.
        bytes.extend(std::iter::repeat_n(0x2A, 300_000));
        app.send(&bytes).await;
        assert_eq!(answered(&mut app).await.len(), count as usize);
    }
}

/// A robot whose motions wait for permission.
fn waiting(permits: &Arc<Semaphore>) -> impl Fn(Request<'_, Toy>) -> Handling + use<> {
    let permits = Arc::clone(permits);
    move |request: Request<'_, Toy>| {
        let permits = Arc::clone(&permits);
        match request.code() {
            Go::CODE => request.handle(|_, Go { .. }| async move {
                let permit = permits.acquire().await;
                permit.map_err(|_| Refusal::new(500, "over"))?.forget();
                Ok(Done {})
            }),
            _ => service(request),
        }
    }
}

#[fc_test::test]
async fn a_handler_at_work_when_the_app_has_sent_its_last() {
    for (name, end) in ENDS {
        let permits = Arc::new(Semaphore::new(0));
        let robot = Robot::start(loopback(), waiting(&permits)).await;
        let mut app = robot.raw();
        let mut bytes = frame(command(Go::CODE, 7), br#"{"metres":1}"#);
        bytes.extend(requests(1));
        bytes.extend_from_slice(end);
        app.send(&bytes).await;
        app.stream.shutdown().await.unwrap();
        assert_eq!(app.result().await.0.id, 0, "{name}: the other is answered");
        permits.add_permits(1);
        assert_eq!(answered(&mut app).await, BTreeSet::from([7]), "{name}");
    }
}

#[fc_test::test(start_paused = true)]
async fn a_handler_at_work_when_a_frame_stalls() {
    let permits = Arc::new(Semaphore::new(0));
    let limit = Duration::from_secs(1);
    let config = loopback()
        .stall_timeout(limit)
        .header_timeout(limit)
        .handler_timeout(10 * limit);
    let robot = Robot::start(config, waiting(&permits)).await;
    for end in [&b"<"[..], &requests(1)[..40]] {
        let mut app = robot.raw();
        let mut bytes = frame(command(Go::CODE, 7), br#"{"metres":1}"#);
        bytes.extend_from_slice(end);
        app.send(&bytes).await;
        let before = robot.handle.counters().connections_timed_out;
        while robot.handle.counters().connections_timed_out == before {
            tokio::time::sleep(limit / 8).await;
        }
        permits.add_permits(1);
        assert_eq!(answered(&mut app).await, BTreeSet::from([7]));
    }
}

#[fc_test::test]
async fn streams_that_wait_when_the_app_has_sent_its_last() {
    let robot = Robot::start(loopback(), service).await;
    // No bytes, or more invalid bytes than the robot reads at once.
    for garbage in [0, 300_000] {
        let before = robot.handle.counters().data_connections;
        let mut app = Raw::new(TcpStream::connect(robot.data).await.unwrap());
        until(|| robot.handle.counters().data_connections != before).await;
        let big = vec![1; 200_000];
        for id in 0..4 {
            let sent = robot.handle.send_stream(Audience::All, 1, id, &big).await;
            assert_eq!(sent.unwrap(), 1);
        }
        app.send(&vec![0x2A; garbage]).await;
        app.stream.shutdown().await.unwrap();
        let mut ids = Vec::new();
        while let Some((id, body)) = app.recv().await {
            assert_eq!(body.len(), big.len());
            ids.push(id.id);
        }
        assert_eq!(ids, [0, 1, 2, 3], "{garbage}");
    }
}
