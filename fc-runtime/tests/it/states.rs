//! The state of an app's connection: as a value, as a stream of changes, and before the first connection.

use crate::common::log::{Log, alone};
use crate::common::net::{Raw, app_of_raw};
use crate::common::{Echo, EchoReply, Go, Moved, Toy, answer_to, report, until};
use fc_runtime::{
    Backoff, CallError, CallOptions, ClientConfig, Connection, ConnectionState, Loss, Report as _,
    Transport,
};
use futures_util::StreamExt;
use std::io::{self, ErrorKind};
use std::time::Duration;
use tokio::io::{DuplexStream, duplex};
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep};
use tracing::Level;

const REFUSED: Loss = Loss::Unreachable(ErrorKind::ConnectionRefused);

/// Attempts to connect, as a test wants them: `+` connects, `x` is refused at once, anything else takes
/// for ever; beyond the end all are refused. The robot's ends come out of the receiver.
fn attempts(
    script: &'static str,
) -> (
    impl FnMut() -> futures_util::future::BoxFuture<'static, io::Result<DuplexStream>> + Send + 'static,
    mpsc::Receiver<DuplexStream>,
) {
    let mut script = script.chars();
    let (pipes, dialled) = mpsc::channel(8);
    let dial = move || {
        let next = script.next();
        let pipes = pipes.clone();
        Box::pin(async move {
            match next {
                Some('+') => {
                    let (app, robot) = duplex(10_000);
                    pipes.send(robot).await.unwrap();
                    Ok(app)
                }
                Some('x') | None => Err(ErrorKind::ConnectionRefused.into()),
                Some(_) => std::future::pending().await,
            }
        }) as futures_util::future::BoxFuture<'static, _>
    };
    (dial, dialled)
}

fn lazily(script: &'static str) -> (Connection<Toy>, mpsc::Receiver<DuplexStream>) {
    let (dial, dialled) = attempts(script);
    let app = Connection::connect_lazy_by(dial, ClientConfig::new());
    (app, dialled)
}

async fn answer<S: Transport>(robot: &mut Raw<S>) {
    let (id, _) = robot.recv().await.unwrap();
    let text = r#"{"result":7,"text":"x"}"#;
    robot.send_frame(answer_to(id), text).await;
}

fn echo() -> Echo {
    Echo { text: "x".into() }
}

#[fc_test::test(start_paused = true)]
async fn each_state_is_told_once_and_the_last_is_the_end() {
    let _alone = alone();
    let (dial, mut dialled) = attempts("+xx+");
    let config = ClientConfig::new();
    let app = Connection::<Toy>::connect_by(dial, config).await.unwrap();
    let mut states = app.states();
    let connected = |connects| Some(ConnectionState::Connected { connects });
    let connecting = |why| Some(ConnectionState::Connecting { connects: 1, why });
    assert_eq!(states.recv().await, connected(1));
    assert_eq!(Some(app.state()), connected(1));
    drop(dialled.recv().await.unwrap());
    assert_eq!(states.recv().await, connecting(Loss::Unheard));
    // The second attempt fails as the first has, and is no news.
    assert_eq!(states.recv().await, connecting(REFUSED));
    assert_eq!(states.recv().await, connected(2));
    app.close();
    let (connects, why) = (2, Loss::Here);
    let closed = ConnectionState::Closed { connects, why };
    assert_eq!(states.recv().await, Some(closed));
    assert_eq!(states.recv().await, None);
    assert_eq!(states.recv().await, None);
    // The second robot exists, and then no more attempts are made.
    assert!(dialled.recv().await.is_some());
    assert!(dialled.recv().await.is_none());
    assert_eq!(app.state(), closed);
    // One who comes late hears of the end alone.
    let mut late = app.states();
    assert_eq!(late.recv().await, Some(closed));
    assert_eq!(late.recv().await, None);
    // A `Stream` returns the same.
    assert_eq!(app.states().collect::<Vec<_>>().await, [closed]);
}

