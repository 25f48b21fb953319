//! Floors: the same number of bytes without a protocol.
//!
//! The server answers all requests of one read with one write. The driver of `raw` waits for its own bytes. The driver
//! of `raw-mux` shares a connection between callers, with two tasks, channels, and a oneshot per call.

use super::peer::{Question, Serving, listen};
use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{Mutex, mpsc, oneshot};

/// Length of a request frame of fc, in bytes.
const REQUEST: usize = 100;
/// Length of a small response frame, in bytes.
const SMALL: usize = 190;
/// Length of a large response frame, in bytes.
const LARGE: usize = 1024 * 1024 + 250;

pub async fn serve() -> Serving {
    let (address, listener) = listen().await;
    (address, Box::pin(answer(listener)))
}

/// Answers requests. The first byte of a request selects a small or a large response.
async fn answer(listener: TcpListener) {
    let large = Arc::new(vec![7_u8; LARGE]);
    loop {
        let Ok((mut stream, _)) = listener.accept().await else { return };
        let _ = stream.set_nodelay(true);
        let large = Arc::clone(&large);
        tokio::spawn(async move {
            let mut input = vec![0; 64 * 1024];
            let mut have = 0;
            let mut output = Vec::new();
            loop {
                let read = match stream.read(&mut input[have..]).await {
                    Ok(0) | Err(_) => return,
                    Ok(read) => read,
                };
                have += read;
                let whole = have / REQUEST;
                output.clear();
                for index in 0..whole {
                    if input[index * REQUEST] == 0 {
                        output.resize(output.len() + SMALL, 7);
                    } else {
                        output.extend_from_slice(&large);
                    }
                }
                input.copy_within(whole * REQUEST..have, 0);
                have -= whole * REQUEST;
                if stream.write_all(&output).await.is_err() {
                    return;
                }
            }
        });
    }
}

fn sizes(question: Question) -> (u8, usize) {
    match question {
        Question::Small => (0, SMALL),
        Question::Large => (1, LARGE),
    }
}

type Waiting = (Question, oneshot::Sender<usize>);

/// A connection that several callers share.
#[derive(Clone)]
pub struct Mux(mpsc::UnboundedSender<Waiting>);

impl Mux {
    pub async fn connect(address: SocketAddr) -> Self {
        let stream = TcpStream::connect(address).await.expect("connect");
        stream.set_nodelay(true).expect("nodelay");
        let (mut reader, mut writer) = stream.into_split();
        let (sender, mut calls) = mpsc::unbounded_channel::<Waiting>();
        let (handed, mut pending) = mpsc::unbounded_channel::<Waiting>();
        tokio::spawn(async move {
            let mut out = Vec::new();
            while let Some(call) = calls.recv().await {
                out.clear();
                let mut next = Some(call);
                while let Some(call) = next {
                    out.extend_from_slice(&[sizes(call.0).0; REQUEST]);
                    let _ = handed.send(call);
                    next = calls.try_recv().ok();
                }
                if writer.write_all(&out).await.is_err() {
                    return;
                }
            }
        });
        tokio::spawn(async move {
            let mut input = vec![0; 256 * 1024];
            let mut have = 0;
            let mut waiting: VecDeque<Waiting> = VecDeque::new();
            loop {
                match reader.read(&mut input).await {
                    Ok(0) | Err(_) => return,
                    Ok(read) => have += read,
                }
                while let Ok(next) = pending.try_recv() {
                    waiting.push_back(next);
                }
                while let Some((question, _)) = waiting.front() {
                    let size = sizes(*question).1;
                    if have < size {
                        break;
                    }
                    have -= size;
                    if let Some((_, done)) = waiting.pop_front() {
                        let _ = done.send(size);
                    }
                }
            }
        });
        Self(sender)
    }

    pub async fn call(self, question: Question) -> usize {
        let (done, answer) = oneshot::channel();
        self.0.send((question, done)).expect("the connection is gone");
        answer.await.expect("the connection is gone")
    }
}

/// A connection for one caller at a time, without other tasks.
///
/// Several requests in flight go out in one write, and the caller waits for all responses.
#[derive(Clone)]
pub struct Plain(Arc<Mutex<(TcpStream, Vec<u8>)>>);

impl Plain {
    pub async fn connect(address: SocketAddr) -> Self {
        let stream = TcpStream::connect(address).await.expect("connect");
        stream.set_nodelay(true).expect("nodelay");
        Self(Arc::new(Mutex::new((stream, vec![0; 256 * 1024]))))
    }

    pub async fn call(self, question: Question, batch: usize) -> usize {
        let mut guard = self.0.lock().await;
        let (stream, buffer) = &mut *guard;
        let (first, size) = sizes(question);
        let request = vec![first; REQUEST * batch];
        stream.write_all(&request).await.expect("write");
        let mut left = size * batch;
        while left > 0 {
            let read = stream.read(buffer).await.expect("read");
            assert!(read > 0, "the server closed");
            left -= read;
        }
        size * batch
    }
}
