//! Lost connections and coming back.

use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{Done, Echo, Go, LIMITS, Moved, Toy, answer_to, report, result, until};
use fc_derive::{Command, Message};
use fc_runtime::{
    Backoff, CallError, CallOptions, ClientConfig, Command, Connection, FrameError, Limits, Loss,
    Report,
};
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::time::timeout;

const AT_ONCE: Backoff = Backoff {
    first: Duration::ZERO,
    longest: Duration::ZERO,
    attempts: Some(3),
};

/// Its effect is unknown.
#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0301, name = "probe", effect = "unknown", response = Done)]
struct Probe {}

fn echo(text: &str) -> Echo {
    Echo {
        text: text.to_owned(),
    }
}

/// A robot that is a test, over TCP, so that it can be connected to again.
async fn listen() -> (TcpListener, ClientConfig) {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let port = listener.local_addr().unwrap().port();
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(port)
        .reconnect(AT_ONCE);
    (listener, config)
}

/// The next connection of an app. Only a test that fails waits for so long.
async fn accept(listener: &TcpListener) -> Raw<TcpStream> {
    let accepted = timeout(Duration::from_secs(10), listener.accept()).await;
    Raw::new(accepted.expect("a connection").unwrap().0)
}

#[fc_test::test]
async fn no_robot() {
    let (listener, config) = listen().await;
    drop(listener);
    let error = Connection::<Toy>::connect(config).await.unwrap_err();
    assert_eq!(error.name(), "io");
    assert!(error.to_string().contains("127.0.0.1:"), "{error}");
}

#[fc_test::test]
async fn read_is_sent_again_after_a_loss_others_are_not() {
    let (listener, config) = listen().await;
    let (app, mut robot) = tokio::join!(Connection::<Toy>::connect(config), async {
        accept(&listener).await
    });
    let app = app.unwrap();
    let (read, motion, forced, held) = (echo("x"), Go { metres: 1 }, Go { metres: 2 }, echo("y"));
    let unknown = Probe {};
    let again = |repeat| CallOptions {
        repeat: Some(repeat),
        timeout: None,
    };
    let script = async {
        let mut ids = Vec::new();
        for _ in 0..5 {
            ids.push(robot.recv().await.unwrap());
        }
        drop(robot);
        let mut robot = accept(&listener).await;
        for _ in 0..2 {
            let (id, body) = robot.recv().await.unwrap();
            let (first, _) = ids
                .iter()
                .find(|(first, _)| *first == id)
                .expect("the same id");
            assert!(matches!(first.code, Echo::CODE | Go::CODE));
            let answer = format!(
                r#"{{"result":7,"text":{}}}"#,
                if body.contains('x') { "\"x\"" } else { "\"\"" }
            );
            robot.send_frame(answer_to(id), &answer).await;
        }
        robot
    };
    let (read, motion, unknown, forced, held, _robot) = tokio::join!(
        app.call(&read),
        app.call(&motion),
        app.call(&unknown),
        app.call(&forced).with_options(again(true)),
        app.call(&held).with_options(again(false)),
        script
    );
    assert_eq!(read.unwrap().text, "x");
    assert_eq!(motion, Err(CallError::Lost(Loss::Unheard)));
    assert_eq!(unknown, Err(CallError::Lost(Loss::Unheard)));
    assert_eq!(forced, Ok(Done {}));
    assert_eq!(held, Err(CallError::Lost(Loss::Unheard)));
    assert_eq!(app.state().connects(), 2);
}

#[fc_test::test]
async fn attempts_are_those_that_fail() {
    let (listener, config) = listen().await;
    let (app, robot) = tokio::join!(Connection::<Toy>::connect(config), async {
        accept(&listener).await
    });
    let app = app.unwrap();
    // Closed without a frame, more often than attempts may fail.
    drop(robot);
    for _ in 0..3 * AT_ONCE.attempts.unwrap() {
        drop(accept(&listener).await);
    }
    let mut robot = accept(&listener).await;
    let request = Go { metres: 1 };
    let (done, ()) = tokio::join!(app.call(&request), async {
        let (id, _) = robot.recv().await.unwrap();
        robot.send_frame(answer_to(id), &result(7)).await;
    });
    assert_eq!(done, Ok(Done {}));
}

