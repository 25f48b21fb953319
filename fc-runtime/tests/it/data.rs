//! Losses of an app's data connection: it is made again, and losses are reported.

use crate::common::net::{Raw, Robot, app_of_raw, data_of_raw, data_over, loopback, service};
use crate::common::{Echo, Toy, command, frame, until};
use fc_runtime::{
    Audience, Backoff, ClientConfig, Connection, ConnectionState, DataError, FrameId, Loss,
    Protocol,
};
use std::io::ErrorKind;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{AsyncReadExt, DuplexStream, duplex};
use tokio::net::TcpStream;
use tokio::sync::mpsc;
use tokio::task::yield_now;
use tokio::time::{Instant, sleep, timeout};

const REFUSED: Loss = Loss::Unreachable(ErrorKind::ConnectionRefused);

fn stream(id: u32) -> FrameId {
    FrameId {
        kind: Toy::STREAM,
        ..command(1, id)
    }
}

/// A command connection over pipes that can be made again.
async fn commands() -> (Connection<Toy>, mpsc::UnboundedReceiver<DuplexStream>) {
    let (pipes, dialled) = mpsc::unbounded_channel();
    let dial = move || {
        let (app, robot) = duplex(10_000);
        let taken = pipes.send(robot);
        async move {
            taken
                .map(|()| app)
                .map_err(|_| ErrorKind::ConnectionRefused.into())
        }
    };
    let app = Connection::connect_by(dial, ClientConfig::new()).await;
    (app.unwrap(), dialled)
}

#[fc_test::test(start_paused = true)]
async fn it_comes_back_and_each_side_is_told_once() {
    let (app, _commands) = app_of_raw(ClientConfig::new());
    let (data, mut dialled) = data_over(&app, 10_000);
    let mut states = data.states();
    assert_eq!(states.recv().await.unwrap().why(), Some(Loss::NotYet));
    let mut robot = Raw::new(dialled.recv().await.unwrap());
    let connected = |connects| Some(ConnectionState::Connected { connects });
    assert_eq!(states.recv().await, connected(1));
    robot.send(&frame(stream(1), b"one")).await;
    data.send(1, 1, b"sent").await.unwrap();
    robot.recv().await.unwrap();
    drop(robot);
    let why = Loss::Closed;
    let lost = ConnectionState::Connecting { connects: 1, why };
    assert_eq!(states.recv().await, Some(lost));
    let mut robot = Raw::new(dialled.recv().await.unwrap());
    assert_eq!(states.recv().await, connected(2));
    robot.send(&frame(stream(2), b"two")).await;
    // In the order in which it happened.
    assert_eq!(&*data.recv().await.unwrap().data, b"one");
    // The same if there is room for later frames meanwhile.
    sleep(Duration::from_millis(1)).await;
    assert_eq!(data.recv().await, Err(DataError::Lost(why)));
    assert_eq!(&*data.recv().await.unwrap().data, b"two");
    // Frames sent before may not have arrived.
    assert_eq!(data.send(1, 2, b"no").await, Err(DataError::Lost(why)));
    data.send(1, 3, b"yes").await.unwrap();
    assert_eq!(robot.recv().await.unwrap().0.id, 3);
}

/// A sender without sent frames has lost nothing.
#[fc_test::test(start_paused = true)]
async fn a_frame_waits_for_the_next_connection() {
    let (app, _commands) = app_of_raw(ClientConfig::new());
    let (data, mut dialled) = data_over(&app, 10_000);
    drop(dialled.recv().await.unwrap());
    let (sent, ()) = tokio::join!(
        async {
            until(|| data.state().connects() != 0 && !data.state().is_connected()).await;
            data.send(1, 7, b"x").await
        },
        async {
            let mut robot = Raw::new(dialled.recv().await.unwrap());
            assert_eq!(robot.recv().await.unwrap().0.id, 7);
        }
    );
    assert_eq!(sent, Ok(()));
    assert_eq!(data.recv().await, Err(DataError::Lost(Loss::Unheard)));
}

#[fc_test::test(start_paused = true)]
async fn a_frame_on_its_way_is_lost_with_its_connection() {
    let (data, mut robot, _kept) = data_of_raw(1000).await;
    let large = vec![0; 100_000];
    let (sent, ()) = tokio::join!(data.send(1, 1, &large), async {
        robot.read_u8().await.unwrap();
        drop(robot);
    });
    assert_eq!(sent, Err(DataError::Lost(Loss::Unheard)));
    // It has been told, and the next one goes out.
    assert_eq!(data.send(1, 2, b"x").await, Ok(()));
}

