//! A stream for one app reaches no other, also where several apps share an address.

use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{Echo, Toy, command, frame, until};
use fc_runtime::{Audience, Connection, ConnectionId, FrameId, Protocol, PushError};
use std::net::{Ipv4Addr, SocketAddr};
use tokio::io::DuplexStream;
use tokio::task::yield_now;

type App = (ConnectionId, Raw<DuplexStream>);

fn host(number: u8) -> SocketAddr {
    SocketAddr::from((Ipv4Addr::new(192, 0, 2, number), 1000))
}

fn app(robot: &Robot, number: u8) -> App {
    let (app, end) = tokio::io::duplex(10_000);
    let id = robot.handle.serve(end, host(number)).unwrap();
    (id, Raw::new(app))
}

fn data(robot: &Robot, number: u8) -> App {
    let (app, end) = tokio::io::duplex(10_000);
    let id = robot.handle.serve_data(end, host(number)).unwrap();
    (id, Raw::new(app))
}

async fn leave(robot: &Robot, (id, raw): App) {
    drop(raw);
    until(|| {
        !robot
            .handle
            .connections()
            .iter()
            .any(|(known, _)| *known == id)
    })
    .await;
}

async fn send(robot: &Robot, to: ConnectionId, text: &str) -> Result<usize, PushError> {
    let audience = Audience::One(to);
    robot
        .handle
        .send_stream(audience, 1, 2, text.as_bytes())
        .await
}

async fn text(data: &mut App) -> String {
    data.1.recv().await.unwrap().1
}

/// Only this has arrived on any of these connections.
async fn only(robot: &Robot, connections: &mut [&mut App]) {
    let sent = robot.handle.send_stream(Audience::All, 1, 2, b"all").await;
    assert_eq!(sent, Ok(connections.len()));
    for data in connections {
        assert_eq!(text(data).await, "all");
    }
}

#[fc_test::test]
async fn apps_at_one_address_get_only_their_streams() {
    let robot = Robot::start(loopback(), service).await;
    let first = app(&robot, 1);
    let mut first_data = data(&robot, 1);
    assert_eq!(send(&robot, first.0, "alone").await, Ok(1));
    assert_eq!(text(&mut first_data).await, "alone");

    let second = app(&robot, 1);
    for id in [first.0, second.0] {
        assert_eq!(send(&robot, id, "?").await, Err(PushError::Ambiguous(id)));
    }
    let mut second_data = data(&robot, 1);
    for id in [first.0, second.0] {
        assert_eq!(send(&robot, id, "?").await, Err(PushError::Ambiguous(id)));
    }
    // By its own id each can be reached.
    assert_eq!(send(&robot, second_data.0, "own").await, Ok(1));
    assert_eq!(text(&mut second_data).await, "own");
    only(&robot, &mut [&mut first_data, &mut second_data]).await;
}

#[fc_test::test]
async fn leftover_data_connection_gets_no_later_frames() {
    let robot = Robot::start(loopback(), service).await;
    let first = app(&robot, 1);
    let mut left_behind = data(&robot, 1);
    leave(&robot, first).await;
    let second = app(&robot, 1);
    let error = send(&robot, second.0, "?").await.unwrap_err();
    assert_eq!(error.name(), "ambiguous");
    // A connection that it makes now is its own.
    let mut own = data(&robot, 1);
    assert_eq!(send(&robot, second.0, "own").await, Ok(1));
    assert_eq!(text(&mut own).await, "own");
    only(&robot, &mut [&mut left_behind, &mut own]).await;
}

#[fc_test::test]
async fn lone_app_gets_streams_on_all_its_connections() {
    let robot = Robot::start(loopback(), service).await;
    // The order does not matter while the app is alone.
    let mut early = data(&robot, 1);
    let one = app(&robot, 1);
    let mut late = data(&robot, 1);
    let other = app(&robot, 2);
    assert_eq!(
        send(&robot, other.0, "?").await,
        Err(PushError::NoConnection(other.0))
    );
    let mut others = data(&robot, 2);
    assert_eq!(send(&robot, one.0, "one").await, Ok(2));
    assert_eq!(send(&robot, other.0, "other").await, Ok(1));
    assert_eq!(text(&mut early).await, "one");
    assert_eq!(text(&mut late).await, "one");
    assert_eq!(text(&mut others).await, "other");
    only(&robot, &mut [&mut early, &mut late, &mut others]).await;
}

/// Apps that share an address are answered on the connection of the request.
#[fc_test::test]
async fn a_frame_names_the_connection_to_answer_on() {
    let robot = Robot::start(loopback(), service).await;
    let mut streams = robot.handle.streams();
    let _apps = [app(&robot, 1), app(&robot, 1)];
    let (mut asks, mut other) = (data(&robot, 1), data(&robot, 1));
    let id = FrameId {
        kind: Toy::STREAM,
        ..command(1, 77)
    };
    asks.1.send(&frame(id, b"")).await;
    let asked = streams.recv().await.unwrap();
    assert_eq!((asked.connection, asked.frame.id), (asks.0, 77));
    assert_eq!(send(&robot, asked.connection, "answer").await, Ok(1));
    assert_eq!(text(&mut asks).await, "answer");
    only(&robot, &mut [&mut asks, &mut other]).await;
}

/// Over sockets, where the robot accepts waiting connections in any order.
#[fc_test::test]
async fn data_connection_follows_its_command_connection() {
    for _ in 0..20 {
        let robot = Robot::start(loopback(), service).await;
        let first = Connection::<Toy>::connect(robot.config.clone())
            .await
            .unwrap();
        assert!(first.call(&Echo { text: "x".into() }).await.is_ok());
        let (id, _) = robot.handle.connections()[0];
        let second = Connection::<Toy>::connect(robot.config.clone())
            .await
            .unwrap();
        let _data = second.data();
        while robot.handle.counters().data_connections == 0 {
            // The connection of one app is never taken for that of another.
            let sent = send(&robot, id, "?").await;
            assert!(matches!(
                sent,
                Err(PushError::NoConnection(_) | PushError::Ambiguous(_))
            ));
            yield_now().await;
        }
        assert_eq!(send(&robot, id, "?").await, Err(PushError::Ambiguous(id)));
    }
}
