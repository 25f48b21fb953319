//! A panic of a handler is answered, counted and logged, and affects no other request.

use crate::common::log::{Log, alone};
use crate::common::net::{Robot, loopback, service};
use crate::common::{Done, Echo, EchoReply, Go, Toy, answer_to, command, frame, until};
use fc_derive::{Command, Message};
use fc_runtime::json::{ObjectWriter, Reader};
use fc_runtime::{
    CallError, ClientConfig, Command, Connection, Handling, Message, RawAnswer, Refusal, Request,
};
use std::future::{Ready, pending, ready};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;
use tokio::sync::Semaphore;
use tokio::task::{JoinHandle, yield_now};
use tracing::Level;

const SECRET: &str = "hunter2";

/// Panics when it is dropped.
struct Bomb;

impl Drop for Bomb {
    fn drop(&mut self) {
        panic!("{SECRET}");
    }
}

/// Where a handler of [`Echo`] panics.
const PLACES: [&str; 6] = [
    "before its future",
    "at once",
    "after waiting",
    "raw",
    "dropped when done",
    "in the service",
];

fn at_once(text: &str) -> Ready<Result<EchoReply, Refusal>> {
    assert!(text.is_empty(), "{SECRET} {text}");
    ready(Ok(EchoReply { text: "x".into() }))
}

/// A robot whose motions wait for permission, and whose other handlers panic in a certain place.
fn panicking(
    place: &'static str,
    permits: &Arc<Semaphore>,
    begun: &Arc<AtomicU32>,
) -> impl Fn(Request<'_, Toy>) -> Handling + use<> {
    let (permits, begun) = (Arc::clone(permits), Arc::clone(begun));
    move |request: Request<'_, Toy>| {
        if request.code() == Go::CODE {
            let permits = Arc::clone(&permits);
            return request.handle(|_, _: Go| async move {
                let permit = permits.acquire().await;
                permit.map_err(|_| Refusal::new(500, "over"))?.forget();
                Ok(Done {})
            });
        }
        begun.fetch_add(1, Ordering::Relaxed);
        match place {
            "before its future" => request.handle(|_, Echo { text }| at_once(&text)),
            "at once" => request.handle(|_, Echo { text }| async move { at_once(&text).await }),
            "after waiting" => request.handle(|_, Echo { text }| async move {
                yield_now().await;
                at_once(&text).await
            }),
            "raw" => request.handle_raw(|_, raw| async move {
                assert!(raw.text.as_str().is_empty(), "{SECRET}");
                Err::<RawAnswer, _>(Refusal::unknown::<Toy>())
            }),
            "dropped when done" => request.handle(|_, Echo { text }| {
                let bomb = Bomb;
                async move {
                    yield_now().await;
                    let _bomb = bomb;
                    Ok(EchoReply { text })
                }
            }),
            _ => panic!("{SECRET}"),
        }
    }
}

fn drive(app: &Connection<Toy>) -> JoinHandle<Result<Done, CallError>> {
    let app = app.clone();
    tokio::spawn(async move { app.call(&Go { metres: 1 }).await })
}

fn echo() -> Echo {
    Echo {
        text: SECRET.into(),
    }
}

#[fc_test::test]
async fn panic_is_answered_and_other_calls_continue() {
    let _alone = alone();
    for place in PLACES {
        let permits = Arc::new(Semaphore::new(0));
        let begun = Arc::new(AtomicU32::new(0));
        let robot = Robot::start(loopback(), panicking(place, &permits, &begun)).await;
        let app = robot.connect().await;
        let neighbour = drive(&app);
        until(|| app.in_flight() == 1).await;

        let error = app.call(&echo()).await.expect_err(place);
        let CallError::Refused(refusal) = &error else {
            panic!("{place}: {error:?}");
        };
        assert_eq!(refusal.code, 71, "{place}");
        assert!(!refusal.text.contains(SECRET), "{place}: {refusal}");
        // An answered request is not sent again, even if it only reads.
        assert_eq!(begun.load(Ordering::Relaxed), 1, "{place}");

        permits.add_permits(1);
        assert_eq!(neighbour.await.unwrap(), Ok(Done {}), "{place}");
        let counters = robot.handle.counters();
        assert_eq!(counters.handlers_panicked, 1, "{place}");
        assert_eq!(counters.connections, 1, "{place}");
    }
}

