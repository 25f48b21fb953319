//! The shutdown of a server: it ends within the grace period, whatever apps and handlers do, and every call and report
//! ends with it.

use crate::common::net::{Robot, loopback, nowhere, service};
use crate::common::{Done, Echo, EchoReply, Go, LIMITS, Moved, Toy, command, frame, until};
use fc_derive::{Message, Report};
use fc_runtime::{
    AckOutcome, Acknowledgement, Audience, CallError, ClientConfig, Command, Connection, Limits,
    PushError, RawReports, Request, Server, ServerHandle,
};
use std::any::Any;
use std::future::{pending, poll_fn};
use std::pin::{Pin, pin};
use std::sync::{Arc, OnceLock};
use std::task::Poll;
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::sync::Semaphore;
use tokio::task::{JoinHandle, JoinSet, yield_now};
use tokio::time::{Instant, timeout};

const SECOND: Duration = Duration::from_secs(1);
const LONG: Duration = Duration::from_secs(1000);

/// A body that blocks the robot if the app does not read.
#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0B03, name = "picture")]
struct Picture {
    text: String,
}

fn picture() -> Picture {
    Picture {
        text: "x".repeat(300_000),
    }
}

/// Lets all tasks go on as far as they can without time.
async fn settle() {
    for _ in 0..100 {
        yield_now().await;
    }
}

/// Polls a future that takes its time for the first time.
async fn begin(mut future: Pin<&mut impl Future>) {
    poll_fn(|cx| {
        assert!(future.as_mut().poll(cx).is_pending());
        Poll::Ready(())
    })
    .await;
}

type Pushed = JoinHandle<Result<Vec<Acknowledgement>, PushError>>;

fn push(handle: &ServerHandle<Toy>, metres: i32) -> Pushed {
    let handle = handle.clone();
    tokio::spawn(async move { handle.push(Audience::All, &Moved { metres }).await })
}

fn push_picture(handle: &ServerHandle<Toy>) -> Pushed {
    let handle = handle.clone();
    tokio::spawn(async move { handle.push(Audience::All, &picture()).await })
}

fn call(app: &Connection<Toy>) -> JoinHandle<Result<Done, CallError>> {
    let app = app.clone();
    tokio::spawn(async move { app.call(&Go { metres: 1 }).await })
}

/// Activity during the shutdown of a server. It is held, and neither polled nor dropped.
#[derive(Default)]
struct Scene {
    held: Vec<Box<dyn Any>>,
    pushes: Vec<Pushed>,
    calls: Vec<JoinHandle<Result<Done, CallError>>>,
}

/// A robot whose handler of [`Go`] never ends, and the events it has seen.
async fn stubborn() -> Robot {
    let config = loopback()
        .handler_timeout(LONG * 1000)
        .stall_timeout(LONG * 1000)
        .limits(Limits {
            queued_reports: 4,
            in_flight: 4,
            connections: 32,
            ..LIMITS
        });
    Robot::start(config, |request: Request<'_, Toy>| match request.code() {
        Go::CODE => request.handle(|_, _: Go| pending()),
        _ => service(request),
    })
    .await
}

fn patient() -> ClientConfig {
    ClientConfig::new().call_timeout(LONG * 1000)
}

/// Unpolled report streams, more reports than fit into them, and an app that stays.
async fn streams_unpolled(robot: &Robot, scene: &mut Scene) {
    let limits = Limits {
        queued_reports: 2,
        ..LIMITS
    };
    let app = robot.pipe(patient().limits(limits));
    assert!(app.call(&echo()).await.is_ok());
    let streams: Vec<RawReports<Toy>> = (0..7).map(|_| app.reports()).collect();
    // Two fill the app's queue, four are in flight and not acknowledged, four wait.
    scene
        .pushes
        .extend((0..10).map(|metres| push(&robot.handle, metres)));
    settle().await;
    scene.held.push(Box::new((streams, app)));
}

/// An app that reads nothing, while the robot has much to send to it.
async fn deaf(robot: &Robot, scene: &mut Scene) {
    let app = robot.raw();
    settle().await;
    scene.pushes.push(push_picture(&robot.handle));
    settle().await;
    scene.held.push(Box::new(app));
}

