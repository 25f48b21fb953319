//! Reports from robot to app, and their acknowledgements.

use crate::common::net::{Raw, Robot, app_of_raw, loopback, service};
use crate::common::{BEAT, LIMITS, Moved, Toy, answer_to, frame, report, result, until};
use fc_runtime::{
    AckOutcome, Audience, ClientConfig, Connection, Limits, PushError, RawReport, RawReports,
    Refusal, Report,
};
use futures_util::StreamExt;
use std::io::ErrorKind;
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::time::{Instant, timeout};

fn moved(metres: i32) -> Moved {
    Moved { metres }
}

fn read(raw: &RawReport) -> i32 {
    assert_eq!(raw.code, Moved::CODE);
    assert!(raw.envelope::<Toy>().unwrap().at.is_some());
    raw.read::<Toy, Moved>().unwrap().metres
}

/// Returns `true` if no report waits.
async fn is_empty(reports: &mut RawReports<Toy>) -> bool {
    timeout(Duration::from_millis(1), reports.recv())
        .await
        .is_err()
}

/// A report that comes every second: neither another kind nor a repetition counts as the last one.
#[fc_test::test(start_paused = true)]
async fn late_report_is_counted_and_delivered() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut reports = app.reports();
    let beat = BEAT.code.unwrap();
    for (code, id, after_ms, late) in [
        (beat, 1, 5_000, 0),
        (beat, 2, 1_000, 0),
        (beat, 3, 1_500, 0),
        (beat, 4, 1_501, 1),
        (Moved::CODE, 5, 9_000, 1),
        (Moved::CODE, 6, 1_000, 1),
        (beat, 7, 0, 2),
        (beat, 7, 1_400, 2),
        (beat, 8, 200, 3),
    ] {
        tokio::time::advance(Duration::from_millis(after_ms)).await;
        let id = report(code, id);
        robot.send_frame(id, r#"{"at":1,"metres":5}"#).await;
        assert_eq!(robot.result().await, (answer_to(id), 7));
        assert_eq!(app.counters().reports_late, late, "{id:?}");
    }
    assert_eq!(
        (app.counters().reports, app.counters().repeated_reports),
        (8, 1)
    );
    assert_eq!(reports.recv().await.unwrap().code, beat);
}