/// The frame that was given up in the middle is told of by the next.
#[fc_test::test(start_paused = true)]
async fn cancelled_frame_is_reported_by_the_next() {
    let (data, robot, _kept) = data_of_raw(1000).await;
    let large = vec![0; 100_000];
    let second = Duration::from_secs(1);
    assert!(timeout(second, data.send(1, 1, &large)).await.is_err());
    let (sent, ()) = tokio::join!(data.send(1, 2, b"x"), async {
        yield_now().await;
        drop(robot);
    });
    assert_eq!(sent, Err(DataError::Lost(Loss::Unheard)));
}

#[fc_test::test(start_paused = true)]
async fn sending_without_a_connection_times_out_with_reason() {
    let (app, _commands) = app_of_raw(ClientConfig::new());
    let refused = || async { Err::<DuplexStream, _>(ErrorKind::ConnectionRefused.into()) };
    let data = app.data_by(refused);
    let start = Instant::now();
    let all = tokio::join!(
        data.send(1, 1, b"x"),
        data.send(1, 2, b"x"),
        data.connected()
    );
    let not = Err(DataError::NotConnected(REFUSED));
    assert_eq!(all, (not.clone(), not.clone(), not));
    assert_eq!(start.elapsed(), Toy::DEFAULTS.call_timeout);

    let silent = app.data_by(std::future::pending::<std::io::Result<DuplexStream>>);
    let mut states = silent.states();
    while states.recv().await.unwrap().why() != Some(Loss::ConnectTimeout) {}
    app.close();
    for data in [data, silent] {
        assert_eq!(data.closed().await, Loss::Here);
        let closed = DataError::Closed(Loss::Here);
        assert_eq!(data.send(1, 1, b"x").await, Err(closed.clone()));
        assert_eq!(data.connected().await, Err(closed.clone()));
        assert_eq!(data.recv().await, Err(closed));
    }
}

/// A frame that was not sent in time is not sent later.
#[fc_test::test(start_paused = true)]
async fn unsent_frames_are_withdrawn() {
    let (app, mut dialled) = commands().await;
    let (data, mut ends) = data_over(&app, 10_000);
    drop((dialled.recv().await, ends.recv().await));
    // No command connection, and so none for data.
    let mut blocked = Vec::new();
    until(|| !data.state().is_connected() && !app.state().is_connected()).await;
    dialled.close();
    while let Some(pipe) = dialled.recv().await {
        blocked.push(pipe);
    }
    drop(blocked);
    let late = data.send(1, 1, b"late").await.unwrap_err();
    assert_eq!(late, DataError::NotConnected(REFUSED));
    let given_up = timeout(Duration::from_secs(1), data.send(1, 2, b"x")).await;
    assert!(given_up.is_err());
    app.close();
    assert_eq!(data.closed().await, Loss::Here);
    assert!(ends.recv().await.is_none());
}

#[fc_test::test(start_paused = true)]
async fn it_is_made_again_when_the_command_connection_was() {
    let (app, mut dialled) = commands().await;
    let first = dialled.recv().await.unwrap();
    let (data, mut ends) = data_over(&app, 10_000);
    let mut old = Raw::new(ends.recv().await.unwrap());
    data.send(1, 1, b"x").await.unwrap();
    old.recv().await.unwrap();
    drop(first);
    let _second = dialled.recv().await.unwrap();
    assert_eq!(old.recv().await, None);
    assert_eq!(data.recv().await, Err(DataError::Lost(Loss::Renewed)));
    let _new = ends.recv().await.unwrap();
    data.connected().await.unwrap();
    assert_eq!((app.state().connects(), data.state().connects()), (2, 2));
    assert!(ends.try_recv().is_err(), "one for each command connection");
}

/// As long as there is no command connection, the robot could not tell whose it is.
#[fc_test::test(start_paused = true)]
async fn it_waits_for_the_command_connection() {
    let mut refused = 3;
    let dial = move || {
        refused -= 1;
        let pipe = duplex(1000);
        async move {
            if refused >= 0 {
                return Err(ErrorKind::ConnectionRefused.into());
            }
            // Kept open for as long as the test.
            std::mem::forget(pipe.1);
            Ok(pipe.0)
        }
    };
    let app = Connection::<Toy>::connect_lazy_by(dial, ClientConfig::new());
    let (data, mut ends) = data_over(&app, 1000);
    let mut states = data.states();
    while states.recv().await.unwrap().why() != Some(REFUSED) {}
    assert!(ends.try_recv().is_err());
    assert_eq!(data.connected().await, Ok(()));
    assert!(app.state().is_connected());
    assert!(ends.try_recv().is_ok());
}

