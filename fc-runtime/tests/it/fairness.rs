//! Limits on the time that one connection may take from others: turns, large frames, floods; and the responses to a
//! burst.

use crate::common::net::{Raw, Robot, loopback, nowhere, service};
use crate::common::{Done, Echo, EchoReply, Go, Moved, Toy, command, frame, report, until};
use fc_derive::{Command, Message};
use fc_runtime::json::{Reader, Writer};
use fc_runtime::{
    BodyError, ClientConfig, Command, Connection, Decoder, Encoder, FrameId, FromJson, Gzip,
    Protocol, Report, Request, ToJson, read_enveloped,
};
use std::collections::BTreeMap;
use std::io;
use std::pin::Pin;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::task::{Context, Poll, Wake, Waker};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, ReadBuf};
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tokio::task::yield_now;

fn echo(text: &str) -> Echo {
    Echo {
        text: text.to_owned(),
    }
}

/// A frame of a few bytes that inflate to a large `body`.
fn packed(id: FrameId, body: &[u8]) -> Vec<u8> {
    let gzip = Gzip {
        from_bytes: 0,
        level: 9,
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::<Toy>::new().gzip(gzip);
    encoder.bytes(&mut bytes, id, body).unwrap();
    bytes
}

#[fc_test::test]
async fn a_flood_takes_turns_with_the_others() {
    let handled = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&handled);
    let robot = Robot::start(loopback(), move |request: Request<'_, Toy>| {
        if request.code() == Go::CODE {
            count.fetch_add(1, Ordering::Relaxed);
            return request.handle(|_, _: Go| async { Ok(Done {}) });
        }
        service(request)
    })
    .await;
    let other = robot.pipe(ClientConfig::new());
    let (stream, end) = tokio::io::duplex(1 << 20);
    robot.handle.serve(end, nowhere()).unwrap();
    let mut flood = Raw::new(stream);
    let request = frame(command(Go::CODE, 1), br#"{"metres":1}"#);
    flood.send(&request.repeat(5000)).await;
    let mut before = 0;
    for _ in 0..20 {
        assert!(other.call(&echo("x")).await.is_ok());
        let now = handled.load(Ordering::Relaxed);
        // Some turns on the way there and back.
        assert!(now - before <= 200, "{} in between", now - before);
        before = now;
    }
    assert!(before < 5000, "the flood was over before");
}

/// To read a large frame others wait for their turn; not for what its handler does.
#[fc_test::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_handler_is_not_within_the_gate() {
    let (begin, mut begun) = unbounded_channel();
    let (meet, met) = mpsc::channel();
    let met = Arc::new(Mutex::new(met));
    let robot = Robot::start(loopback(), move |request: Request<'_, Toy>| {
        let (begin, meet, met) = (begin.clone(), meet.clone(), Arc::clone(&met));
        request.handle(move |context, _: Echo| async move {
            begin.send(()).unwrap();
            if context.id == 1 {
                // Only a test that fails waits for so long.
                let other = met.lock().unwrap().recv_timeout(Duration::from_secs(10));
                assert!(other.is_ok(), "the handler of the other was not begun");
            } else {
                meet.send(()).unwrap();
            }
            Ok(EchoReply {
                text: String::new(),
            })
        })
    })
    .await;
    let (mut one, mut two) = (robot.raw(), robot.raw());
    one.send(&packed(command(Echo::CODE, 1), &large('x'))).await;
    begun.recv().await.unwrap();
    two.send(&packed(command(Echo::CODE, 2), &large('x'))).await;
    assert_eq!(one.result().await.1, Toy::RESULTS.success.code);
    assert_eq!(two.result().await.1, Toy::RESULTS.success.code);
}

/// Texts whose reading takes as long as a test wants, by their first letter.
static WORKS: Mutex<BTreeMap<char, Arc<Work>>> = Mutex::new(BTreeMap::new());

/// The readings that have begun, and the leave to end them.
struct Work {
    begun: AtomicUsize,
    released: Mutex<mpsc::Receiver<()>>,
}

/// A text that takes long to read.
#[derive(Clone, Debug, PartialEq)]
struct Text(String);

impl FromJson for Text {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        let text = String::read(reader)?;
        let letter = text.chars().next().unwrap();
        let work = Arc::clone(&WORKS.lock().unwrap()[&letter]);
        work.begun.fetch_add(1, Ordering::SeqCst);
        work.released.lock().unwrap().recv().unwrap();
        Ok(Self(text))
    }
}

impl ToJson for Text {
    fn write(&self, writer: &mut Writer<'_>) {
        self.0.write(writer);
    }
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0107, name = "large", effect = "read", response = Done)]
struct Large {
    text: Text,
}