#[fc_test::test]
async fn report_repeated_after_a_loss_arrives_once() {
    let (listener, config) = listen().await;
    let (app, mut robot) = tokio::join!(Connection::<Toy>::connect(config), async {
        accept(&listener).await
    });
    let app = app.unwrap();
    let mut reports = app.reports();
    let id = report(Moved::CODE, 5);
    let push = async |robot: &mut Raw<TcpStream>, metres: i32| {
        let text = format!(r#"{{"metres":{metres}}}"#);
        robot.send_frame(id, &text).await;
        assert_eq!(robot.result().await, (answer_to(id), 7));
    };
    push(&mut robot, 1).await;
    drop(robot);
    let mut robot = accept(&listener).await;
    push(&mut robot, 1).await;
    // The same id for another report after a restart of the robot.
    drop(robot);
    let mut robot = accept(&listener).await;
    push(&mut robot, 2).await;
    for metres in [1, 2] {
        let report = reports.recv().await.unwrap();
        assert_eq!(report.read::<Toy, Moved>().unwrap(), Moved { metres });
    }
    app.close();
    assert_eq!(reports.recv().await, None);
}

#[fc_test::test]
async fn unsent_call_is_not_sent_after_a_loss() {
    let (listener, config) = listen().await;
    let (app, robot) = tokio::join!(Connection::<Toy>::connect(config), async {
        accept(&listener).await
    });
    let app = app.unwrap();
    let held = CallOptions {
        repeat: Some(false),
        timeout: None,
    };
    // The robot does not read: the first request fills the connection, and the others wait in the app until the
    // connection is lost.
    let (first, second, go) = (large(), large(), Go { metres: 1 });
    let turns = async {
        for _ in 0..100 {
            tokio::task::yield_now().await;
        }
    };
    let calls = async {
        tokio::join!(app.call(&first).with_options(held), async {
            turns.await;
            tokio::join!(app.call(&second).with_options(held), app.call(&go))
        })
    };
    let lost = async {
        until(|| app.in_flight() >= 3).await;
        drop(robot);
        accept(&listener).await
    };
    let ((first, (second, go)), mut robot) = tokio::join!(calls, lost);
    assert_eq!(first, Err(CallError::Lost(Loss::Unheard)));
    assert_eq!(second, Err(CallError::Lost(Loss::Unheard)));
    assert_eq!(go, Err(CallError::Lost(Loss::Unheard)));
    let request = Go { metres: 2 };
    let (done, ()) = tokio::join!(app.call(&request), async {
        let (id, body) = robot.recv().await.unwrap();
        assert!(body.contains(r#""metres":2"#), "{id}");
        robot.send_frame(answer_to(id), &result(7)).await;
    });
    assert_eq!(done, Ok(Done {}));
}

fn large() -> Echo {
    echo(&"x".repeat(4_000_000))
}

#[fc_test::test]
async fn calls_wait_for_a_connection() {
    let (listener, config) = listen().await;
    let config = config.reconnect(Backoff {
        attempts: None,
        ..AT_ONCE
    });
    let (app, robot) = tokio::join!(Connection::<Toy>::connect(config), async {
        accept(&listener).await
    });
    let app = app.unwrap();
    drop(robot);
    until(|| !app.state().is_connected()).await;
    let request = Go { metres: 1 };
    let (done, _robot) = tokio::join!(app.call(&request), async {
        let mut robot = accept(&listener).await;
        let (id, _) = robot.recv().await.unwrap();
        robot.send_frame(answer_to(id), &result(7)).await;
        robot
    });
    assert_eq!(done, Ok(Done {}));
}

/// An app that compares the count with an older one must not take the first connection for a second.
#[fc_test::test]
async fn connection_is_counted_once_established() {
    let (near, _far) = tokio::io::duplex(64);
    let app = Connection::<Toy>::over(near, ClientConfig::new());
    assert_eq!(app.state().connects(), 1);
}

#[fc_test::test]
async fn calls_without_a_connection_time_out_too() {
    let (listener, config) = listen().await;
    let forever = Backoff {
        first: Duration::from_secs(1000),
        longest: Duration::from_secs(1000),
        attempts: None,
    };
    let config = config
        .reconnect(forever)
        .call_timeout(Duration::from_millis(20));
    let (app, robot) = tokio::join!(Connection::<Toy>::connect(config), async {
        accept(&listener).await
    });
    let app = app.unwrap();
    drop(robot);
    until(|| !app.state().is_connected()).await;
    let error = app.call(&echo("x")).await.unwrap_err();
    assert_eq!(error, CallError::NotConnected(Loss::Unheard));
    app.close();
    let error = app.call(&echo("x")).await.unwrap_err();
    assert_eq!(error, CallError::Closed(Loss::Here));
}

#[fc_test::test]
async fn giving_up() {
    let (listener, config) = listen().await;
    let (app, robot) = tokio::join!(Connection::<Toy>::connect(config), async {
        accept(&listener).await
    });
    let app = app.unwrap();
    drop((listener, robot));
    let mut reports = app.reports();
    assert_eq!(reports.recv().await, None);
    let refused = Loss::Unreachable(std::io::ErrorKind::ConnectionRefused);
    assert_eq!(app.call(&echo("x")).await, Err(CallError::Closed(refused)));
}

#[fc_test::test]
async fn not_reconnecting() {
    let (listener, config) = listen().await;
    let (app, mut robot) =
        tokio::join!(Connection::<Toy>::connect(config.reconnect(None)), async {
            accept(&listener).await
        });
    let app = app.unwrap();
    let request = echo("x");
    let (lost, ()) = tokio::join!(app.call(&request), async {
        robot.recv().await.unwrap();
        drop(robot);
    });
    assert_eq!(lost, Err(CallError::Lost(Loss::Unheard)));
    assert_eq!(
        app.call(&echo("x")).await,
        Err(CallError::Closed(Loss::Unheard))
    );
}

#[fc_test::test]
async fn a_robot_that_makes_no_sense_is_left() {
    let (listener, config) = listen().await;
    let (app, mut robot) =
        tokio::join!(Connection::<Toy>::connect(config.reconnect(None)), async {
            accept(&listener).await
        });
    let app = app.unwrap();
    robot.send(b"HTTP/1.1 400 Bad Request\r\n").await;
    assert_eq!(app.reports().recv().await, None);
    assert_eq!(app.counters().bad_frames, 1);
    let why = Loss::Frame(FrameError::BadHead);
    assert_eq!(app.call(&echo("x")).await, Err(CallError::Closed(why)));
}

#[fc_test::test]
async fn the_last_handle_closes_the_connection() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let other = app.clone();
    drop(app);
    assert!(other.call(&echo("x")).await.is_ok());
    drop(other);
    until(|| robot.handle.connections().is_empty()).await;
}

#[fc_test::test]
async fn timeouts_without_end_are_no_trouble() {
    let limitless = loopback()
        .header_timeout(Duration::MAX)
        .stall_timeout(Duration::MAX)
        .idle_timeout(Some(Duration::MAX))
        .handler_timeout(Duration::MAX);
    let robot = Robot::start(limitless, service).await;
    let forever = Backoff {
        first: Duration::MAX,
        longest: Duration::MAX,
        attempts: None,
    };
    let config = robot
        .config
        .clone()
        .call_timeout(Duration::MAX)
        .reconnect(forever);
    let app = Connection::<Toy>::connect(config).await.unwrap();
    assert!(app.call(&echo("x")).await.is_ok());
    let mut raw = robot.raw();
    raw.send(b"<").await;
    robot.handle.shutdown(Duration::from_millis(1)).await;
    until(|| !app.state().is_connected()).await;
    app.close();
    assert_eq!(app.reports().recv().await, None);
}

#[fc_test::test]
async fn too_many_connections() {
    let limits = Limits {
        connections: 2,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let config = robot.config.clone().reconnect(None);
    let mut apps = Vec::new();
    for _ in 0..2 {
        let app = Connection::<Toy>::connect(config.clone()).await.unwrap();
        assert!(app.call(&echo("x")).await.is_ok());
        apps.push(app);
    }
    let third = Connection::<Toy>::connect(config.clone()).await.unwrap();
    assert_eq!(third.reports().recv().await, None);
    let error = third.call(&echo("x")).await.unwrap_err();
    assert_eq!(error, CallError::Closed(Loss::Unheard));
    assert_eq!(robot.handle.counters().connections_refused, 1);
    apps.pop();
    until(|| robot.handle.connections().len() != 2).await;
    let third = Connection::<Toy>::connect(config).await.unwrap();
    assert!(third.call(&echo("x")).await.is_ok());
}
