//! Handlers that run on without a waiting app: a motion does not stop when its app is gone.

use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{Done, Echo, Go, LIMITS, Moved, Toy, answer_to, command, frame, until};
use fc_runtime::{
    Audience, CallError, ClientConfig, Command, Connection, Context, Handling, Limits, RawAnswer,
    Refusal, Request, Service,
};
use socket2::SockRef;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::sync::Semaphore;
use tokio::task::yield_now;
use tokio::time::Instant;

const SECOND: Duration = Duration::from_secs(1);

/// The fate of handlers.
#[derive(Default)]
struct Seen {
    begun: AtomicU64,
    ended: AtomicU64,
    /// Dropped before their end.
    dropped: AtomicU64,
    /// Handlers that learned that no app waits.
    told: AtomicU64,
}

impl Seen {
    fn read(&self) -> [u64; 3] {
        [&self.begun, &self.ended, &self.dropped].map(|count| count.load(Ordering::SeqCst))
    }
}

/// One running handler.
struct AtWork(Arc<Seen>);

impl AtWork {
    fn begin(seen: &Arc<Seen>) -> Self {
        seen.begun.fetch_add(1, Ordering::SeqCst);
        Self(Arc::clone(seen))
    }

    fn end(self) {
        self.0.ended.fetch_add(1, Ordering::SeqCst);
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        self.0.dropped.fetch_add(1, Ordering::SeqCst);
    }
}

/// A robot whose handlers wait for permission.
#[derive(Clone)]
struct Slow {
    permits: Arc<Semaphore>,
    seen: Arc<Seen>,
}

impl Slow {
    fn new() -> Self {
        Self {
            permits: Arc::new(Semaphore::new(0)),
            seen: Arc::default(),
        }
    }

    async fn work(self, context: Context<Toy>) {
        let work = AtWork::begin(&self.seen);
        self.permits.acquire().await.unwrap().forget();
        if context.is_abandoned() {
            self.seen.told.fetch_add(1, Ordering::SeqCst);
        }
        work.end();
    }
}

/// A command that the spec does not have.
const UNKNOWN: u16 = 0x0999;

impl Service<Toy> for Slow {
    fn call(&self, request: Request<'_, Toy>) -> Handling {
        let slow = self.clone();
        match request.code() {
            Go::CODE => request.handle(|context, Go { .. }| async move {
                slow.work(context).await;
                Ok(Done {})
            }),
            Echo::CODE => request.handle(|context, Echo { .. }| async move {
                slow.work(context).await;
                Err(Refusal::new(500, "late"))
            }),
            _ => request.handle_raw(|context, _| async move {
                slow.work(context).await;
                Err::<RawAnswer, _>(Refusal::new(500, "late"))
            }),
        }
    }
}

const GO: &[u8] = br#"{"metres":1}"#;
const ECHO: &[u8] = br#"{"text":"x"}"#;

/// Closes a connection so that the other side can neither read nor write.
fn reset(app: Raw<TcpStream>) {
    let socket = SockRef::from(&app.stream);
    socket.set_linger(Some(Duration::ZERO)).unwrap();
    drop(app);
}

#[fc_test::test]
async fn motion_outlives_its_connection_and_read_ends() {
    for (code, body, outlives) in [
        (Go::CODE, GO, true),
        (UNKNOWN, b"{}".as_slice(), true),
        (Echo::CODE, ECHO, false),
    ] {
        let slow = Slow::new();
        let seen = Arc::clone(&slow.seen);
        let robot = Robot::start(loopback().handler_timeout(1000 * SECOND), slow.clone()).await;
        let mut app = Raw::new(TcpStream::connect(robot.command).await.unwrap());
        app.send(&frame(command(code, 1), body)).await;
        until(|| seen.begun.load(Ordering::SeqCst) == 1).await;
        let (id, _) = robot.handle.connections()[0];
        reset(app);
        until(|| robot.handle.connections().is_empty()).await;
        if outlives {
            assert_eq!(seen.read(), [1, 0, 0], "0x{code:04X}");
            // The handler ends independently of the connection. A report finds the connection gone.
            let pushed = robot.handle.push(Audience::One(id), &Moved { metres: 1 });
            assert_eq!(pushed.await.unwrap_err().name(), "no_connection");
            slow.permits.add_permits(1);
        }
        until(|| seen.read()[1..] != [0, 0]).await;
        // `AtWork` is dropped in either case.
        assert_eq!(seen.read(), [1, u64::from(outlives), 1], "0x{code:04X}");
        assert_eq!(seen.told.load(Ordering::SeqCst), u64::from(outlives));
        let counters = robot.handle.counters();
        assert_eq!(counters.handlers_abandoned, u64::from(outlives));
        assert_eq!((counters.calls_succeeded, counters.calls_refused), (0, 0));
    }
}

