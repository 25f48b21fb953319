//! The data port: frames of raw bytes in both directions.

use crate::common::net::{Robot, data_of_raw, loopback, nowhere, service};
use crate::common::{self, LIMITS, Toy, ToyHeader, answer_to, command, frame, until};
use fc_runtime::{Audience, DataError, FrameId, Gzip, Header, Limits, Loss, Protocol, PushError};
use std::future::poll_fn;
use std::pin::pin;
use std::time::Duration;

fn stream(code: u16, id: u32) -> FrameId {
    FrameId {
        kind: Toy::STREAM,
        ..command(code, id)
    }
}

fn picture(length: usize) -> Vec<u8> {
    (0..length).map(|n| n.to_le_bytes()[0]).collect()
}

#[fc_test::test]
async fn from_robot_to_app() {
    for gzip in [None, Some(Gzip::default())] {
        let robot = Robot::start(loopback().gzip(gzip), service).await;
        let app = robot.connect().await;
        let data = app.data();
        until(|| robot.handle.counters().data_connections != 0).await;
        for length in [0, 1, 1000, 100_000, 5_000_000, 3] {
            let bytes = picture(length);
            let (sent, received) = tokio::join!(
                robot.handle.send_stream(Audience::All, 0x0111, 77, &bytes),
                data.recv()
            );
            assert_eq!(sent, Ok(1));
            let received = received.unwrap();
            assert_eq!((received.code, received.id), (0x0111, 77));
            assert!(*received.data == *bytes, "{length} bytes");
            assert!(received.data.into_vec() == bytes);
        }
        assert_eq!(robot.handle.counters().stream_frames_out, 6);
        robot.handle.shutdown(Duration::from_secs(5)).await;
        let lost = data.recv().await.unwrap_err();
        assert_eq!(lost, DataError::Lost(Loss::Closed));
    }
}

#[fc_test::test]
async fn from_app_to_robot() {
    let robot = Robot::start(loopback(), service).await;
    let mut streams = robot.handle.streams();
    let app = robot.connect().await;
    let data = app.data();
    for id in 0..20 {
        let bytes = picture(100_000);
        let (sent, received) = tokio::join!(data.send(9, id, &bytes), streams.recv());
        sent.unwrap();
        let received = received.unwrap();
        assert_eq!((received.frame.code, received.frame.id), (9, id));
        assert!(*received.frame.data == *bytes);
    }
    data.close();
    assert_eq!(data.recv().await, Err(DataError::Closed(Loss::Here)));
    assert_eq!(robot.handle.counters().stream_frames_in, 20);
}

#[fc_test::test]
async fn the_app_behind_a_command_is_found_by_its_host() {
    let robot = Robot::start(loopback(), service).await;
    let _app = robot.connect().await;
    until(|| !robot.handle.connections().is_empty()).await;
    let (id, _) = robot.handle.connections()[0];
    let to_nobody = robot
        .handle
        .send_stream(Audience::One(id), 1, 2, b"x")
        .await;
    assert_eq!(to_nobody, Err(PushError::NoConnection(id)));
    let mut data = robot.raw_data();
    assert_eq!(
        robot
            .handle
            .send_stream(Audience::One(id), 1, 2, b"x")
            .await,
        Ok(1)
    );
    assert_eq!(data.recv().await, Some((stream(1, 2), "x".into())));
}

#[fc_test::test(start_paused = true)]
async fn slow_reader_delays_or_loses_only_its_frames() {
    let robot = Robot::start(loopback(), service).await;
    let _slow = robot.raw_data();
    let bytes = picture(100_000);
    let mut taken = 0;
    let start = tokio::time::Instant::now();
    loop {
        match robot
            .handle
            .send_stream(Audience::All, 1, 2, &bytes)
            .await
            .unwrap()
        {
            0 => break,
            _ => taken += 1,
        }
    }
    assert_eq!(taken, 5, "one on its way and four in the queue");
    assert_eq!(start.elapsed().as_secs(), 30);
    until(|| robot.handle.counters().connections_timed_out != 0).await;
}

/// Commands on the same thread wait for a piece of a large frame, not for all of it.
#[fc_test::test]
async fn others_have_their_turn_during_a_large_frame() {
    let robot = Robot::start(loopback(), service).await;
    let _data = robot.raw_data();
    for (length, turns) in [(1000, 0), (65_536, 0), (1_000_000, 15)] {
        let bytes = picture(length);
        let mut sending = pin!(robot.handle.send_stream(Audience::All, 1, 1, &bytes));
        let mut waited = 0;
        let sent = poll_fn(|cx| {
            let polled = sending.as_mut().poll(cx);
            waited += usize::from(polled.is_pending());
            polled
        });
        assert_eq!(sent.await, Ok(1));
        assert_eq!(waited, turns, "{length} bytes");
    }
}

