//! Peer `fc-naive`: a simple hand-written version of the protocol.
//!
//! It has a task per request, a write per frame, `md-5`, `serde_json`, and a map of oneshots.

use super::peer::{Question, Serving, listen};
use crate::codec::reference::{Large, Reference, Small};
use fc_bench_cases::messages;
use fc_generated::Fc;
use fc_runtime::Protocol as _;
use md5::{Digest as _, Md5};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWriteExt as _, BufReader};
use tokio::net::TcpStream;
use tokio::sync::{mpsc, oneshot};

const HEADER: usize = 35;
const STATION: u16 = 1;
const MAP: u16 = 2;

struct Frame {
    code: u16,
    id: u32,
    body: Vec<u8>,
}

fn pack(code: u16, id: u32, body: &[u8]) -> Vec<u8> {
    let length = u32::try_from(HEADER + body.len()).expect("a short frame");
    let mut out = [Fc::REQUEST_HEAD, &[Fc::COMMAND]].concat();
    out.extend(code.to_be_bytes());
    out.extend(id.to_be_bytes());
    out.extend([0, 0]);
    out.extend(length.to_be_bytes());
    out.extend((length - HEADER as u32).to_be_bytes());
    out.extend(Md5::digest(body));
    out.extend(body);
    out
}

async fn read(stream: &mut (impl AsyncRead + Unpin)) -> Option<Frame> {
    let mut header = [0; HEADER];
    stream.read_exact(&mut header).await.ok()?;
    let number = |at: usize| u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
    let mut body = vec![0; number(11) as usize - HEADER];
    stream.read_exact(&mut body).await.ok()?;
    assert!(Md5::digest(&body)[..] == header[19..], "the digest is wrong");
    Some(Frame { code: u16::from_be_bytes([header[3], header[4]]), id: number(5), body })
}

/// Starts a task that writes the frames of a channel.
fn writer(mut stream: impl tokio::io::AsyncWrite + Send + Unpin + 'static) -> mpsc::UnboundedSender<Vec<u8>> {
    let (sender, mut frames) = mpsc::unbounded_channel::<Vec<u8>>();
    tokio::spawn(async move {
        while let Some(frame) = frames.recv().await {
            if stream.write_all(&frame).await.is_err() || stream.flush().await.is_err() {
                return;
            }
        }
    });
    sender
}

pub async fn serve() -> Serving {
    let (address, listener) = listen().await;
    let map = Arc::new(messages::large());
    let serving = async move {
        while let Ok((stream, _)) = listener.accept().await {
            let _ = stream.set_nodelay(true);
            let (reader, sink) = stream.into_split();
            let answers = writer(sink);
            let map = Arc::clone(&map);
            tokio::spawn(async move {
                let mut reader = BufReader::new(reader);
                while let Some(frame) = read(&mut reader).await {
                    let answers = answers.clone();
                    let map = Arc::clone(&map);
                    tokio::spawn(async move {
                        let request: Value = serde_json::from_slice(&frame.body).expect("a request");
                        let body = if frame.code == STATION {
                            let station = request["data"]["stationId"].as_i64().unwrap_or(0);
                            serde_json::to_vec(&Small::of(&messages::small(station)))
                        } else {
                            serde_json::to_vec(&Large::of(&map))
                        };
                        let _ = answers.send(pack(frame.code, frame.id, &body.expect("it can be written")));
                    });
                }
            });
        }
    };
    (address, Box::pin(serving))
}

type Pending = Arc<Mutex<HashMap<u32, oneshot::Sender<Vec<u8>>>>>;

#[derive(Clone)]
pub struct Connection {
    requests: mpsc::UnboundedSender<Vec<u8>>,
    pending: Pending,
    next: Arc<AtomicU32>,
}

pub async fn connect(address: SocketAddr) -> Connection {
    let stream = TcpStream::connect(address).await.expect("connect");
    stream.set_nodelay(true).expect("nodelay");
    let (reader, sink) = stream.into_split();
    let pending = Pending::default();
    let waiting = Arc::clone(&pending);
    tokio::spawn(async move {
        let mut reader = BufReader::new(reader);
        while let Some(frame) = read(&mut reader).await {
            if let Some(call) = waiting.lock().expect("lock").remove(&frame.id) {
                let _ = call.send(frame.body);
            }
        }
    });
    Connection { requests: writer(sink), pending, next: Arc::default() }
}

pub async fn call(connection: Connection, question: Question) -> usize {
    let (code, body) = match question {
        Question::Small => (STATION, json!({ "cmdTime": messages::TIME, "data": { "stationId": messages::STATION } })),
        Question::Large => (MAP, json!({ "cmdTime": messages::TIME, "mapId": messages::STATION })),
    };
    let id = connection.next.fetch_add(1, Ordering::Relaxed);
    let (done, answer) = oneshot::channel();
    connection.pending.lock().expect("lock").insert(id, done);
    let frame = pack(code, id, &serde_json::to_vec(&body).expect("it can be written"));
    connection.requests.send(frame).expect("the connection is gone");
    let answer = tokio::time::timeout(Duration::from_secs(3), answer).await;
    let body = answer.expect("in time").expect("the connection is gone");
    match question {
        Question::Small => serde_json::from_slice::<Small>(&body).expect("answer").name_length(),
        Question::Large => serde_json::from_slice::<Large>(&body).expect("answer").picture_length(),
    }
}