#[fc_test::test(start_paused = true)]
async fn motion_outlives_its_timeout_with_one_response() {
    for (code, body, outlives) in [(Go::CODE, GO, true), (Echo::CODE, ECHO, false)] {
        let slow = Slow::new();
        let seen = Arc::clone(&slow.seen);
        // A detached handler does not count as a call in flight.
        let limits = Limits {
            in_flight: 1,
            ..LIMITS
        };
        let config = loopback().handler_timeout(SECOND).limits(limits);
        let robot = Robot::start(config, slow.clone()).await;
        let mut app = robot.raw();
        let start = Instant::now();
        app.send(&frame(command(code, 1), body)).await;
        assert_eq!(app.result().await, (answer_to(command(code, 1)), 72));
        assert_eq!(start.elapsed().as_secs(), 1);
        assert_eq!(seen.read(), [1, 0, u64::from(!outlives)]);

        app.send(&frame(command(Go::CODE, 2), GO)).await;
        until(|| seen.begun.load(Ordering::SeqCst) == 2).await;
        slow.permits.add_permits(2);
        // Its own response, and none to the first call.
        assert_eq!(app.result().await, (answer_to(command(Go::CODE, 2)), 7));
        until(|| seen.ended.load(Ordering::SeqCst) == 1 + u64::from(outlives)).await;
        assert_eq!(seen.told.load(Ordering::SeqCst), u64::from(outlives));
        app.send(&frame(command(Go::CODE, 3), b"[]")).await;
        assert_eq!(app.result().await, (answer_to(command(Go::CODE, 3)), 73));
        let counters = robot.handle.counters();
        assert_eq!(counters.calls_timed_out, 1);
        assert_eq!(counters.handlers_abandoned, u64::from(outlives));
    }
}

/// A robot whose motions stop when no app waits, and report how.
async fn cancelling(seen: &Arc<Seen>) -> Robot {
    let seen = Arc::clone(seen);
    let serve = move |request: Request<'_, Toy>| {
        let work = AtWork::begin(&seen);
        request.handle(|context, Go { .. }| async move {
            context.abandoned().await;
            assert!(context.is_abandoned());
            // It takes some time to stop.
            tokio::time::sleep(SECOND).await;
            work.end();
            Ok(Done {})
        })
    };
    Robot::start(loopback().handler_timeout(10 * SECOND), serve).await
}

#[fc_test::test(start_paused = true)]
async fn a_handler_learns_of_its_timeout() {
    let seen = Arc::default();
    let robot = cancelling(&seen).await;
    let mut app = robot.raw();
    let start = Instant::now();
    app.send(&frame(command(Go::CODE, 1), GO)).await;
    assert_eq!(app.result().await.1, 72);
    assert_eq!(start.elapsed().as_secs(), 10);
    while seen.read()[1..] == [0, 0] {
        tokio::time::sleep(SECOND / 8).await;
    }
    assert_eq!(seen.read(), [1, 1, 1]);
    assert_eq!(start.elapsed().as_secs(), 11);
}

#[fc_test::test]
async fn a_handler_learns_that_its_connection_has_ended() {
    let seen = Arc::default();
    let robot = cancelling(&seen).await;
    let mut app = Raw::new(TcpStream::connect(robot.command).await.unwrap());
    app.send(&frame(command(Go::CODE, 1), GO)).await;
    until(|| seen.begun.load(Ordering::SeqCst) == 1).await;
    reset(app);
    until(|| seen.read()[1..] != [0, 0]).await;
    assert_eq!(seen.read(), [1, 1, 1]);
    assert_eq!(robot.handle.counters().calls_timed_out, 0);
}

/// A robot with handlers that run on without an app.
async fn with_abandoned(slow: &Slow, count: u32) -> (Robot, Connection<Toy>) {
    let config = loopback().handler_timeout(SECOND).abandoned_handlers(2);
    let robot = Robot::start(config, slow.clone()).await;
    let app = robot.pipe(ClientConfig::new());
    for _ in 0..count {
        let error = app.call(&Go { metres: 1 }).await.unwrap_err();
        assert!(matches!(error, CallError::Refused(refusal) if refusal.code == 72));
    }
    (robot, app)
}

#[fc_test::test(start_paused = true)]
async fn a_shutdown_waits_for_them_within_its_grace() {
    let slow = Slow::new();
    let (robot, _app) = with_abandoned(&slow, 1).await;
    let start = Instant::now();
    let (shutdown, permits) = (robot.handle.shutdown(10 * SECOND), &slow.permits);
    tokio::join!(shutdown, async {
        tokio::time::sleep(3 * SECOND).await;
        permits.add_permits(1);
    });
    assert_eq!(start.elapsed().as_secs(), 3);
    assert_eq!(slow.seen.read(), [1, 1, 1]);

    let slow = Slow::new();
    let (robot, _app) = with_abandoned(&slow, 1).await;
    let start = Instant::now();
    robot.handle.shutdown(10 * SECOND).await;
    assert_eq!(start.elapsed().as_secs(), 10);
    until(|| slow.seen.read() == [1, 0, 1]).await;
}