#[fc_test::test(start_paused = true)]
async fn the_first_report_of_a_connection_is_not_late() {
    let (pipes, mut dialled) = mpsc::unbounded_channel();
    let dial = move || {
        let (app, robot) = tokio::io::duplex(4096);
        let sent = pipes.send(robot);
        async move {
            sent.map(|()| app)
                .map_err(|_| ErrorKind::ConnectionRefused.into())
        }
    };
    let config = ClientConfig::new();
    let app = Connection::<Toy>::connect_by(dial, config).await.unwrap();
    let _reports = app.reports();
    for (number, late) in [(1, 0), (2, 0)] {
        let mut robot = Raw::new(dialled.recv().await.unwrap());
        tokio::time::advance(Duration::from_secs(9)).await;
        let id = report(BEAT.code.unwrap(), number);
        robot.send_frame(id, r#"{"at":1,"metres":5}"#).await;
        assert_eq!(robot.result().await, (answer_to(id), 7));
        assert_eq!(app.counters().reports_late, late);
    }
    assert_eq!((app.counters().reports, app.state().connects()), (2, 2));
}

#[fc_test::test]
async fn a_report_reaches_every_app_and_is_acknowledged() {
    let robot = Robot::start(loopback(), service).await;
    let apps = [robot.connect().await, robot.connect().await];
    let mut receivers = apps.each_ref().map(fc_runtime::Connection::reports);
    until(|| robot.handle.connections().len() >= 2).await;
    let mut acknowledged = robot.handle.push(Audience::All, &moved(3)).await.unwrap();
    acknowledged.sort_by_key(|ack| ack.connection);
    let expected: Vec<_> = robot
        .handle
        .connections()
        .into_iter()
        .map(|(id, _)| id)
        .collect();
    assert_eq!(
        acknowledged
            .iter()
            .map(|ack| ack.connection)
            .collect::<Vec<_>>(),
        expected
    );
    assert!(
        acknowledged
            .iter()
            .all(|ack| ack.outcome == AckOutcome::Acknowledged)
    );
    for (app, reports) in apps.iter().zip(&mut receivers) {
        assert_eq!(read(&reports.recv().await.unwrap()), 3);
        assert_eq!(app.counters().reports, 1);
    }
    let counters = robot.handle.counters();
    assert_eq!(
        (counters.reports_sent, counters.reports_acknowledged),
        (2, 2)
    );
}

#[fc_test::test]
async fn a_report_for_one_app_reaches_it_alone() {
    let robot = Robot::start(loopback(), service).await;
    let (one, two) = (
        robot.pipe(ClientConfig::new()),
        robot.pipe(ClientConfig::new()),
    );
    let (id, _) = robot.handle.connections()[1];
    let mut reports = two.reports();
    robot
        .handle
        .push(Audience::One(id), &moved(4))
        .await
        .unwrap();
    assert_eq!(read(&reports.next().await.unwrap()), 4);
    assert_eq!(one.counters().reports, 0);
    drop((two, reports));
    until(|| robot.handle.connections().len() != 2).await;
    let gone = robot.handle.push(Audience::One(id), &moved(4)).await;
    assert_eq!(gone, Err(PushError::NoConnection(id)));
}

#[fc_test::test(start_paused = true)]
async fn repeated_report_is_acknowledged_and_delivered_once() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut reports = app.reports();
    let id = report(Moved::CODE, 9);
    for _ in 0..3 {
        robot.send_frame(id, r#"{"at":1,"metres":5}"#).await;
        assert_eq!(robot.result().await, (answer_to(id), 7));
    }
    assert_eq!(read(&reports.recv().await.unwrap()), 5);
    assert!(is_empty(&mut reports).await);
    assert_eq!(
        (app.counters().reports, app.counters().repeated_reports),
        (1, 2)
    );
    // Long after the last repetition the id may be used for another report.
    tokio::time::advance(Duration::from_secs(60)).await;
    robot.send_frame(id, r#"{"at":1,"metres":6}"#).await;
    assert_eq!(read(&reports.recv().await.unwrap()), 6);
}

#[fc_test::test(start_paused = true)]
async fn a_full_queue_leaves_reports_to_be_repeated() {
    let robot = Robot::start(loopback(), service).await;
    let limits = Limits {
        queued_reports: 2,
        ..LIMITS
    };
    let app = robot.pipe(ClientConfig::new().limits(limits));
    let mut reports = app.reports();
    let start = Instant::now();
    let pushes: Vec<_> = (0..3)
        .map(|n| {
            let handle = robot.handle.clone();
            tokio::spawn(async move { handle.push(Audience::All, &moved(n)).await })
        })
        .collect();
    until(|| app.counters().reports_refused != 0).await;
    for n in 0..3 {
        assert_eq!(read(&reports.recv().await.unwrap()), n);
    }
    assert_eq!(start.elapsed().as_secs(), 2, "the time of one repetition");
    for push in pushes {
        let acknowledged = push.await.unwrap().unwrap();
        assert_eq!(acknowledged[0].outcome, AckOutcome::Acknowledged);
    }
    assert_eq!(robot.handle.counters().reports_repeated, 1);
    assert!(is_empty(&mut reports).await);
}

#[fc_test::test(start_paused = true)]
async fn a_burst_is_acknowledged_to_its_last() {
    let limits = Limits {
        queued_reports: 1000,
        ..LIMITS
    };
    let (app, mut robot) = app_of_raw(ClientConfig::new().limits(limits));
    let _reports = app.reports();
    let ids = (0..1000).map(|id| report(Moved::CODE, id));
    let burst = ids.clone().flat_map(|id| frame(id, br#"{"metres":1}"#));
    robot.send(&burst.collect::<Vec<u8>>()).await;
    for id in ids {
        assert_eq!(robot.result().await, (answer_to(id), 7));
    }
}

/// Without a receiver, reports are not acknowledged: the robot must not be told that an undeliverable report has
/// arrived.
#[fc_test::test(start_paused = true)]
async fn report_without_a_receiver_is_not_acknowledged() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.pipe(ClientConfig::new());
    for refused in [1, 2] {
        let push = tokio::spawn({
            let handle = robot.handle.clone();
            async move { handle.push(Audience::All, &moved(5)).await }
        });
        until(|| app.counters().reports_refused >= refused).await;
        // It is still to be had.
        let mut reports = app.reports();
        assert_eq!(read(&reports.recv().await.unwrap()), 5);
        let acknowledged = push.await.unwrap().unwrap();
        assert_eq!(acknowledged[0].outcome, AckOutcome::Acknowledged);
    }
    let given_up = robot.handle.push(Audience::All, &moved(6)).await.unwrap();
    assert_eq!(given_up[0].outcome, AckOutcome::TimedOut);
    assert_eq!(app.counters().reports, 2);
}

#[fc_test::test(start_paused = true)]
async fn receiver_gets_every_report_since_its_start() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut one = app.reports();
    let mut send = async |id| {
        robot
            .send_frame(report(Moved::CODE, id), r#"{"metres":1}"#)
            .await;
        assert_eq!(robot.result().await.1, 7);
    };
    send(0).await;
    let mut two = app.reports();
    send(1).await;
    send(2).await;
    for (reports, ids) in [(&mut one, 0..3), (&mut two, 1..3)] {
        for id in ids {
            assert_eq!(reports.recv().await.unwrap().id, id);
        }
        assert!(is_empty(reports).await);
    }
    assert_eq!(
        (app.counters().reports, app.counters().reports_missed),
        (3, 0)
    );
}

/// A receiver that is not read costs the others nothing, and learns what it has missed.
#[fc_test::test(start_paused = true)]
async fn a_full_receiver_misses_reports() {
    let limits = Limits {
        queued_reports: 2,
        ..LIMITS
    };
    let (app, mut robot) = app_of_raw(ClientConfig::new().limits(limits));
    let (mut quick, mut slow) = (app.reports(), app.reports());
    for id in 0..5 {
        robot
            .send_frame(report(Moved::CODE, id), r#"{"metres":1}"#)
            .await;
        assert_eq!(
            robot.result().await,
            (answer_to(report(Moved::CODE, id)), 7)
        );
        assert_eq!(quick.recv().await.unwrap().id, id);
    }
    for id in 0..2 {
        assert_eq!(slow.recv().await.unwrap().id, id);
    }
    assert!(is_empty(&mut slow).await);
    assert_eq!((slow.missed(), slow.missed(), quick.missed()), (3, 0, 0));
    assert_eq!(
        (app.counters().reports, app.counters().reports_missed),
        (5, 3)
    );
}

#[fc_test::test]
async fn reports_end_with_the_connection() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut reports = app.reports();
    robot
        .send_frame(report(Moved::CODE, 1), r#"{"metres":1}"#)
        .await;
    robot.result().await;
    drop(app);
    // The receiver keeps the connection open.
    robot
        .send_frame(report(Moved::CODE, 2), r#"{"metres":1}"#)
        .await;
    robot.result().await;
    drop(robot);
    let ids: Vec<_> = (&mut reports).map(|report| report.id).collect().await;
    assert_eq!(ids, [1, 2]);
}

#[fc_test::test(start_paused = true)]
async fn unacknowledged_report_is_repeated() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    let start = Instant::now();
    let push = tokio::spawn({
        let handle = robot.handle.clone();
        async move { handle.push(Audience::All, &moved(1)).await }
    });
    let (first, body) = app.recv().await.unwrap();
    for attempt in 1..=3 {
        assert_eq!(app.recv().await.unwrap(), (first, body.clone()));
        assert_eq!(start.elapsed().as_secs(), attempt * 2);
    }
    let acknowledged = push.await.unwrap().unwrap();
    assert_eq!(acknowledged[0].outcome, AckOutcome::TimedOut);
    assert_eq!(start.elapsed().as_secs(), 8);
    let counters = robot.handle.counters();
    assert_eq!(
        (counters.reports_repeated, counters.reports_timed_out),
        (3, 1)
    );
}

#[fc_test::test(start_paused = true)]
async fn repetitions_to_many_apps_do_not_come_at_once() {
    let limits = Limits {
        connections: 32,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let mut apps: Vec<_> = (0..32).map(|_| robot.raw()).collect();
    let start = Instant::now();
    let handle = robot.handle.clone();
    tokio::spawn(async move { handle.push(Audience::All, &moved(1)).await });
    for app in &mut apps {
        app.recv().await.unwrap();
    }
    assert_eq!(start.elapsed().as_millis(), 0);
    let again = apps.iter_mut().map(|app| async {
        app.recv().await.unwrap();
        start.elapsed().as_millis()
    });
    let mut times = futures_util::future::join_all(again).await;
    times.sort_unstable();
    assert!((2000..=2250).contains(&times[0]) && (2000..=2250).contains(&times[31]));
    times.dedup();
    assert_eq!(times.len(), 32, "{times:?}");
}

#[fc_test::test]
async fn other_answers_to_a_report() {
    let robot = Robot::start(loopback(), service).await;
    let mut app = robot.raw();
    for (answer, expected) in [
        (result(71), AckOutcome::Refused(Refusal::new(71, ""))),
        (result(7), AckOutcome::Acknowledged),
    ] {
        let report = moved(1);
        let (acknowledged, ()) = tokio::join!(robot.handle.push(Audience::All, &report), async {
            let (id, _) = app.recv().await.unwrap();
            app.send_frame(answer_to(id), &answer).await;
        });
        assert_eq!(acknowledged.unwrap()[0].outcome, expected);
    }
    let report = moved(1);
    let (acknowledged, ()) = tokio::join!(robot.handle.push(Audience::All, &report), async {
        let (id, _) = app.recv().await.unwrap();
        app.send_frame(answer_to(id), "[]").await;
    });
    let outcome = acknowledged.unwrap().remove(0).outcome;
    assert!(matches!(outcome, AckOutcome::Invalid(_)), "{outcome:?}");
}

#[fc_test::test(start_paused = true)]
async fn a_slow_app_loses_its_own_oldest_reports() {
    let limits = Limits {
        queued_reports: 3,
        in_flight: 2,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let slow = robot.raw();
    let quick = robot.pipe(ClientConfig::new());
    let mut reports = quick.reports();
    let mut pushes = Vec::new();
    // The slow one acknowledges nothing: two are in flight, three wait, five gave way.
    for n in 0..10 {
        let handle = robot.handle.clone();
        pushes.push(tokio::spawn(async move {
            handle.push(Audience::All, &moved(n)).await
        }));
        assert_eq!(read(&reports.recv().await.unwrap()), n);
    }
    drop(slow);
    let mut outcomes = Vec::new();
    for push in pushes {
        let acknowledged = push.await.unwrap().unwrap();
        let mut outcome: Vec<_> = acknowledged.into_iter().map(|ack| ack.outcome).collect();
        outcome.retain(|outcome| *outcome != AckOutcome::Acknowledged);
        outcomes.append(&mut outcome);
    }
    let (dropped, closed) = (AckOutcome::Dropped, AckOutcome::Closed);
    let in_flight = [(); 2].map(|()| closed.clone());
    let gave_way = [(); 5].map(|()| dropped.clone());
    let waiting = [(); 3].map(|()| closed.clone());
    assert_eq!(outcomes, [&in_flight[..], &gave_way, &waiting].concat());
    assert_eq!(robot.handle.counters().reports_dropped, 5);
}

#[fc_test::test]
async fn unreadable_report_is_refused() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let mut reports = app.reports();
    until(|| !robot.handle.connections().is_empty()).await;
    /// The same code with another type, as in another version of the spec.
    #[derive(Clone, Debug, PartialEq, fc_derive::Message, fc_derive::Report)]
    #[fc(code = 0x0B01, name = "moved")]
    struct Newer {
        metres: String,
    }
    let newer = Newer {
        metres: "secret".into(),
    };
    let refused = robot.handle.push(Audience::All, &newer).await.unwrap();
    let AckOutcome::Refused(refusal) = &refused[0].outcome else {
        panic!("{refused:?}");
    };
    assert_eq!(refusal.code, 73);
    assert!(
        refusal.text.contains("metres") && !refusal.text.contains("secret"),
        "{refusal}"
    );
    robot.handle.push(Audience::All, &moved(1)).await.unwrap();
    assert_eq!(read(&reports.recv().await.unwrap()), 1);
    assert_eq!(
        (app.counters().reports, app.counters().reports_invalid),
        (1, 1)
    );
}

#[fc_test::test]
async fn invalid_report_is_refused() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut reports = app.reports();
    let bodies = ["no", "[]", r#"{"at":"noon"}"#, "{}", r#"{"metres":1}"#];
    for (id, body) in (0..).zip(bodies) {
        let id = report(Moved::CODE, id);
        robot.send_frame(id, body).await;
        let expected = if body.contains("metres") { 7 } else { 73 };
        assert_eq!(robot.result().await, (answer_to(id), expected), "{body}");
    }
    // Reports with unknown codes may have any content.
    robot.send_frame(report(0x0B99, 9), "{}").await;
    assert_eq!(robot.result().await.1, 7);
    assert_eq!(
        (app.counters().reports, app.counters().reports_invalid),
        (2, 4)
    );
    assert_eq!(read_metres(&reports.recv().await.unwrap()), 1);
    assert_eq!(reports.recv().await.unwrap().code, 0x0B99);
}

fn read_metres(raw: &RawReport) -> i32 {
    raw.read::<Toy, Moved>().unwrap().metres
}

/// Nesting that this app allows is readable, also beyond the protocol's default.
#[fc_test::test]
async fn a_report_that_is_acknowledged_reads() {
    for (depth, expected) in [(LIMITS.json_depth, 73), (LIMITS.json_depth + 9, 7)] {
        let limits = Limits {
            json_depth: depth,
            ..LIMITS
        };
        let (app, mut robot) = app_of_raw(ClientConfig::new().limits(limits));
        let mut reports = app.reports();
        let nested = format!(
            r#"{{"metres":1,"more":{}{}}}"#,
            "[".repeat(LIMITS.json_depth + 4),
            "]".repeat(LIMITS.json_depth + 4)
        );
        robot.send_frame(report(Moved::CODE, 1), &nested).await;
        assert_eq!(robot.result().await.1, expected);
        if expected == 7 {
            assert_eq!(read_metres(&reports.recv().await.unwrap()), 1);
        }
    }
}

/// Found by the schedules of `network`: the receivers had seen the end already.
#[fc_test::test]
async fn report_after_close_is_not_acknowledged() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut reports = app.reports();
    tokio::task::yield_now().await;
    robot
        .send_frame(report(Moved::CODE, 1), r#"{"metres":1}"#)
        .await;
    app.close();
    assert_eq!(reports.recv().await, None);
    assert_eq!(robot.recv().await, None);
    assert_eq!(app.counters().reports, 0);
}