fn large(letter: char) -> Vec<u8> {
    format!(r#"{{"text":"{}"}}"#, letter.to_string().repeat(1 << 20)).into_bytes()
}

/// With one worker thread, the other connection could not be served if the large frame kept it.
#[fc_test::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_large_frame_does_not_keep_the_thread() {
    one_after_the_other('a', |id| packed(command(Large::CODE, id), &large('a'))).await;
}

/// Those that are not packed take their turn as well; here a thread would be free for the second one.
#[fc_test::test(flavor = "multi_thread", worker_threads = 4)]
async fn large_frames_go_one_at_a_time() {
    one_after_the_other('b', |id| frame(command(Large::CODE, id), &large('b'))).await;
}

/// Two apps send a `large` frame each. While the first is read the second is not, and a third app notices
/// nothing.
async fn one_after_the_other(letter: char, large: fn(u32) -> Vec<u8>) {
    let (release, released) = mpsc::channel();
    let work = Arc::new(Work {
        begun: AtomicUsize::new(0),
        released: Mutex::new(released),
    });
    WORKS.lock().unwrap().insert(letter, Arc::clone(&work));
    let robot = Robot::start(loopback(), |request: Request<'_, Toy>| {
        if request.code() == Large::CODE {
            return request.handle(|_, _: Large| async { Ok(Done {}) });
        }
        service(request)
    })
    .await;
    let (mut one, mut two) = (robot.raw(), robot.raw());
    one.send(&large(1)).await;
    two.send(&large(2)).await;
    until(|| work.begun.load(Ordering::SeqCst) != 0).await;
    let other = robot.pipe(ClientConfig::new());
    for _ in 0..100 {
        assert!(other.call(&echo("x")).await.is_ok());
    }
    // One after the other.
    assert_eq!(work.begun.load(Ordering::SeqCst), 1);
    release.send(()).unwrap();
    until(|| work.begun.load(Ordering::SeqCst) != 1).await;
    release.send(()).unwrap();
    assert!(one.recv().await.is_some());
    assert!(two.recv().await.is_some());
}

/// The same at the data port, where whole frames are checked alike.
#[fc_test::test]
async fn a_flood_of_streams_takes_turns_with_the_others() {
    let robot = Robot::start(loopback(), service).await;
    let (stream, end) = tokio::io::duplex(8 << 20);
    robot.handle.serve_data(end, nowhere()).unwrap();
    let mut flood = Raw::new(stream);
    let stream = FrameId {
        kind: <Toy as fc_runtime::Protocol>::STREAM,
        ..command(9, 9)
    };
    flood.send(&frame(stream, &[0; 4000]).repeat(1500)).await;
    let other = robot.pipe(ClientConfig::new());
    assert!(other.call(&echo("x")).await.is_ok());
    let taken = robot.handle.counters().stream_frames_in;
    assert!(taken < 1500, "the flood came first");
}

/// A robot that always has something to say.
struct Endless {
    id: u32,
    rest: Vec<u8>,
}

impl AsyncRead for Endless {
    fn poll_read(
        mut self: Pin<&mut Self>,
        _: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        if self.rest.is_empty() {
            self.id += 1;
            self.rest = frame(report(Moved::CODE, self.id), br#"{"metres":1}"#);
        }
        let length = self.rest.len().min(buffer.remaining());
        buffer.put_slice(&self.rest[..length]);
        self.rest.drain(..length);
        Poll::Ready(Ok(()))
    }
}

#[fc_test::test]
async fn a_robot_that_floods_leaves_time_to_its_app() {
    let endless = Endless {
        id: 0,
        rest: Vec::new(),
    };
    let robot = tokio::io::join(endless, tokio::io::sink());
    let app = Connection::<Toy>::over(robot, ClientConfig::new());
    let mut reports = app.reports();
    for _ in 0..1000 {
        assert!(reports.recv().await.is_some());
    }
    app.close();
    while reports.recv().await.is_some() {}
}

struct Counted;

impl Wake for Counted {
    fn wake(self: Arc<Self>) {}
}

#[fc_test::test]
async fn dropped_report_streams_release_memory() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let counted = Arc::new(Counted);
    let waker = Waker::from(Arc::clone(&counted));
    let mut stays = app.reports();
    for _ in 0..100 {
        let mut cx = Context::from_waker(&waker);
        assert!(stays.poll_recv(&mut cx).is_pending());
        assert!(app.reports().poll_recv(&mut cx).is_pending());
    }
    // The test's own two, and the one of the stream that has not gone.
    assert_eq!(Arc::strong_count(&counted), 3);
}