/// A handler that runs when the shutdown begins, and whose timeout comes before the end of the grace period.
#[fc_test::test(start_paused = true)]
async fn shutdown_waits_for_detached_handlers() {
    let slow = Slow::new();
    let config = loopback().handler_timeout(SECOND);
    let robot = Robot::start(config, slow.clone()).await;
    let mut app = robot.raw();
    app.send(&frame(command(Go::CODE, 1), GO)).await;
    until(|| slow.seen.begun.load(Ordering::SeqCst) == 1).await;
    let start = Instant::now();
    tokio::join!(robot.handle.shutdown(10 * SECOND), async {
        assert_eq!(app.result().await.1, 72);
        assert_eq!(app.recv().await, None);
        drop(app);
        tokio::time::sleep(3 * SECOND).await;
        slow.permits.add_permits(1);
    });
    assert_eq!(start.elapsed().as_secs(), 4);
    assert_eq!(slow.seen.read(), [1, 1, 1]);
}

#[fc_test::test(start_paused = true)]
async fn no_more_are_begun_than_may_run_on() {
    let slow = Slow::new();
    let (robot, app) = with_abandoned(&slow, 2).await;
    let mut raw = robot.raw();
    for (code, body) in [(Go::CODE, GO), (UNKNOWN, b"{}".as_slice())] {
        raw.send(&frame(command(code, 1), body)).await;
        assert_eq!(raw.result().await, (answer_to(command(code, 1)), 71));
    }
    assert_eq!(slow.seen.read(), [2, 0, 0], "neither has begun");
    assert_eq!(robot.handle.counters().abandoned_reached, 2);
    // Commands that cannot run on are served.
    raw.send(&frame(command(Echo::CODE, 2), ECHO)).await;
    assert_eq!(raw.result().await.1, 72);
    // And motions are again, once one of them has ended.
    slow.permits.add_permits(1);
    until(|| slow.seen.ended.load(Ordering::SeqCst) == 1).await;
    until(|| Arc::strong_count(&slow.seen) <= 4).await;
    slow.permits.add_permits(2);
    assert_eq!(app.call(&Go { metres: 1 }).await, Ok(Done {}));
}

#[fc_test::test(start_paused = true)]
async fn limit_of_zero_ends_motions_at_their_timeout() {
    let slow = Slow::new();
    let config = loopback().handler_timeout(SECOND).abandoned_handlers(0);
    let robot = Robot::start(config, slow.clone()).await;
    let app = robot.pipe(ClientConfig::new());
    for _ in 0..3 {
        let error = app.call(&Go { metres: 1 }).await.unwrap_err();
        assert!(matches!(error, CallError::Refused(refusal) if refusal.code == 72));
    }
    assert_eq!(slow.seen.read(), [3, 0, 3]);
    assert_eq!(robot.handle.counters().handlers_abandoned, 0);
}

#[fc_test::test(start_paused = true)]
async fn panic_of_a_detached_handler_is_counted() {
    let robot = Robot::start(
        loopback().handler_timeout(SECOND),
        |request: Request<'_, Toy>| match request.code() {
            Go::CODE => request.handle(|context, Go { .. }| async move {
                context.abandoned().await;
                yield_now().await;
                panic!("behind the back of the app")
            }),
            _ => service(request),
        },
    )
    .await;
    let mut app = robot.raw();
    app.send(&frame(command(Go::CODE, 1), GO)).await;
    assert_eq!(app.result().await.1, 72);
    until(|| robot.handle.counters().handlers_panicked == 1).await;
    app.send(&frame(command(Echo::CODE, 2), ECHO)).await;
    assert_eq!(app.result().await, (answer_to(command(Echo::CODE, 2)), 7));
}

/// A report for an app that leaves ends, even if a handler still has the connection.
#[fc_test::test]
async fn reports_end_with_the_connection() {
    let slow = Slow::new();
    let robot = Robot::start(loopback().handler_timeout(1000 * SECOND), slow.clone()).await;
    let mut app = Raw::new(TcpStream::connect(robot.command).await.unwrap());
    app.send(&frame(command(Go::CODE, 1), GO)).await;
    until(|| slow.seen.begun.load(Ordering::SeqCst) == 1).await;
    let pushing = {
        let handle = robot.handle.clone();
        tokio::spawn(async move { handle.push(Audience::All, &Moved { metres: 1 }).await })
    };
    until(|| robot.handle.counters().reports_sent == 1).await;
    reset(app);
    let ended = pushing.await.unwrap().unwrap();
    assert_eq!(ended[0].outcome, fc_runtime::AckOutcome::Closed);
    slow.permits.add_permits(1);
    until(|| slow.seen.read() == [1, 1, 1]).await;
}

#[fc_test::test]
async fn they_end_with_a_server_that_is_dropped() {
    let slow = Slow::new();
    let server = fc_runtime::Server::<Toy>::bind(loopback(), slow.clone());
    let server = server.await.unwrap();
    let address = server.command_addr();
    let run = tokio::spawn(server.run());
    let mut app = Raw::new(TcpStream::connect(address).await.unwrap());
    app.send(&frame(command(Go::CODE, 1), GO)).await;
    until(|| slow.seen.begun.load(Ordering::SeqCst) == 1).await;
    run.abort();
    until(|| slow.seen.read() == [1, 0, 1]).await;
}