#[fc_test::test(start_paused = true)]
async fn a_busy_robot_does_not_read_on() {
    let robot = Robot::start(loopback(), service).await;
    let mut streams = robot.handle.streams();
    let (app, end, _kept) = data_of_raw(1000).await;
    robot.handle.serve_data(end, nowhere()).unwrap();
    let bytes = picture(10_000);
    let mut sent = 0_u32;
    while tokio::time::timeout(Duration::from_secs(1), app.send(1, sent, &bytes))
        .await
        .is_ok()
    {
        sent += 1;
    }
    assert!(sent < 10, "{sent} frames were taken");
    // The frame whose sending was given up in the middle is finished by the next.
    let (last, ()) = tokio::join!(app.send(2, 0, b"last"), async {
        for id in 0..=sent {
            let received = streams.recv().await.unwrap().frame;
            assert_eq!((received.code, received.id), (1, id));
            assert!(*received.data == *bytes);
        }
        assert_eq!(streams.recv().await.unwrap().frame.code, 2);
    });
    last.unwrap();
}

#[fc_test::test]
async fn untaken_frames_are_dropped_and_counted() {
    let robot = Robot::start(loopback(), service).await;
    let mut data = robot.raw_data();
    for id in 0..10 {
        data.send(&frame(stream(1, id), b"x")).await;
    }
    until(|| robot.handle.counters().stream_frames_dropped >= 10).await;
    let mut old = robot.handle.streams();
    let mut new = robot.handle.streams();
    data.send(&frame(stream(1, 11), b"x")).await;
    assert_eq!(new.recv().await.unwrap().frame.id, 11);
    assert_eq!(old.recv().await, None);
}

#[fc_test::test]
async fn bad_frames_are_answered_and_the_connection_lives() {
    let robot = Robot::start(loopback(), service).await;
    let mut streams = robot.handle.streams();
    let (app, end) = tokio::io::duplex(10_000);
    robot.handle.serve_data(end, nowhere()).unwrap();
    let mut bad = frame(stream(1, 5), b"x");
    *bad.last_mut().unwrap() ^= 1;
    let mut data = common::net::Raw::new(app);
    for (bytes, id) in [
        (bad, stream(1, 5)),
        (frame(command(1, 6), b"{}"), command(1, 6)),
    ] {
        data.send(&bytes).await;
        assert_eq!(data.result().await, (answer_to(id), 71));
    }
    data.send(&frame(stream(1, 7), b"x")).await;
    assert_eq!(streams.recv().await.unwrap().frame.id, 7);
    data.send(b"nonsense").await;
    assert_eq!(data.recv().await, None);
}

#[fc_test::test]
async fn an_app_hears_of_frames_that_were_refused() {
    let (app, end, _kept) = data_of_raw(10_000).await;
    let mut robot = common::net::Raw::new(end);
    let id = stream(1, 5);
    robot.send_frame(answer_to(id), &common::result(71)).await;
    robot.send_frame(command(1, 6), "{}").await;
    let mut bad = frame(stream(1, 7), b"x");
    *bad.last_mut().unwrap() ^= 1;
    robot.send(&bad).await;
    robot.send(&frame(stream(1, 8), b"x")).await;
    let half = frame(stream(1, 9), b"x");
    robot.send(&half[..ToyHeader::LEN]).await;
    drop(robot);
    let error = app.recv().await.unwrap_err();
    assert!(matches!(&error, DataError::Refused { refusal, .. } if refusal.code == 71));
    for name in ["unexpected_frame", "bad_digest"] {
        let error = app.recv().await.unwrap_err();
        assert_eq!((error.name(), error.loss()), (name, None));
    }
    assert_eq!(app.recv().await.unwrap().id, 8);
    let error = app.recv().await.unwrap_err();
    assert_eq!(error.loss().unwrap().name(), "truncated");
}

#[fc_test::test(start_paused = true)]
async fn a_stalled_frame_is_not_waited_for() {
    let robot = Robot::start(loopback(), service).await;
    let bytes = frame(stream(1, 5), b"x");
    for (length, seconds) in [(3, 5), (ToyHeader::LEN, 30)] {
        let mut data = robot.raw_data();
        let start = tokio::time::Instant::now();
        data.send(&bytes[..length]).await;
        assert_eq!(data.recv().await, None);
        assert_eq!(start.elapsed().as_secs(), seconds);
    }
}

#[fc_test::test]
async fn too_many_data_connections() {
    let limits = Limits {
        connections: 1,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let mut one = robot.raw_data();
    one.speak(true).await;
    let (_app, end) = tokio::io::duplex(100);
    assert_eq!(robot.handle.serve_data(end, nowhere()), None);
}