/// The same, where the robot has answers to send.
async fn deaf_to_answers(robot: &Robot, scene: &mut Scene) {
    let mut app = robot.raw();
    let text = format!(r#"{{"text":"{}"}}"#, "x".repeat(200_000));
    let request = frame(command(Echo::CODE, 1), text.as_bytes());
    app.send(&request).await;
    settle().await;
    scene.held.push(Box::new(app));
}

/// A handler that never ends.
async fn handler(robot: &Robot, scene: &mut Scene) {
    let app = robot.pipe(patient());
    scene.calls.push(call(&app));
    settle().await;
    scene.held.push(Box::new(app));
}

/// A frame that has begun and does not go on.
async fn half_a_frame(robot: &Robot, scene: &mut Scene) {
    let mut app = robot.raw();
    app.send(&frame(command(Echo::CODE, 1), b"{}")[..20]).await;
    settle().await;
    scene.held.push(Box::new(app));
}

/// Data connections: one idle, one that does not read, one whose frames are not taken.
async fn data(robot: &Robot, scene: &mut Scene) {
    let idle = robot.raw_data();
    let streams = robot.handle.streams();
    let mut eager = robot.raw_data();
    let stream = fc_runtime::FrameId {
        kind: <Toy as fc_runtime::Protocol>::STREAM,
        ..command(9, 9)
    };
    for _ in 0..10 {
        eager.send(&frame(stream, b"bytes")).await;
    }
    let handle = robot.handle.clone();
    let sending = tokio::spawn(async move {
        let picture = vec![0; 300_000];
        for id in 0..10 {
            let _ = handle.send_stream(Audience::All, 9, id, &picture).await;
        }
    });
    settle().await;
    scene.held.push(Box::new((idle, eager, streams, sending)));
}

fn echo() -> Echo {
    Echo { text: "x".into() }
}

/// Ends the robot, and checks that all is over in time.
async fn end(robot: &Robot, scene: Scene, grace: Duration) {
    let start = Instant::now();
    let ended = timeout(LONG, robot.handle.shutdown(grace)).await;
    assert!(ended.is_ok(), "shutdown hangs");
    let took = start.elapsed();
    assert!(took <= grace + Duration::from_millis(1), "{took:?}");
    for call in scene.calls {
        let call = timeout(LONG, call).await.expect("calls end");
        assert!(matches!(call.unwrap(), Err(CallError::Lost(_))));
    }
    for push in scene.pushes {
        let outcomes = timeout(LONG, push).await.expect("pushes end");
        for end in outcomes.unwrap().unwrap() {
            match end.outcome {
                AckOutcome::Acknowledged | AckOutcome::Dropped | AckOutcome::Closed => {}
                AckOutcome::TimedOut => assert!(grace > 5 * SECOND),
                other => panic!("{other:?}"),
            }
        }
    }
    until(|| robot.handle.connections().is_empty()).await;
}

macro_rules! each_scene {
    ($($scene:ident)*) => {$(
        mod $scene {
            #[fc_test::test(start_paused = true)]
            async fn ends_within_the_grace() {
                for grace in super::GRACES {
                    let robot = super::stubborn().await;
                    let mut scene = super::Scene::default();
                    super::$scene(&robot, &mut scene).await;
                    super::end(&robot, scene, grace).await;
                }
            }
        }
    )*

        /// All of it at once.
        #[fc_test::test(start_paused = true)]
        async fn everything_at_once() {
            for grace in GRACES {
                let robot = stubborn().await;
                let mut scene = Scene::default();
                $($scene(&robot, &mut scene).await;)*
                end(&robot, scene, grace).await;
            }
        }
    };
}

const GRACES: [Duration; 3] = [Duration::ZERO, SECOND, Duration::from_secs(20)];

each_scene! { streams_unpolled deaf deaf_to_answers handler half_a_frame data }

/// The same over sockets, in real time, with all tasks on one thread.
#[fc_test::test]
async fn streams_unpolled_over_sockets() {
    let robot = stubborn().await;
    let app = robot.connect().await;
    assert!(app.call(&echo()).await.is_ok());
    let streams: Vec<RawReports<Toy>> = (0..7).map(|_| app.reports()).collect();
    let pushes: Vec<_> = (0..40).map(|metres| push(&robot.handle, metres)).collect();
    until(|| robot.handle.counters().reports_acknowledged >= 4).await;
    let data = app.data();
    until(|| robot.handle.counters().data_connections > 0).await;
    robot.handle.shutdown(LONG).await;
    for push in pushes {
        assert!(push.await.unwrap().is_ok());
    }
    assert_eq!(data.recv().await.unwrap_err().name(), "lost");
    drop(streams);
}

#[fc_test::test]
async fn shutdown_answers_running_calls() {
    let gate: &'static Semaphore = Box::leak(Box::new(Semaphore::new(0)));
    let robot = Robot::start(loopback(), move |request: Request<'_, Toy>| {
        request.handle(move |_, _: Go| async {
            gate.acquire().await.unwrap().forget();
            Ok(Done {})
        })
    })
    .await;
    let app = Connection::<Toy>::connect(robot.config.clone().reconnect(None))
        .await
        .unwrap();
    let request = Go { metres: 1 };
    let handled = async {
        let done = app.call(&request).await;
        // No more requests are taken.
        assert_eq!(app.reports().recv().await, None);
        done
    };
    let (done, ()) = tokio::join!(handled, async {
        until(|| robot.handle.counters().bytes_in > 0).await;
        let mut shutdown = pin!(robot.handle.shutdown(LONG));
        begin(shutdown.as_mut()).await;
        settle().await;
        // The system accepts new connections, but the server does not.
        let late = Connection::<Toy>::connect(robot.config.clone().reconnect(None));
        let late = late.await.unwrap();
        let lost = tokio::spawn(async move { late.call(&echo()).await });
        let (_app, pipe) = tokio::io::duplex(100);
        assert_eq!(robot.handle.serve(pipe, nowhere()), None);
        settle().await;
        gate.add_permits(1);
        shutdown.await;
        assert!(matches!(lost.await.unwrap(), Err(CallError::Lost(_))));
    });
    assert_eq!(done, Ok(Done {}));
    assert!(TcpStream::connect(robot.command).await.is_err());
}