/// Requests that lie behind one whose handler panics, in the same segment.
#[fc_test::test]
async fn requests_behind_a_panic_are_handled() {
    let _alone = alone();
    let robot = Robot::start(loopback(), |request: Request<'_, Toy>| {
        assert!(request.code() != 0x0999, "{SECRET}");
        service(request)
    })
    .await;
    let mut app = robot.raw();
    let mut bytes = Vec::new();
    for id in 0..10 {
        bytes.extend(frame(command(0x0999, 2 * id), b"{}"));
        bytes.extend(frame(command(Echo::CODE, 2 * id + 1), br#"{"text":"x"}"#));
    }
    app.send(&bytes).await;
    for id in 0..10 {
        let answer = answer_to(command(0x0999, 2 * id));
        assert_eq!(app.result().await, (answer, 71));
        let answer = answer_to(command(Echo::CODE, 2 * id + 1));
        assert_eq!(app.result().await, (answer, 7));
    }
    assert_eq!(robot.handle.counters().handlers_panicked, 10);
}

/// A response that cannot even be written.
#[derive(Clone, Debug, PartialEq)]
struct Unwritable;

impl Message for Unwritable {
    type Slots = ();

    fn slots() {}

    fn read_fields((): &mut (), _: &mut Reader<'_>) {}

    fn finish((): ()) -> Option<Self> {
        Some(Self)
    }

    fn write_fields(&self, object: &mut ObjectWriter<'_>) {
        object.field(",\"begun\":", &1_i32);
        panic!("{SECRET}");
    }
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0103, name = "show", effect = "read", response = Unwritable)]
struct Show {
    later: bool,
}

#[fc_test::test]
async fn a_panic_while_the_response_is_written() {
    let _alone = alone();
    let robot = Robot::start(loopback(), |request: Request<'_, Toy>| {
        match request.code() {
            Show::CODE => request.handle(|_, Show { later }| async move {
                if later {
                    yield_now().await;
                }
                Ok(Unwritable)
            }),
            _ => service(request),
        }
    })
    .await;
    let app = robot.connect().await;
    for later in [false, true] {
        let error = app.call(&Show { later }).await.unwrap_err();
        assert!(matches!(error, CallError::Refused(refusal) if refusal.code == 71));
        assert_eq!(app.call(&echo()).await.unwrap().text, SECRET);
    }
    let counters = robot.handle.counters();
    assert_eq!((counters.connections, counters.handlers_panicked), (1, 2));
    assert_eq!(counters.calls_succeeded, 2);
}

/// A handler that is dropped, and whose values panic then.
#[fc_test::test(start_paused = true)]
async fn a_panic_while_a_handler_is_dropped() {
    let _alone = alone();
    let begun = Arc::new(AtomicU32::new(0));
    let counted = Arc::clone(&begun);
    let robot = Robot::start(loopback(), move |request: Request<'_, Toy>| {
        match request.code() {
            Echo::CODE => request.handle(|_, _: Echo| {
                let bomb = Bomb;
                counted.fetch_add(1, Ordering::Relaxed);
                async move {
                    let _bomb = bomb;
                    pending().await
                }
            }),
            _ => service(request),
        }
    })
    .await;
    let app = robot.pipe(ClientConfig::new());
    // At its timeout.
    let error = app.call(&echo()).await.unwrap_err();
    assert!(matches!(error, CallError::Refused(refusal) if refusal.code == 72));
    assert_eq!(app.call(&Go { metres: 1 }).await, Ok(Done {}));
    assert_eq!(robot.handle.counters().handlers_panicked, 1);
    // With its connection: the panic of one keeps the other from nothing.
    let calls: Vec<_> = [1, 2]
        .map(|_| {
            let app = app.clone();
            tokio::spawn(async move { app.call(&echo()).await })
        })
        .into();
    until(|| begun.load(Ordering::Relaxed) == 3).await;
    robot.handle.shutdown(Duration::ZERO).await;
    for call in calls {
        assert!(matches!(call.await.unwrap(), Err(CallError::Lost(_))));
    }
    until(|| robot.handle.counters().handlers_panicked == 3).await;
    until(|| robot.handle.connections().is_empty()).await;
}

fn is_error(line: &str) -> bool {
    line.starts_with("ERROR")
}

#[fc_test::test]
async fn panic_is_logged_without_its_message() {
    let log = Log::listen(Level::TRACE);
    for place in PLACES {
        let permits = Arc::new(Semaphore::new(0));
        let robot = Robot::start(loopback(), panicking(place, &permits, &Arc::default())).await;
        let mut app = robot.raw();
        let id = command(Echo::CODE, 4321);
        app.send_frame(id, &format!(r#"{{"text":"{SECRET}"}}"#))
            .await;
        app.result().await;
        let lines = log.take();
        let errors: Vec<_> = lines.iter().filter(|line| is_error(line)).collect();
        let [error] = errors[..] else {
            panic!("{place}: {lines:?}");
        };
        for part in [
            "panicked",
            "protocol=\"toy\"",
            "name=\"echo\"",
            "code=257",
            "msg_id=4321",
        ] {
            assert!(error.contains(part), "{place}: {error}");
        }
        assert!(!format!("{lines:?}").contains(SECRET), "{place}: {lines:?}");
    }
}

/// As with all that a peer can bring about, only the 1st, 2nd, 4th and so on are above debug.
#[fc_test::test]
async fn a_flood_of_panics_does_not_flood_the_log() {
    let log = Log::listen(Level::TRACE);
    let robot = Robot::start(loopback(), |_: Request<'_, Toy>| panic!("always")).await;
    let mut app = robot.raw();
    for id in 0..9 {
        app.send_frame(command(Echo::CODE, id), "{}").await;
        app.result().await;
    }
    let lines = log.take();
    let errors = lines.iter().filter(|line| is_error(line));
    assert_eq!(errors.count(), 4, "{lines:#?}");
}
