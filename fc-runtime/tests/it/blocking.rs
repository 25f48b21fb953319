//! The client without `async`: calls and reports on plain threads, and within a runtime of another's.

use crate::common::net::{Robot, loopback, service};
use crate::common::{Done, Echo, EchoReply, Go, Moved, Step, Toy, UnderWay};
use fc_runtime::blocking::{Connection, ReportError};
use fc_runtime::{AckOutcome, Audience, CallError, ClientConfig, ConnectError, Followed};
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};

/// Only a hanging operation takes this long.
const LONG: Duration = Duration::from_secs(60);

fn echo(text: &str) -> Echo {
    Echo { text: text.into() }
}

/// A robot on its own threads.
fn robot() -> (Runtime, Robot) {
    let runtime = Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()
        .unwrap();
    let robot = runtime.block_on(Robot::start(loopback(), service));
    (runtime, robot)
}

/// Waits until the robot has no connection any more.
async fn left(robot: &Robot) {
    while !robot.handle.connections().is_empty() {
        tokio::time::sleep(Duration::from_millis(1)).await;
    }
}

/// The outcome of a report at each app.
fn push(runtime: &Runtime, robot: &Robot, metres: i32) -> Vec<AckOutcome> {
    let report = Moved { metres };
    let pushed = robot.handle.push(Audience::All, &report);
    let acknowledgements = runtime.block_on(pushed).unwrap().into_iter();
    acknowledgements.map(|ack| ack.outcome).collect()
}

#[fc_test::test]
fn calls_are_answered_and_refused() {
    let (runtime, robot) = robot();
    let app = Connection::<Toy>::connect(robot.config.clone()).unwrap();
    let answer = app.call(&echo("hello")).unwrap();
    assert_eq!(
        answer,
        EchoReply {
            text: "hello".into()
        }
    );
    let Err(CallError::Refused(refusal)) = app.call(&Go { metres: 51 }) else {
        panic!("that is too far");
    };
    assert_eq!((refusal.code, refusal.text.as_str()), (500, "too far"));
    let raw = app.wait(app.connection().call_raw(0x0101, br#"{"text":"raw"}"#));
    assert_eq!(raw.unwrap().envelope.result, 7);

    let other = app.clone();
    drop(app);
    let threads: Vec<_> = (0..4)
        .map(|number| {
            let app = other.clone();
            std::thread::spawn(move || app.call(&echo(&number.to_string())).unwrap().text)
        })
        .collect();
    for (number, thread) in threads.into_iter().enumerate() {
        assert_eq!(thread.join().unwrap(), number.to_string());
    }
    drop(other);
    runtime.block_on(left(&robot));
}

/// The app is not asked for its reports while they come.
#[fc_test::test]
fn reports_are_acknowledged_between_calls() {
    let (runtime, robot) = robot();
    let config = robot.config.clone().reconnect(None);
    let app = Connection::<Toy>::connect(config).unwrap();
    let mut reports = app.reports();
    app.call(&echo("I am here")).unwrap();
    for metres in [1, 2] {
        assert_eq!(push(&runtime, &robot, metres), [AckOutcome::Acknowledged]);
    }
    let first = reports.recv_timeout(LONG).unwrap();
    assert_eq!(first.read::<Toy, Moved>().unwrap().metres, 1);
    let second = reports.next().unwrap();
    assert_eq!(second.read::<Toy, Moved>().unwrap().metres, 2);
    let none = reports.recv_timeout(Duration::from_millis(1));
    assert_eq!(none, Err(ReportError::Timeout));
    assert_eq!(reports.missed(), 0);

    // The connection outlives its handles as long as somebody takes reports.
    drop(app);
    assert_eq!(push(&runtime, &robot, 3), [AckOutcome::Acknowledged]);
    assert!(reports.recv().is_some());

    runtime.block_on(robot.handle.shutdown(Duration::ZERO));
    assert_eq!(reports.recv_timeout(LONG), Err(ReportError::Closed));
    assert!(reports.next().is_none());
}

#[fc_test::test]
fn a_missing_robot_is_an_error() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    drop(listener);
    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    let error = Connection::<Toy>::connect(config).unwrap_err();
    assert!(matches!(error, ConnectError::Io { .. }), "{error}");
}

/// It holds up its thread there, but neither panics nor waits for ever, however often it is used in
/// one turn of a task.
#[fc_test::test]
fn it_works_and_ends_within_a_runtime() {
    let (runtime, robot) = robot();
    for within in [
        Builder::new_current_thread().enable_all().build().unwrap(),
        Builder::new_multi_thread().enable_all().build().unwrap(),
    ] {
        let config = robot.config.clone();
        let used = within.spawn(async move {
            let app = Connection::<Toy>::connect(config).unwrap();
            let mut reports = app.reports();
            for _ in 0..300 {
                app.call(&echo("again")).unwrap();
                let none = reports.recv_timeout(Duration::ZERO);
                assert_eq!(none, Err(ReportError::Timeout));
            }
            drop(app);
            drop(reports);
        });
        within.block_on(used).unwrap();
        runtime.block_on(left(&robot));
    }
}

#[fc_test::test]
fn a_command_is_followed_to_its_end() {
    let (runtime, robot) = robot();
    let app = Connection::<Toy>::connect(robot.config.clone()).unwrap();
    let mut following = app.follow::<_, UnderWay>(&Go { metres: 1 }).unwrap();
    assert_eq!(following.answer(), &Done {});
    assert_eq!(following.recv_timeout(Duration::ZERO), None);
    for step in [Step::Rolling, Step::There] {
        let report = UnderWay {
            step,
            metres: None,
            trouble: None,
        };
        let pushed = robot.handle.push(Audience::All, &report);
        runtime.block_on(pushed).unwrap();
    }
    let going = following.recv_timeout(LONG).unwrap().unwrap().unwrap();
    assert!(matches!(going, Followed::Going(_)), "{going:?}");
    let rest: Vec<_> = following.collect();
    assert!(matches!(rest[..], [Ok(Followed::Ended(_))]), "{rest:?}");
}