#[fc_test::test(start_paused = true)]
async fn shutdown_ends_at_its_limit() {
    let robot = stubborn().await;
    let mut scene = Scene::default();
    handler(&robot, &mut scene).await;
    let start = Instant::now();
    robot.handle.shutdown(5 * SECOND).await;
    assert_eq!(start.elapsed().as_secs(), 5);
    end(&robot, scene, Duration::ZERO).await;
}

#[fc_test::test(start_paused = true)]
async fn the_earliest_of_several_ends_counts() {
    for (first, second) in [(LONG, SECOND), (SECOND, LONG)] {
        let robot = stubborn().await;
        let mut scene = Scene::default();
        handler(&robot, &mut scene).await;
        let other = robot.handle.clone();
        let start = Instant::now();
        tokio::join!(robot.handle.shutdown(first), other.shutdown(second));
        assert_eq!(start.elapsed().as_secs(), 1);
        // Once more, when all is over.
        end(&robot, scene, Duration::ZERO).await;
    }
}

#[fc_test::test(start_paused = true)]
async fn shutdown_ends_without_being_awaited() {
    let robot = stubborn().await;
    let mut scene = Scene::default();
    handler(&robot, &mut scene).await;
    let start = Instant::now();
    begin(pin!(robot.handle.shutdown(SECOND))).await;
    drop(robot);
    let lost = scene.calls.remove(0).await.unwrap();
    assert!(matches!(lost, Err(CallError::Lost(_))));
    assert_eq!(start.elapsed().as_secs(), 1);
}

