//! Limits of numbers at one time: calls, reports, connections.

use crate::common::net::{Raw, Robot, app_of_raw, loopback, nowhere, service};
use crate::common::{Echo, EchoReply, LIMITS, Moved, Toy, report, until};
use crate::limits::{around, echo};
use fc_runtime::{
    AckOutcome, Audience, CallError, ClientConfig, Limits, Report, Request, ServerConfig,
};
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tokio::io::DuplexStream;
use tokio::sync::Semaphore;
use tokio::task::JoinSet;

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
        // A taken report makes room again.
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
