//! Streams by code: each receiver has its own queue, and the content is read as its type.

use crate::common::net::{Robot, loopback, service};
use crate::common::{self, Echo, until};
use fc_runtime::{Audience, Body, DataConnection, DataError, Loss, StreamItem, Subscription};
use std::time::Duration;

const CURVE: u16 = 0x0111;
const FILM: u16 = 0x0112;
const OTHER: u16 = 0x0113;

async fn send(robot: &Robot, code: u16, id: u32, data: &[u8]) {
    let sent = robot.handle.send_stream(Audience::All, code, id, data);
    assert_eq!(sent.await, Ok(1));
}

async fn connect(robot: &Robot) -> DataConnection<common::Toy> {
    let data = robot.connect().await.data();
    data.connected().await.unwrap();
    until(|| robot.handle.counters().data_connections != 0).await;
    data
}

fn echo(text: &str) -> Echo {
    Echo { text: text.into() }
}

/// Bytes are received unchanged, JSON without an envelope as its type, and each frame has the id of its request.
#[fc_test::test]
async fn each_stream_is_read_as_its_type() {
    let robot = Robot::start(loopback(), service).await;
    let data = connect(&robot).await;
    let mut curve: Subscription<Echo> = data.subscribe(CURVE);
    let mut film: Subscription<Body> = data.subscribe(FILM);
    let handle = &robot.handle;
    let all = Audience::All;
    assert_eq!(
        handle.send_stream_json(all, CURVE, 7, &echo("a")).await,
        Ok(1)
    );
    send(&robot, FILM, 8, b"\x00\xFF").await;
    let content = echo("a");
    assert_eq!(curve.recv().await, Ok(StreamItem { id: 7, content }));
    let StreamItem { id, content } = film.recv().await.unwrap();
    assert_eq!((id, &*content), (8, &b"\x00\xFF"[..]));

    send(&robot, CURVE, 9, br#"{"text":1}"#).await;
    send(&robot, CURVE, 10, br#"{"text":"b"}"#).await;
    let wrong = curve.recv().await.unwrap_err();
    assert_eq!(wrong.name(), "wrong_type");
    assert!(matches!(&wrong, DataError::Invalid(error) if error.path() == "text"));
    assert_eq!(curve.recv().await.unwrap().content, echo("b"));
}

/// The robot reads the content of an app's stream as its type.
#[fc_test::test]
async fn a_robot_reads_streams_of_apps() {
    let robot = Robot::start(loopback(), service).await;
    let mut streams = robot.handle.streams();
    let data = connect(&robot).await;
    let text = echo("up");
    let (sent, received) = tokio::join!(data.send_json(CURVE, 3, &text), streams.recv());
    sent.unwrap();
    let frame = received.unwrap().frame;
    assert_eq!(*frame.data, *br#"{"text":"up"}"#);
    let allowance = fc_runtime::Allowance::DEFAULT;
    assert_eq!(frame.read::<Echo>(allowance), Ok(echo("up")));
}

/// A slow receiver gets the last frames and the number of missed ones, and delays no other receiver.
#[fc_test::test]
async fn the_oldest_makes_way() {
    let robot = Robot::start(loopback(), service).await;
    let data = connect(&robot).await;
    let mut slow: Subscription<Body> = data.subscribe(CURVE);
    let mut too: Subscription<Body> = data.subscribe(CURVE);
    let mut last: Subscription<Body> = data.subscribe(FILM);
    for id in 1..=7 {
        send(&robot, CURVE, id, &[]).await;
    }
    send(&robot, FILM, 8, &[]).await;
    // All before it has arrived by then.
    assert_eq!(last.recv().await.unwrap().id, 8);
    for subscription in [&mut slow, &mut too] {
        assert_eq!((subscription.missed(), subscription.missed()), (3, 0));
        for id in 4..=7 {
            assert_eq!(subscription.recv().await.unwrap().id, id);
        }
    }
    assert_eq!(last.missed(), 0);
}

/// Frames of other streams do not delay subscribers and are counted. Without subscribers the robot waits for the
/// receiver.
#[fc_test::test]
async fn unsubscribed_frames_delay_no_other() {
    let robot = Robot::start(loopback(), service).await;
    let data = connect(&robot).await;
    for id in 1..=3 {
        send(&robot, OTHER, id, &[]).await;
    }
    until(|| robot.handle.counters().stream_frames_out == 3).await;
    // One waits to be received, and one for that.
    let mut curve: Subscription<Body> = data.subscribe(CURVE);
    send(&robot, CURVE, 4, &[]).await;
    assert_eq!(curve.recv().await.unwrap().id, 4);
    assert_eq!((data.missed(), data.missed()), (2, 0));
    assert_eq!(data.recv().await.unwrap().id, 1);
    drop(curve);
    send(&robot, CURVE, 5, &[]).await;
    assert_eq!(data.recv().await.unwrap().id, 5);
}

/// Each subscriber is told once where frames may be missing, and in the end why there are no more.
#[fc_test::test]
async fn each_subscriber_is_told_of_a_loss() {
    let robot = Robot::start(loopback(), service).await;
    let data = connect(&robot).await;
    let mut one: Subscription<Body> = data.subscribe(CURVE);
    let mut two: Subscription<Body> = data.subscribe(CURVE);
    send(&robot, CURVE, 1, &[]).await;
    assert_eq!(two.recv().await.unwrap().id, 1);
    robot.handle.shutdown(Duration::from_secs(5)).await;
    assert_eq!(two.recv().await, Err(DataError::Lost(Loss::Closed)));
    assert_eq!(one.recv().await.unwrap().id, 1);
    assert_eq!(one.recv().await, Err(DataError::Lost(Loss::Closed)));
    data.close();
    for subscription in [&mut one, &mut two] {
        let closed = Err(DataError::Closed(Loss::Here));
        assert_eq!(subscription.recv().await, closed);
    }
}