#[fc_test::test(start_paused = true)]
async fn server_that_never_ran_shuts_down() {
    for polled in [false, true] {
        let server = Server::<Toy>::bind(loopback(), |request: Request<'_, Toy>| {
            request.handle(|_, _: Go| pending())
        })
        .await
        .unwrap();
        let handle = server.handle();
        let mut run = Box::pin(server.run());
        if polled {
            begin(run.as_mut()).await;
        }
        let (app, end) = tokio::io::duplex(1000);
        handle.serve(end, nowhere()).unwrap();
        let app = Connection::<Toy>::over(app, patient());
        let call = call(&app);
        settle().await;
        let start = Instant::now();
        handle.shutdown(SECOND).await;
        assert_eq!(start.elapsed().as_secs(), 1);
        assert!(matches!(call.await.unwrap(), Err(CallError::Lost(_))));
        drop(run);
    }
}

#[fc_test::test]
async fn a_server_that_never_ran_is_over_when_it_is_dropped() {
    let server = Server::<Toy>::bind(loopback(), service).await.unwrap();
    let handle = server.handle();
    drop(server);
    handle.shutdown(LONG).await;
    let (_app, end) = tokio::io::duplex(100);
    assert_eq!(handle.serve(end, nowhere()), None);
}

#[fc_test::test(start_paused = true)]
async fn handler_may_shut_down_and_push() {
    let known: Arc<OnceLock<ServerHandle<Toy>>> = Arc::default();
    let own = Arc::clone(&known);
    let robot = Robot::start(loopback(), move |request: Request<'_, Toy>| {
        let handle = own.get().expect("the robot is known").clone();
        request.handle(move |_, Echo { text }| async move {
            let shutdown = handle.shutdown(SECOND);
            let report = handle.push(Audience::All, &Moved { metres: 1 });
            let (reported, ()) = tokio::join!(report, shutdown);
            reported.expect("a push");
            Ok(EchoReply { text })
        })
    })
    .await;
    assert!(known.set(robot.handle.clone()).is_ok());
    let app = robot.pipe(patient());
    let start = Instant::now();
    assert!(matches!(app.call(&echo()).await, Err(CallError::Lost(_))));
    assert_eq!(start.elapsed().as_secs(), 1);
}

/// Connections, calls and reports that begin while a server ends on other threads all end, too.
#[fc_test::test(flavor = "multi_thread", worker_threads = 4)]
async fn connection_during_shutdown_is_closed() {
    for round in 0..200 {
        let config = loopback().limits(Limits {
            connections: 1000,
            ..LIMITS
        });
        let robot = Robot::start(config, |request: Request<'_, Toy>| match request.code() {
            Go::CODE => request.handle(|_, _: Go| pending()),
            _ => service(request),
        })
        .await;
        let mut racing = JoinSet::new();
        for number in 0..8 {
            let handle = robot.handle.clone();
            racing.spawn(async move {
                for _ in 0..20 {
                    let (app, end) = tokio::io::duplex(1000);
                    if handle.serve(end, nowhere()).is_none() {
                        return;
                    }
                    let app = Connection::<Toy>::over(app, patient());
                    let mut calling = JoinSet::new();
                    let other = app.clone();
                    calling.spawn(async move { other.call(&Go { metres: 1 }).await.map(drop) });
                    calling.spawn(async move { app.call(&echo()).await.map(drop) });
                    let handle = handle.clone();
                    calling.spawn(async move {
                        let _ = handle.push(Audience::All, &Moved { metres: 1 }).await;
                        Ok(())
                    });
                    if number % 2 == 0 {
                        while let Some(end) = calling.join_next().await {
                            let end = end.expect("no call panics");
                            assert!(
                                matches!(
                                    end,
                                    Ok(()) | Err(CallError::Lost(_) | CallError::Closed(_))
                                ),
                                "{end:?}"
                            );
                        }
                    } else {
                        // Given up by the caller.
                        yield_now().await;
                    }
                }
            });
        }
        for _ in 0..round % 50 {
            yield_now().await;
        }
        let grace = Duration::from_millis(round % 3);
        let ending = async {
            robot.handle.shutdown(grace).await;
            while let Some(ended) = racing.join_next().await {
                ended.expect("all calls end");
            }
            until(|| robot.handle.connections().is_empty()).await;
        };
        let ended = timeout(Duration::from_secs(60), ending).await;
        assert!(ended.is_ok(), "something hangs in round {round}");
    }
}
