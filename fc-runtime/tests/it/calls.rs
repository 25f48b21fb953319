//! Calls between app and robot.

use crate::common::net::{Robot, app_of_raw, loopback, service};
use crate::common::{self, Done, Echo, EchoReply, Go, LIMITS, Toy, answer_to, result, until};
use fc_derive::{Command, Message};
use fc_runtime::{
    CallError, CallOptions, ClientConfig, Command as _, Gzip, Json, Limits, RawAnswer, Refusal,
    Request,
};
use std::future::pending;
use std::time::Duration;
use tokio::sync::{Notify, Semaphore};
use tokio::time::Instant;

fn echo(text: &str) -> Echo {
    Echo {
        text: text.to_owned(),
    }
}

fn refused(result: Result<impl std::fmt::Debug, CallError>) -> i64 {
    match result {
        Err(CallError::Refused(refusal)) => refusal.code,
        other => panic!("not refused: {other:?}"),
    }
}

#[fc_test::test]
async fn a_call_is_answered() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let reply = app.call(&echo("hello")).await;
    assert_eq!(
        reply,
        Ok(EchoReply {
            text: "hello".into()
        })
    );
    assert_eq!(app.call(&Go { metres: 5 }).await, Ok(Done {}));
    let counters = robot.handle.counters();
    assert_eq!((counters.connections, counters.calls_succeeded), (1, 2));
    assert_eq!(app.counters().answers, 2);
    assert_eq!(app.counters().bytes_in, counters.bytes_out);
    assert_eq!(app.counters().bytes_out, counters.bytes_in);
}

#[fc_test::test]
async fn calls_can_move_between_threads() {
    fn is_send<T: Send>(value: T) -> T {
        value
    }
    let (app, _robot) = app_of_raw(ClientConfig::new());
    let request = echo("x");
    drop(is_send(app.call(&request)));
    drop(is_send(app.call_raw(1, b"{}")));
    drop(is_send(app.data().recv()));
}

#[fc_test::test]
async fn a_refusal_carries_code_and_text() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let Err(CallError::Refused(refusal)) = app.call(&Go { metres: 51 }).await else {
        panic!("not refused");
    };
    assert_eq!((refusal.code, refusal.text.as_str()), (500, "too far"));
    assert_eq!(robot.handle.counters().calls_refused, 1);
}

