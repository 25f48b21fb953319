//! A single caller writes to the socket itself, which is noticeable only by its speed.

use crate::common::net::{Raw, app_of_raw};
use crate::common::{Echo, Moved, Toy, answer_to, report, until};
use fc_runtime::{CallError, CallOptions, ClientConfig, Connection, Report};
use std::io;
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, Waker};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, DuplexStream, ReadBuf};
use tokio::task::{JoinHandle, yield_now};
use tokio::time::{Instant, sleep};

fn echo(text: &str) -> Echo {
    Echo { text: text.into() }
}

fn once<F: Future>(future: Pin<&mut F>) -> Poll<F::Output> {
    future.poll(&mut Context::from_waker(Waker::noop()))
}

/// A connection whose driver has nothing left to do.
async fn idle() -> (Connection<Toy>, Raw<DuplexStream>) {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    answered(&app, &mut robot, "first").await;
    yield_now().await;
    (app, robot)
}

/// Calls and answers.
async fn answered(app: &Connection<Toy>, robot: &mut Raw<DuplexStream>, text: &str) {
    let request = echo(text);
    let (call, ()) = tokio::join!(app.call(&request), async {
        let (id, body) = robot.recv().await.unwrap();
        robot
            .send_frame(answer_to(id), &body.replacen('{', r#"{"result":7,"#, 1))
            .await;
    });
    assert_eq!(call.unwrap().text, text);
}

/// The driver is a task of the same thread: it cannot have had its turn in between.
#[fc_test::test]
async fn a_lone_request_leaves_before_its_driver_has_a_turn() {
    let (app, mut robot) = idle().await;
    let request = echo("x");
    let mut call = pin!(app.call(&request));
    assert!(once(call.as_mut()).is_pending());
    let mut bytes = [0; 1000];
    let read = once(pin!(robot.stream.read(&mut bytes)));
    assert!(matches!(read, Poll::Ready(Ok(n)) if n > 35), "{read:?}");
}

/// Two at once go with one write of the driver's.
#[fc_test::test]
async fn the_second_of_two_is_left_to_the_driver() {
    let (app, mut robot) = idle().await;
    let request = echo("x");
    let (mut one, mut two) = (pin!(app.call(&request)), pin!(app.call(&request)));
    assert!(once(one.as_mut()).is_pending());
    assert!(once(two.as_mut()).is_pending());
    let first = robot.recv().await.unwrap().0;
    let mut bytes = [0; 1000];
    assert!(once(pin!(robot.stream.read(&mut bytes))).is_pending());
    yield_now().await;
    let second = robot.recv().await.unwrap().0;
    assert_ne!(first.id, second.id);
}

/// Others have their answers and have not had their turn yet: what they ask for next goes with one write.
#[fc_test::test]
async fn first_of_many_calls_is_left_to_the_driver() {
    let (app, mut robot) = idle().await;
    let request = echo("x");
    let (mut one, mut two) = (pin!(app.call(&request)), pin!(app.call(&request)));
    assert!(once(one.as_mut()).is_pending());
    assert!(once(two.as_mut()).is_pending());
    for _ in 0..2 {
        let (id, body) = robot.recv().await.unwrap();
        let answer = body.replacen('{', r#"{"result":7,"#, 1);
        robot.send_frame(answer_to(id), &answer).await;
    }
    until(|| app.counters().answers == 3).await;
    one.await.unwrap();
    let mut next = pin!(app.call(&request));
    assert!(once(next.as_mut()).is_pending());
    let mut bytes = [0; 1000];
    assert!(once(pin!(robot.stream.read(&mut bytes))).is_pending());
    two.await.unwrap();
    assert!(robot.recv().await.is_some());
}

/// The driver sends the bytes that the socket does not take at once. They stay in order, also with those of a later
/// call.
#[fc_test::test]
async fn partially_written_request_arrives_whole() {
    let (app, robot) = answering(16);
    for round in 0..20 {
        let (one, two) = (echo(&"a".repeat(round * 37)), echo(&"b".repeat(round)));
        assert_eq!(app.call(&one).await.unwrap().text, one.text);
        let (first, second) = tokio::join!(app.call(&one), app.call(&two));
        assert_eq!(first.unwrap().text, one.text);
        assert_eq!(second.unwrap().text, two.text);
    }
    drop(app);
    robot.await.unwrap();
}

/// Caller and driver write from their own threads, and the socket takes little at a time.
#[fc_test::test(flavor = "multi_thread", worker_threads = 4)]
async fn callers_and_the_driver_write_in_turns() {
    let (app, robot) = answering(40);
    let mut reports = app.reports();
    // It keeps the connection open as the app does.
    let taken = tokio::spawn(async move { while reports.recv().await.is_some() {} });
    let request = echo("a request that is longer than what the socket takes at once");
    for _ in 0..2000 {
        assert_eq!(app.call(&request).await.unwrap().text, request.text);
    }
    taken.abort();
    robot.abort();
}

/// An app of a robot that reports before and after it answers, over a pipe of so many bytes.
fn answering(bytes: usize) -> (Connection<Toy>, JoinHandle<()>) {
    let (app, robot) = tokio::io::duplex(bytes);
    let mut robot = Raw::new(robot);
    let answering = async move {
        let mut number = 0;
        while let Some((id, body)) = robot.recv().await {
            if id.response {
                continue;
            }
            let answer = body.replacen('{', r#"{"result":7,"#, 1);
            for _ in 0..2 {
                number += 1;
                robot
                    .send_frame(report(Moved::CODE, number), r#"{"metres":1}"#)
                    .await;
            }
            robot.send_frame(answer_to(id), &answer).await;
            number += 1;
            robot
                .send_frame(report(Moved::CODE, number), r#"{"metres":1}"#)
                .await;
        }
    };
    (
        Connection::over(app, ClientConfig::new()),
        tokio::spawn(answering),
    )
}

/// Takes everything, and says that it broke.
struct Liar {
    stream: DuplexStream,
    lies: Arc<AtomicBool>,
}

impl AsyncRead for Liar {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(cx, buf)
    }
}

impl AsyncWrite for Liar {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(cx, bytes);
        if self.lies.load(Ordering::Relaxed) {
            return Poll::Ready(Err(io::ErrorKind::ConnectionReset.into()));
        }
        written
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}

/// A sent motion is not sent again because its caller could not be told.
#[fc_test::test]
async fn after_an_error_nothing_is_written_again() {
    for is_closed in [false, true] {
        let (stream, robot) = tokio::io::duplex(1 << 16);
        let lies = Arc::new(AtomicBool::new(false));
        let liar = Liar {
            stream,
            lies: Arc::clone(&lies),
        };
        let app = Connection::<Toy>::over(liar, ClientConfig::new());
        let mut robot = Raw::new(robot);
        answered(&app, &mut robot, "first").await;
        lies.store(true, Ordering::Relaxed);
        let request = echo("once");
        let mut call = pin!(app.call(&request));
        assert!(once(call.as_mut()).is_pending());
        if is_closed {
            app.close();
        }
        lies.store(false, Ordering::Relaxed);
        assert!(call.await.is_err());
        assert!(robot.recv().await.is_some());
        assert_eq!(robot.recv().await, None);
    }
}

/// The driver's timer may be set to something later, or to something that is past.
#[fc_test::test(start_paused = true)]
async fn a_lone_call_ends_at_its_own_deadline() {
    let (app, mut robot) = idle().await;
    let timeout = |seconds| CallOptions {
        timeout: Some(Duration::from_secs(seconds)),
        ..CallOptions::default()
    };
    for seconds in [50, 1, 2, 1, 60, 1] {
        let request = echo("x");
        let at = Instant::now();
        let error = app
            .call(&request)
            .with_options(timeout(seconds))
            .await
            .unwrap_err();
        assert_eq!(error, CallError::Timeout);
        assert_eq!(at.elapsed().as_secs(), seconds);
        // The unanswered call.
        robot.recv().await.unwrap();
        answered(&app, &mut robot, "between").await;
        sleep(Duration::from_secs(7)).await;
    }
}