#[fc_test::test(start_paused = true)]
async fn it_is_given_up_as_configured() {
    let attempts = Backoff {
        attempts: Some(3),
        ..Backoff::default()
    };
    for (backoff, tried) in [(Some(attempts), 3), (None, 1)] {
        let (app, _commands) = app_of_raw(ClientConfig::new().reconnect(backoff));
        let (counted, mut count) = mpsc::unbounded_channel();
        let data = app.data_by(move || {
            counted.send(()).unwrap();
            async { Err::<DuplexStream, _>(ErrorKind::ConnectionRefused.into()) }
        });
        assert_eq!(data.closed().await, REFUSED);
        assert_eq!(data.recv().await, Err(DataError::Closed(REFUSED)));
        let mut attempts = 0;
        while count.try_recv().is_ok() {
            attempts += 1;
        }
        assert_eq!(attempts, tried);
        assert!(app.state().is_connected());
    }
}

/// Frames wait at the robot, not in the app's memory.
#[fc_test::test(start_paused = true)]
async fn an_app_that_does_not_receive_does_not_collect() {
    let (data, robot, _kept) = data_of_raw(1000).await;
    let mut robot = Raw::new(robot);
    let bytes = frame(stream(1), &[b'x'; 2000]);
    let mut taken = 0_usize;
    while timeout(Duration::from_secs(1), robot.send(&bytes))
        .await
        .is_ok()
    {
        taken += 1;
        assert!(taken < 10, "{taken} frames were read");
    }
    for _ in 0..taken {
        assert_eq!(data.recv().await.unwrap().data.len(), 2000);
    }
}

#[fc_test::test(start_paused = true)]
async fn a_sending_app_notices_a_loss() {
    let (data, robot, _kept) = data_of_raw(10_000).await;
    data.send(1, 1, b"x").await.unwrap();
    drop(robot);
    // There is no receiver.
    let mut states = data.states();
    while states.recv().await.unwrap().connects() < 2 {}
    assert_eq!(
        data.send(1, 2, b"x").await,
        Err(DataError::Lost(Loss::Unheard))
    );
    data.send(1, 3, b"x").await.unwrap();
}

#[fc_test::test(start_paused = true)]
async fn a_frame_is_finished_before_the_end() {
    let (data, robot, _kept) = data_of_raw(1000).await;
    let mut robot = Raw::new(robot);
    let large = vec![b'x'; 5000];
    let (sent, ()) = tokio::join!(data.send(1, 1, &large), async {
        yield_now().await;
        data.close();
        assert_eq!(robot.recv().await.unwrap().1.len(), 5000);
        assert_eq!(robot.recv().await, None);
        drop(robot);
    });
    assert_eq!(sent, Ok(()));
    assert_eq!(data.closed().await, Loss::Here);
}

#[fc_test::test(start_paused = true)]
async fn dropping_it_ends_it() {
    let (data, robot, _kept) = data_of_raw(1000).await;
    drop(data);
    assert_eq!(Raw::new(robot).recv().await, None);
}

/// The purpose of all this: after a new command connection, the robot can still assign the data connection to its app.
#[fc_test::test]
async fn the_robot_knows_whose_it_is_again() {
    let robot = Robot::start(loopback(), service).await;
    // After a restart of the robot, another app may have the former ports.
    let ports = Arc::new(Mutex::new([robot.command, robot.data]));
    let dial = |port: usize| {
        let ports = Arc::clone(&ports);
        move || TcpStream::connect(ports.lock().unwrap()[port])
    };
    let app = Connection::<Toy>::connect_by(dial(0), ClientConfig::new());
    let app = app.await.unwrap();
    let data = app.data_by(dial(1));
    data.connected().await.unwrap();
    robot.handle.shutdown(Duration::ZERO).await;
    assert_eq!(data.recv().await.unwrap_err().name(), "lost");
    let robot = Robot::start(loopback(), service).await;
    *ports.lock().unwrap() = [robot.command, robot.data];
    assert!(app.call(&Echo { text: "x".into() }).await.is_ok());
    data.connected().await.unwrap();
    until(|| robot.handle.counters().data_connections != 0).await;
    let (id, _) = robot.handle.connections()[0];
    let one = Audience::One(id);
    let (sent, received) = tokio::join!(robot.handle.send_stream(one, 1, 2, b"x"), async {
        loop {
            match data.recv().await {
                Err(DataError::Lost(_)) => {}
                received => return received,
            }
        }
    });
    assert_eq!(sent, Ok(1));
    assert_eq!(received.unwrap().id, 2);
}