/// A robot that accepts connections and closes them is tried less and less often; one that has been
/// heard, at once.
#[fc_test::test(start_paused = true)]
async fn waits_grow_while_a_robot_only_accepts() {
    let _alone = alone();
    let (dial, mut dialled) = attempts("++++++++");
    let backoff = Backoff {
        first: Duration::from_secs(1),
        longest: Duration::from_secs(5),
        attempts: None,
    };
    let config = ClientConfig::new().reconnect(backoff);
    let _app = Connection::<Toy>::connect_by(dial, config).await.unwrap();
    let mut robot = Raw::new(dialled.recv().await.unwrap());
    for (is_heard, seconds) in [
        (false, 1),
        (false, 2),
        (false, 4),
        (false, 5),
        (false, 5),
        (true, 1),
        (false, 2),
    ] {
        if is_heard {
            let id = report(Moved::CODE, 1);
            robot.send_frame(id, r#"{"metres":1}"#).await;
        }
        drop(robot);
        let before = Instant::now();
        robot = Raw::new(dialled.recv().await.unwrap());
        // Less, by chance, by up to a quarter.
        let (waited, most) = (before.elapsed(), Duration::from_secs(seconds));
        // A timer rings on the millisecond after.
        assert!(waited >= most.mul_f64(0.75), "{waited:?} of {most:?}");
        assert!(
            waited <= most + Duration::from_millis(2),
            "{waited:?} of {most:?}"
        );
    }
}

/// An app that was busy while the connection was lost and made again has to notice it.
#[fc_test::test(start_paused = true)]
async fn reconnection_between_looks_is_noticed() {
    let _alone = alone();
    let (dial, mut dialled) = attempts("+++");
    let config = ClientConfig::new();
    let app = Connection::<Toy>::connect_by(dial, config).await.unwrap();
    let mut states = app.states();
    let connected = |connects| Some(ConnectionState::Connected { connects });
    assert_eq!(states.recv().await, connected(1));
    let robots = [dialled.recv().await.unwrap()];
    drop(robots);
    drop(dialled.recv().await.unwrap());
    let _robot = dialled.recv().await.unwrap();
    until(|| app.state() == connected(3).unwrap()).await;
    assert_eq!(states.recv().await, connected(3));
}

#[fc_test::test(start_paused = true)]
async fn watching_does_not_keep_a_connection_open() {
    let _alone = alone();
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut states = app.states();
    assert!(states.recv().await.unwrap().is_connected());
    drop(app);
    assert_eq!(states.recv().await.unwrap().why(), Some(Loss::Here));
    assert_eq!(robot.recv().await, None);
}

#[fc_test::test(start_paused = true)]
async fn the_end_is_waited_for() {
    let _alone = alone();
    let refused = Backoff {
        attempts: Some(2),
        ..Backoff::default()
    };
    let (dial, mut dialled) = attempts("+");
    let config = ClientConfig::new().reconnect(refused);
    let app = Connection::<Toy>::connect_by(dial, config).await.unwrap();
    let (why, ()) = tokio::join!(app.closed(), async {
        drop(dialled.recv().await.unwrap());
    });
    assert_eq!(why, REFUSED);
    assert_eq!(app.closed().await, REFUSED);

    let (app, robot) = app_of_raw(ClientConfig::new());
    let (why, ()) = tokio::join!(app.closed(), async { app.close() });
    assert_eq!(why, Loss::Here);
    drop(robot);

    // Without anybody who could make it again.
    let (app, robot) = app_of_raw(ClientConfig::new());
    drop(robot);
    assert_eq!(app.closed().await, Loss::Unheard);
}

/// A connection whose runtime has gone is over, whoever still holds it.
#[fc_test::test]
fn without_its_runtime_a_connection_is_closed() {
    let runtime = || {
        let mut builder = tokio::runtime::Builder::new_current_thread();
        builder.enable_time().build().unwrap()
    };
    let lives = runtime();
    let (app, waits) = lives.block_on(async {
        let (app, _robot) = app_of_raw(ClientConfig::new());
        (app, lazily("?").0)
    });
    drop(lives);
    assert_eq!(runtime().block_on(app.closed()), Loss::Ended);
    assert_eq!(runtime().block_on(waits.closed()), Loss::Ended);
}

#[fc_test::test(start_paused = true)]
async fn a_call_waits_for_the_first_connection() {
    let _alone = alone();
    let (app, mut dialled) = lazily("xx+");
    let first = ConnectionState::Connecting {
        connects: 0,
        why: Loss::NotYet,
    };
    assert_eq!(app.state(), first);
    let request = echo();
    let (answered, ()) = tokio::join!(app.call(&request), async {
        answer(&mut Raw::new(dialled.recv().await.unwrap())).await;
    });
    assert_eq!(answered, Ok(EchoReply { text: "x".into() }));
    assert_eq!(app.state().connects(), 1);
}

#[fc_test::test(start_paused = true)]
async fn a_call_says_why_there_was_no_first_connection() {
    let _alone = alone();
    for (script, why) in [("", REFUSED), ("?", Loss::NotYet)] {
        let (app, _dialled) = lazily(script);
        let options = CallOptions {
            timeout: Some(Duration::from_secs(2)),
            repeat: None,
        };
        let start = Instant::now();
        let call = app.call(&Go { metres: 1 }).with_options(options).await;
        assert_eq!(call, Err(CallError::NotConnected(why)));
        assert_eq!(start.elapsed(), Duration::from_secs(2));
        app.close();
        let call = app.call(&Go { metres: 1 }).await;
        assert_eq!(call, Err(CallError::Closed(Loss::Here)));
    }
}

#[fc_test::test(start_paused = true)]
async fn slow_attempt_is_replaced_by_the_next() {
    let _alone = alone();
    let (app, mut dialled) = lazily("?+");
    let start = Instant::now();
    let mut states = app.states();
    assert_eq!(states.recv().await.unwrap().why(), Some(Loss::NotYet));
    let why = states.recv().await.unwrap().why();
    assert_eq!(why, Some(Loss::ConnectTimeout));
    assert_eq!(start.elapsed().as_secs(), 3);
    assert!(states.recv().await.unwrap().is_connected());
    dialled.recv().await.unwrap();
}

/// The first attempt is at once, and is one of those that may fail.
#[fc_test::test(start_paused = true)]
async fn the_first_connection_is_given_up_like_another() {
    let _alone = alone();
    let waiting = |attempts| Backoff {
        first: Duration::from_secs(8),
        longest: Duration::from_secs(8),
        attempts: Some(attempts),
    };
    for (backoff, waits) in [(None, 0), (Some(waiting(1)), 0), (Some(waiting(3)), 2)] {
        let start = Instant::now();
        let config = ClientConfig::new().reconnect(backoff);
        let app = Connection::<Toy>::connect_lazy_by(attempts("").0, config);
        assert_eq!(app.closed().await, REFUSED);
        let waited = start.elapsed().as_secs();
        assert!((waits * 6..=waits * 8).contains(&waited), "{waited} s");
        assert_eq!(app.state().connects(), 0);
    }
}

#[fc_test::test(start_paused = true)]
async fn connection_attempts_are_logged_with_a_limit() {
    let log = Log::listen(Level::INFO);
    let (app, mut dialled) = lazily("xxxx?xx+");
    let _robot = dialled.recv().await.unwrap();
    while !app.state().is_connected() {
        sleep(Duration::from_millis(1)).await;
    }
    let lines = log.take();
    let has = |line: &str, words: &[&str]| {
        for word in words {
            assert!(line.contains(word), "no {word} in {lines:#?}");
        }
    };
    assert_eq!(lines.len(), 4, "{lines:#?}");
    has(
        &lines[0],
        &["WARN cannot connect", "reason=\"unreachable\""],
    );
    has(&lines[1], &["reason=\"connect_timeout\""]);
    has(&lines[2], &["reason=\"unreachable\""]);
    has(&lines[3], &["INFO connected", "connects=1", "failed=7"]);
}

/// A connection without handles ends, even while it is being made.
#[fc_test::test(start_paused = true)]
async fn the_last_handle_ends_the_attempts() {
    let _alone = alone();
    let (app, dialled) = lazily("");
    let mut states = app.states();
    drop(app);
    while !states.recv().await.unwrap().is_closed() {}
    // The attempts, and with them their end of the channel, are gone.
    let mut dialled = dialled;
    assert!(dialled.recv().await.is_none());
}