/// An answer much larger than its request counts as well.
#[fc_test::test]
async fn large_answers_take_turns_too() {
    let handled = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&handled);
    let robot = Robot::start(loopback(), move |request: Request<'_, Toy>| {
        if request.body().len() > 14 {
            return service(request);
        }
        count.fetch_add(1, Ordering::Relaxed);
        request.handle(|_, _: Echo| async {
            Ok(EchoReply {
                text: "x".repeat(100_000),
            })
        })
    })
    .await;
    let (stream, end) = tokio::io::duplex(256 << 20);
    robot.handle.serve(end, nowhere()).unwrap();
    let mut greedy = Raw::new(stream);
    let request = frame(command(Echo::CODE, 1), br#"{"text":"x"}"#);
    greedy.send(&request.repeat(500)).await;
    let other = robot.pipe(ClientConfig::new());
    assert!(other.call(&echo("not so short")).await.is_ok());
    let first = handled.load(Ordering::Relaxed);
    assert!(first < 50, "{first} came first");
}

/// Tells of every write.
struct Writes(UnboundedSender<Vec<u8>>);

impl AsyncWrite for Writes {
    fn poll_write(
        self: Pin<&mut Self>,
        _: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.0.send(bytes.to_vec()).unwrap();
        Poll::Ready(Ok(bytes.len()))
    }

    fn poll_flush(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }
}

/// A long answer is digested and written bit by bit, whatever comes before and behind it.
#[fc_test::test]
async fn a_long_answer_leaves_the_others_their_turns() {
    const LENGTHS: [usize; 5] = [10, 1 << 20, 20, 100_000, 30];
    let robot = Robot::start(loopback(), |request: Request<'_, Toy>| {
        request.handle(|_, Echo { text }: Echo| async move {
            Ok(EchoReply {
                text: "x".repeat(text.parse().unwrap()),
            })
        })
    })
    .await;
    let (writes, mut written) = unbounded_channel();
    let requests: Vec<u8> = (1..)
        .zip(LENGTHS)
        .flat_map(|(id, length)| {
            let body = format!(r#"{{"text":"{length}"}}"#);
            frame(command(Echo::CODE, id), body.as_bytes())
        })
        .collect();
    let (_open, silence) = tokio::io::duplex(1);
    let requests = io::Cursor::new(requests).chain(silence);
    let stream = tokio::io::join(requests, Writes(writes));
    robot.handle.serve(stream, nowhere()).unwrap();

    let (mut turns, mut in_one_turn) = (0, 0);
    let mut decoder = Decoder::<Toy>::new();
    let mut lengths = Vec::new();
    while lengths.len() < LENGTHS.len() {
        let mut bytes = 0;
        while let Ok(piece) = written.try_recv() {
            bytes += piece.len();
            decoder.push(&piece);
        }
        in_one_turn = bytes.max(in_one_turn);
        while let Some(frame) = decoder.next().unwrap() {
            let allowance = Toy::DEFAULTS.limits.json();
            let read =
                read_enveloped::<<Toy as Protocol>::Response, EchoReply>(frame.body(), allowance)
                    .unwrap();
            lengths.push(read.body.unwrap().text.len());
        }
        turns += 1;
        yield_now().await;
    }
    assert_eq!(lengths, LENGTHS);
    assert!(turns > 20, "only {turns} turns");
    assert!(in_one_turn < 300_000, "{in_one_turn} bytes in one turn");
}

/// Both sides work at the same time, and several responses share a write.
#[fc_test::test]
async fn answers_to_a_burst_leave_in_slices() {
    let robot = Robot::start(loopback(), service).await;
    let (writes, mut written) = unbounded_channel();
    let requests: Vec<u8> = (0..40)
        .flat_map(|id| frame(command(Echo::CODE, id), br#"{"text":"x"}"#))
        .collect();
    // All requests at once, and nothing after them.
    let (_open, silence) = tokio::io::duplex(1);
    let requests = io::Cursor::new(requests).chain(silence);
    let burst = tokio::io::join(requests, Writes(writes));
    robot.handle.serve(burst, nowhere()).unwrap();
    let mut answers = Vec::new();
    while answers.iter().sum::<u32>() < 40 {
        let mut decoder = Decoder::<Toy>::new();
        decoder.push(&written.recv().await.unwrap());
        let mut count = 0;
        while decoder.next().unwrap().is_some() {
            count += 1;
        }
        answers.push(count);
    }
    assert_eq!(answers, [32, 8]);
}
