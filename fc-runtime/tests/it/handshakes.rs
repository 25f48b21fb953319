//! Connections that have yet to make a handshake: they have a place like others, and no longer than
//! they may.

use crate::common::log::{Log, alone};
use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{LIMITS, Moved};
use fc_runtime::{AckOutcome, Audience, ConnectionId, Effect, Limits};
use std::future::{pending, ready};
use std::io;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::io::DuplexStream;
use tokio::sync::oneshot;
use tokio::time::Instant;
use tracing::Level;

fn address(host: u8) -> SocketAddr {
    SocketAddr::from(([192, 0, 2, host], 1000))
}

/// A handshake that never ends; what it gives resolves once it has been dropped.
fn endless(robot: &Robot, data: bool, host: u8) -> (Option<ConnectionId>, oneshot::Receiver<()>) {
    let (held, dropped) = oneshot::channel::<()>();
    let handshake = async move {
        let _held = held;
        pending::<io::Result<DuplexStream>>().await
    };
    let id = if data {
        robot.handle.serve_data_after(handshake, address(host))
    } else {
        robot.handle.serve_after(handshake, address(host))
    };
    (id, dropped)
}

/// One that ends at once.
fn made(robot: &Robot, data: bool, host: u8) -> Raw<DuplexStream> {
    let (app, end) = tokio::io::duplex(10_000);
    let id = if data {
        robot.handle.serve_data_after(ready(Ok(end)), address(host))
    } else {
        robot.handle.serve_after(ready(Ok(end)), address(host))
    };
    id.expect("a place");
    Raw::new(app)
}

#[fc_test::test]
async fn after_the_handshake_it_is_a_connection_like_others() {
    let _alone = alone();
    let robot = Robot::start(loopback(), service).await;
    for data in [false, true] {
        made(&robot, data, 1).speak(data).await;
    }
    assert_eq!(robot.handle.counters().handshakes_failed, 0);
}

#[fc_test::test(start_paused = true)]
async fn one_that_does_not_end_is_given_up_in_time() {
    let log = Log::listen(Level::WARN);
    let robot = Robot::start(loopback().header_timeout(Duration::from_secs(5)), service).await;
    for data in [false, true] {
        let began = Instant::now();
        let (id, dropped) = endless(&robot, data, 1);
        let id = id.unwrap().to_string();
        dropped.await.unwrap_err();
        let took = began.elapsed();
        assert!(
            (Duration::from_secs(5)..Duration::from_secs(6)).contains(&took),
            "{took:?}"
        );
        let line = log.take_once(1).await.remove(0);
        assert_eq!(
            line,
            format!(
                "WARN the handshake failed: it did not come in time protocol=\"toy\" \
                 connection={} peer=192.0.2.1:1000",
                id.trim_start_matches('#')
            )
        );
    }
    assert_eq!(robot.handle.counters().handshakes_failed, 2);
    assert_eq!(robot.handle.connections(), []);
}

#[fc_test::test]
async fn one_that_fails_is_logged_with_the_reason() {
    let log = Log::listen(Level::WARN);
    let robot = Robot::start(loopback(), service).await;
    let failing = || ready(Err::<DuplexStream, _>(io::Error::other("no certificate")));
    robot.handle.serve_after(failing(), address(1)).unwrap();
    robot
        .handle
        .serve_data_after(failing(), address(1))
        .unwrap();
    for line in log.take_once(2).await {
        assert!(
            line.starts_with("WARN the handshake failed: no certificate"),
            "{line}"
        );
    }
    assert_eq!(robot.handle.counters().handshakes_failed, 2);
}

/// Unfinished handshakes do not keep others out, and leave nothing behind.
#[fc_test::test(start_paused = true)]
async fn it_gives_way_to_others_at_once() {
    let _alone = alone();
    for data in [false, true] {
        let limits = Limits {
            connections: 1,
            ..LIMITS
        };
        let robot = Robot::start(loopback().limits(limits), service).await;
        let began = Instant::now();
        let (first, dropped) = endless(&robot, data, 1);
        assert!(first.is_some());
        let mut second = made(&robot, data, 2);
        dropped.await.unwrap_err();
        assert_eq!(began.elapsed(), Duration::ZERO, "it stayed behind");
        second.speak(data).await;
        let counters = robot.handle.counters();
        assert_eq!(counters.connections_displaced, 1);
        assert_eq!(counters.handshakes_failed, 0);
    }
}

#[fc_test::test]
async fn one_from_elsewhere_is_not_begun() {
    let _alone = alone();
    let config = loopback().allow("203.0.113.0/24".parse().unwrap(), Effect::ALL);
    let robot = Robot::start(config, service).await;
    for data in [false, true] {
        let (id, dropped) = endless(&robot, data, 1);
        assert!(id.is_none());
        dropped.await.unwrap_err();
    }
    assert_eq!(robot.handle.counters().connections_forbidden, 2);
}

#[fc_test::test(start_paused = true)]
async fn a_shutdown_does_not_wait_for_it() {
    let _alone = alone();
    let robot = Robot::start(loopback(), service).await;
    let waiting = [false, true].map(|data| endless(&robot, data, 1));
    tokio::task::yield_now().await;
    let began = Instant::now();
    robot.handle.shutdown(Duration::from_secs(600)).await;
    assert_eq!(began.elapsed(), Duration::ZERO);
    for (_, dropped) in waiting {
        dropped.await.unwrap_err();
    }
}

#[fc_test::test(start_paused = true)]
async fn a_report_does_not_wait_for_one_that_fails() {
    let _alone = alone();
    let robot = Robot::start(loopback(), service).await;
    let (id, _dropped) = endless(&robot, false, 1);
    let pushed = robot.handle.push(Audience::All, &Moved { metres: 1 }).await;
    let pushed = pushed.unwrap();
    let [acknowledgement] = pushed.as_slice() else {
        panic!("{pushed:?}")
    };
    assert_eq!(Some(acknowledgement.connection), id);
    assert_eq!(acknowledgement.outcome, AckOutcome::Closed);
}