#[fc_test::test]
async fn unservable_request_is_refused_with_its_result() {
    let robot = Robot::start(loopback().max_age(Some(Duration::from_secs(60))), service).await;
    let app = robot.connect().await;
    for (code, body, expected) in [
        (0x0999, "{}", 71),
        (Echo::CODE, "{}", 73),
        (Echo::CODE, r#"{"text":3}"#, 73),
        (Go::CODE, r#"{"metres":101}"#, 73),
        (Echo::CODE, r#"{"text":"x","at":5}"#, 74),
        (Echo::CODE, r#"{"text":"x","at":-9223372036854775808}"#, 74),
        (Echo::CODE, r#"{"text":"x","at":9223372036854775807}"#, 7),
    ] {
        let response = app.call_raw(code, body.as_bytes()).await.unwrap();
        assert_eq!(response.envelope.result, expected, "{body}");
    }
    let counters = robot.handle.counters();
    assert_eq!(
        (
            counters.calls_protocol,
            counters.calls_invalid,
            counters.calls_expired
        ),
        (1, 3, 2)
    );
}

#[fc_test::test]
async fn an_invalid_request_is_not_sent() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let Err(CallError::Invalid(error)) = app.call(&Go { metres: 101 }).await else {
        panic!("sent");
    };
    assert_eq!(error.name(), "out_of_range");
    let error = app.call_raw(1, b"[]").await.unwrap_err();
    assert_eq!(error.name(), "invalid_request");
    assert_eq!(app.counters().bytes_out, 0);
}

#[fc_test::test]
async fn raw_calls_and_raw_handlers() {
    let service = |request: Request<'_, Toy>| {
        request.handle_raw(|context, request| async move {
            assert!(context.time_ms.is_some() && context.peer.ip().is_loopback());
            let text = request.text.as_str();
            match request.code {
                1 => Ok(RawAnswer(
                    Json::new(&format!(r#"{{"got":{text}}}"#)).unwrap(),
                )),
                2 => Ok(RawAnswer(Json::new("[]").unwrap())),
                _ => Err(Refusal::new(5, "no")),
            }
        })
    };
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let response = app
        .call_raw(1, br#"{"at":123,"x":{"y":[1,2]}}"#)
        .await
        .unwrap();
    let text = String::from_utf8(response.text).unwrap();
    assert!(
        text.contains(r#""got":{"at":123,"x":{"y":[1,2]}}"#),
        "{text}"
    );
    assert_eq!(response.envelope.result, 7);
    assert_eq!(app.call_raw(2, b"").await.unwrap().envelope.result, 71);
    assert_eq!(app.call_raw(3, b"{}").await.unwrap().envelope.result, 5);
}

/// An answer from elsewhere may contain envelope keys; none is written twice.
#[fc_test::test]
async fn a_raw_answer_with_keys_of_the_envelope() {
    const ANSWERS: &[(&str, i32, &str)] = &[
        (
            r#"{"level":1}"#,
            7,
            r#","result":7,"why":"fine","level":1}"#,
        ),
        (
            r#"{"result":5,"level":1}"#,
            5,
            r#","why":"fine","result":5,"level":1}"#,
        ),
        (
            r#"{"at":9,"result":5,"why":"no"}"#,
            5,
            r#"{"at":9,"result":5,"why":"no"}"#,
        ),
        // Such an envelope could not be read.
        (r#"{"result":"5"}"#, 71, r#","result":71,"why":"protocol"}"#),
    ];
    let service = |request: Request<'_, Toy>| {
        request.handle_raw(|_, request| async move {
            let (brought, ..) = ANSWERS[usize::from(request.code)];
            Ok(RawAnswer(Json::new(brought).unwrap()))
        })
    };
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    for (code, (brought, result, text)) in (0..).zip(ANSWERS) {
        let response = app.call_raw(code, b"{}").await.unwrap();
        let answered = String::from_utf8(response.text).unwrap();
        assert!(answered.ends_with(text), "{brought}: {answered}");
        assert_eq!(response.envelope.result, *result, "{brought}");
    }
    let counters = robot.handle.counters();
    assert_eq!(
        (
            counters.calls_succeeded,
            counters.calls_refused,
            counters.calls_protocol
        ),
        (1, 2, 1)
    );
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0104, name = "measure", effect = "read", response = Level)]
struct Measure {
    level: i32,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Level {
    #[fc(min = 0, max = 100)]
    level: i32,
}

/// The spec binds both sides: a response that violates it is not sent, but the app gets an error.
#[fc_test::test]
async fn an_invalid_response_is_not_sent() {
    let service = |request: Request<'_, Toy>| {
        request.handle(|_, measure: Measure| async move {
            Ok(Level {
                level: measure.level,
            })
        })
    };
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    assert_eq!(app.call(&Measure { level: 100 }).await.unwrap().level, 100);
    let Err(CallError::Refused(refusal)) = app.call(&Measure { level: 101 }).await else {
        panic!("sent");
    };
    assert_eq!(refusal.code, 71);
    let counters = robot.handle.counters();
    assert_eq!((counters.calls_succeeded, counters.calls_protocol), (1, 1));
}

#[fc_test::test]
async fn large_bodies_and_compression() {
    let gzip = Gzip {
        from_bytes: 100,
        level: 1,
    };
    for (app_packs, robot_packs) in [
        (None, None),
        (Some(gzip), None),
        (None, Some(gzip)),
        (Some(gzip), Some(gzip)),
    ] {
        let robot = Robot::start(loopback().gzip(robot_packs), service).await;
        let config = robot.config.clone().gzip(app_packs);
        let app = fc_runtime::Connection::<Toy>::connect(config)
            .await
            .unwrap();
        for length in [0, 1, 99, 100, 5000, 300_000, 3_000_000, 10] {
            let request = echo(&"abc".repeat(length / 3));
            assert_eq!(app.call(&request).await.unwrap().text, request.text);
        }
        // Of more than three million.
        let is_packed = |bytes: u64| bytes < 100_000;
        let (app, robot) = (app.counters(), robot.handle.counters());
        assert_eq!(is_packed(app.bytes_out), app_packs.is_some());
        assert_eq!(is_packed(robot.bytes_out), robot_packs.is_some());
    }
}

#[fc_test::test]
async fn a_request_beyond_the_frame_limit_is_not_sent() {
    let robot = Robot::start(loopback(), service).await;
    let limits = Limits {
        frame_bytes: 1000,
        ..LIMITS
    };
    let app = fc_runtime::Connection::<Toy>::connect(robot.config.clone().limits(limits)).await;
    let app = app.unwrap();
    let error = app.call(&echo(&"x".repeat(1000))).await.unwrap_err();
    assert_eq!(error.name(), "frame");
    let request = echo(&"x".repeat(1000));
    let mut kept = Box::pin(app.call(&request));
    assert!(kept.as_mut().await.is_err());
    assert_eq!(
        app.in_flight(),
        0,
        "given back by the error, not only by the drop"
    );
    assert!(app.call(&echo("fits")).await.is_ok());
}

#[fc_test::test(flavor = "multi_thread", worker_threads = 2)]
async fn many_calls_at_once_get_their_own_answers() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let callers: Vec<_> = (0..60)
        .map(|caller| {
            let app = app.clone();
            tokio::spawn(async move {
                for call in 0..200 {
                    let request = echo(&format!("{caller}/{call}"));
                    assert_eq!(app.call(&request).await.unwrap().text, request.text);
                }
            })
        })
        .collect();
    for caller in callers {
        caller.await.unwrap();
    }
    assert_eq!(robot.handle.counters().calls_succeeded, 60 * 200);
}

/// Answers [`Echo`] once a permit is there; the first word is how many it takes.
fn gated(gate: &'static Semaphore) -> impl Fn(Request<'_, Toy>) -> fc_runtime::Handling {
    move |request| match request.code() {
        Echo::CODE => request.handle(move |_, Echo { text }| async move {
            gate.acquire().await.unwrap().forget();
            Ok(EchoReply { text })
        }),
        _ => service(request),
    }
}

fn leak<T>(value: T) -> &'static T {
    Box::leak(Box::new(value))
}

#[fc_test::test]
async fn waiting_handler_delays_no_other_call() {
    let gate = leak(Semaphore::new(0));
    let robot = Robot::start(loopback(), gated(gate)).await;
    let app = robot.connect().await;
    let waiting = tokio::spawn({
        let app = app.clone();
        async move { app.call(&echo("slow")).await }
    });
    until(|| app.in_flight() != 0).await;
    assert_eq!(app.call(&Go { metres: 1 }).await, Ok(Done {}));
    assert_eq!(app.in_flight(), 1);
    gate.add_permits(1);
    assert_eq!(waiting.await.unwrap().unwrap().text, "slow");
}

#[fc_test::test]
async fn the_limit_of_calls_in_flight_is_told() {
    let gate = leak(Semaphore::new(0));
    let robot = Robot::start(loopback(), gated(gate)).await;
    let limits = Limits {
        in_flight: 2,
        ..LIMITS
    };
    let config = robot.config.clone().limits(limits);
    let app = fc_runtime::Connection::<Toy>::connect(config)
        .await
        .unwrap();
    let (one, two, three) = (echo("1"), echo("2"), echo("3"));
    let (one, two, three) = tokio::join!(app.call(&one), app.call(&two), async {
        let refused = app.call(&three).await;
        gate.add_permits(2);
        refused
    });
    assert!(one.is_ok() && two.is_ok());
    assert_eq!(three.unwrap_err().to_string(), busy(2));
    gate.add_permits(1);
    assert!(app.call(&echo("4")).await.is_ok());
}

fn busy(limit: usize) -> String {
    CallError::Busy(fc_runtime::Busy { limit }).to_string()
}

#[fc_test::test]
async fn more_requests_than_handlers_wait_their_turn() {
    let gate = leak(Semaphore::new(0));
    let limits = Limits {
        in_flight: 3,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), gated(gate)).await;
    let app = robot.connect().await;
    let calls = (0..20).map(|n| {
        let app = app.clone();
        tokio::spawn(async move { app.call(&echo(&n.to_string())).await })
    });
    let calls: Vec<_> = calls.collect();
    until(|| robot.handle.counters().in_flight_reached != 0).await;
    gate.add_permits(20);
    for (n, call) in calls.into_iter().enumerate() {
        assert_eq!(call.await.unwrap().unwrap().text, n.to_string());
    }
}

#[fc_test::test(start_paused = true)]
async fn a_handler_that_takes_too_long_is_answered_for() {
    let robot = Robot::start(loopback(), |request: Request<'_, Toy>| {
        match request.code() {
            Echo::CODE => request.handle(|_, _: Echo| pending()),
            _ => service(request),
        }
    })
    .await;
    let app = robot.pipe(ClientConfig::new());
    let start = Instant::now();
    assert_eq!(refused(app.call(&echo("x")).await), 72);
    assert_eq!(start.elapsed().as_secs(), 2);
    assert_eq!(robot.handle.counters().calls_timed_out, 1);
    assert!(app.call(&Go { metres: 1 }).await.is_ok());
}

#[fc_test::test(start_paused = true)]
async fn a_call_without_an_answer_times_out() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let start = Instant::now();
    let options = CallOptions {
        timeout: Some(Duration::from_millis(700)),
        repeat: None,
    };
    let (default, request) = (echo("default"), echo("own"));
    let (default, own) = tokio::join!(app.call(&default), app.call(&request).with_options(options));
    assert_eq!(
        (default, own),
        (Err(CallError::Timeout), Err(CallError::Timeout))
    );
    assert_eq!(start.elapsed().as_millis(), 3000);
    assert_eq!((app.in_flight(), app.counters().timeouts), (0, 2));

    // The responses are late and have no effect.
    for _ in 0..2 {
        let (id, _) = robot.recv().await.unwrap();
        robot.send_frame(answer_to(id), &result(7)).await;
    }
    let request = echo("next");
    let (next, ()) = tokio::join!(app.call(&request), async {
        let (id, _) = robot.recv().await.unwrap();
        robot
            .send_frame(answer_to(id), r#"{"result":7,"text":"next"}"#)
            .await;
    });
    assert_eq!(next.unwrap().text, "next");
    assert_eq!(app.counters().late_answers, 2);
}

#[fc_test::test]
async fn answers_that_cannot_be_read_end_their_call() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    type Make = fn(fc_runtime::FrameId) -> Vec<u8>;
    let answers: [(Make, &str); 4] = [
        (|id| common::frame(id, b"{"), "invalid_response"),
        (
            |id| common::frame(id, br#"{"result":7}"#),
            "invalid_response",
        ),
        (|id| common::frame(id, br#"{"result":8}"#), "refused"),
        (
            |id| {
                let mut bytes = common::frame(id, br#"{"result":7}"#);
                *bytes.last_mut().unwrap() = b' ';
                bytes
            },
            "frame",
        ),
    ];
    for (answer, name) in answers {
        let request = echo("x");
        let (response, ()) = tokio::join!(app.call(&request), async {
            let (id, _) = robot.recv().await.unwrap();
            robot.send(&answer(answer_to(id))).await;
        });
        assert_eq!(response.unwrap_err().name(), name);
    }
}

#[fc_test::test]
async fn handlers_end_with_their_connection() {
    let dropped = leak(Notify::new());
    struct Guard(&'static Notify);
    impl Drop for Guard {
        fn drop(&mut self) {
            self.0.notify_one();
        }
    }
    let robot = Robot::start(loopback(), move |request: Request<'_, Toy>| {
        request.handle(move |_, _: Echo| async move {
            let _guard = Guard(dropped);
            pending().await
        })
    })
    .await;
    let app = robot.connect().await;
    let call = tokio::spawn({
        let app = app.clone();
        async move { app.call(&echo("x")).await }
    });
    until(|| app.in_flight() != 0).await;
    app.close();
    assert!(matches!(call.await.unwrap(), Err(CallError::Lost(_))));
    dropped.notified().await;
    assert!(matches!(
        app.call(&echo("x")).await,
        Err(CallError::Closed(_))
    ));
}
