//! Floors of a lone call with the wire format of fc. They are `raw` plus the work on each frame.
//!
//! `raw-md5` computes the four digests of a call and parses nothing. `raw-codec` reads and writes the frames with the
//! codec. It has no session, and therefore no table of calls, no new ids and no timeouts.

use super::peer::{Question, Serving, listen};
use fc_bench_cases::messages;
use fc_generated::{Fc, GetStationRequest, GetStationResponse, RequestEnvelope, ResponseEnvelope};
use fc_runtime::{
    Command as _, Decoder, Encoder, FrameId, Header as _, Message, Protocol, RequestEnvelope as _, read_enveloped,
};
use std::hint::black_box;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::Mutex;

/// Work on each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Compute the digest.
    Digest,
    /// Encode or decode the frame with the codec.
    Codec,
}

/// Length of a frame header, in bytes.
const HEADER: usize = <Fc as Protocol>::Header::LEN;

/// One side of a connection.
struct Side {
    work: Work,
    stream: TcpStream,
    input: Vec<u8>,
    output: Vec<u8>,
    decoder: Decoder<Fc>,
    encoder: Encoder<Fc>,
}

impl Side {
    fn new(work: Work, stream: TcpStream) -> Self {
        stream.set_nodelay(true).expect("nodelay");
        let (decoder, encoder) = (Decoder::new(), Encoder::new());
        Self { work, stream, input: vec![0; 64 * 1024], output: Vec::new(), decoder, encoder }
    }

    /// Sends a message. [`Work::Digest`] encodes only the first message and sends it again with a new digest.
    ///
    /// Returns `false` if the connection is closed.
    async fn send<E: Message, M: Message>(&mut self, id: FrameId, envelope: &E, message: &M) -> bool {
        match self.work {
            Work::Codec => {
                self.output.clear();
                self.encoder.message(&mut self.output, id, envelope, message).expect("it fits");
            }
            Work::Digest => {
                if self.output.is_empty() {
                    self.encoder.message(&mut self.output, id, envelope, message).expect("it fits");
                }
                let digest = fast_md5::digest(&self.output[HEADER..]);
                self.output[HEADER - digest.len()..HEADER].copy_from_slice(&digest);
            }
        }
        self.stream.write_all(&self.output).await.is_ok()
    }

    /// Receives a frame, which must arrive in one read. [`Work::Digest`] returns no message.
    async fn receive<E: Message, M: Message>(&mut self) -> Option<Received<M>> {
        let read = self.stream.read(&mut self.input).await.ok().filter(|read| *read > 0)?;
        let bytes = &self.input[..read];
        match self.work {
            Work::Codec => {
                self.decoder.push(bytes);
                let frame = self.decoder.next().expect("a sound frame").expect("a whole frame");
                let id = frame.id();
                let read = read_enveloped::<E, M>(frame.body(), Fc::DEFAULTS.limits.json());
                let message = read.expect("an envelope").body.expect("a message");
                Some(Received { id, message: Some(message) })
            }
            Work::Digest => {
                black_box(fast_md5::digest(&bytes[HEADER..]));
                Some(Received { id: messages::station_id(), message: None })
            }
        }
    }
}

struct Received<M> {
    id: FrameId,
    message: Option<M>,
}

/// Serves requests for stations.
pub async fn serve(work: Work) -> Serving {
    let (address, listener) = listen().await;
    let serving = async move {
        while let Ok((stream, _)) = listener.accept().await {
            tokio::spawn(async move {
                let mut side = Side::new(work, stream);
                while let Some(received) = side.receive::<RequestEnvelope, GetStationRequest>().await {
                    let station = received.message.map_or(1, |request| request.data.station_id);
                    let id = FrameId { response: true, ..received.id };
                    if !side.send(id, &messages::envelope(), &messages::small(station)).await {
                        return;
                    }
                }
            });
        }
    };
    (address, Box::pin(serving))
}

/// A connection for one caller at a time.
#[derive(Clone)]
pub struct Caller(Arc<Mutex<Side>>);

impl Caller {
    pub async fn connect(address: SocketAddr, work: Work) -> Self {
        let stream = TcpStream::connect(address).await.expect("connect");
        Self(Arc::new(Mutex::new(Side::new(work, stream))))
    }

    pub async fn call(self, question: Question) -> usize {
        assert_eq!(question, Question::Small, "the floor of a frame is that of a small one");
        let mut side = self.0.lock().await;
        let id = FrameId { response: false, kind: Fc::COMMAND, code: GetStationRequest::CODE, id: 90_842_323 };
        let envelope = RequestEnvelope::at(messages::TIME);
        assert!(side.send(id, &envelope, &messages::station_request()).await, "the server closed");
        let answer = side.receive::<ResponseEnvelope, GetStationResponse>().await.expect("an answer");
        answer.message.map_or(1, |station| station.data.station_name.len())
    }
}
