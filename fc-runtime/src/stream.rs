//! Frames of raw bytes: the two halves of a data connection, for client and server.
//!
//! This module has no queues. The receiver reads from the socket on demand, and the sender waits until the socket has
//! taken the frame. So a slow reader slows the sender down, and memory does not grow.

use crate::content::StreamContent;
#[cfg(feature = "server")]
use crate::frame::Encoder;
use crate::frame::{Body, Decoder, FrameError, FrameId, LONG, Prepared};
use crate::json::{Allowance, BodyError};
#[cfg(feature = "server")]
use crate::link::FIRST;
use crate::link::poll_skip_to_end;
use crate::message::{Empty, read_enveloped};
use crate::protocol::{Protocol, ResponseEnvelope};
use crate::rate::{MinimumRate, RateMeter};
use crate::refusal::Refusal;
use crate::wire::Header;
use std::fmt;
use std::future::poll_fn;
use std::io::{self, IoSlice};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::task::yield_now;
use tokio::time::{Instant, timeout_at};

/// A frame of raw bytes.
#[derive(Clone, PartialEq, Eq)]
pub struct StreamFrame {
    /// Command code of the stream.
    pub code: u16,
    /// Message id of the request that asked for the bytes.
    pub id: u32,
    /// The bytes, decompressed.
    pub data: Body,
}

impl StreamFrame {
    /// Reads the content within this allowance.
    ///
    /// # Errors
    /// The error of the JSON. Raw bytes have no errors.
    pub fn read<T: StreamContent>(self, allowance: Allowance) -> Result<T, BodyError> {
        T::read(self.data, allowance)
    }
}

/// Shows only the length, because pictures and maps are not readable.
impl fmt::Debug for StreamFrame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("StreamFrame")
            .field("code", &format_args!("0x{:04X}", self.code))
            .field("id", &self.id)
            .field("bytes", &self.data.len())
            .finish()
    }
}

/// An error of a data connection.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StreamError {
    /// The connection broke.
    #[error("the data connection broke: {0}")]
    Io(#[from] io::Error),
    /// A frame could not be read, or is too long to be sent. The connection stays open, unless
    /// [`FrameError::is_fatal`].
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The peer refused a frame. The connection stays open.
    #[error("the peer has refused the {frame}: {refusal}")]
    Refused {
        /// The frame.
        frame: FrameId,
        /// The peer's answer.
        refusal: Refusal,
    },
    /// The received frame is not a stream frame. It was skipped, and the connection stays open.
    #[error("no stream: {0}")]
    Unexpected(FrameId),
    /// The peer stopped in the middle of a frame, or does not read.
    #[error("the peer has stalled")]
    Stalled,
}

impl StreamError {
    /// Returns the fixed name of the error.
    #[cfg(feature = "server")]
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Io(_) => "io",
            Self::Frame(error) => error.name(),
            Self::Refused { .. } => "refused",
            Self::Unexpected(_) => "unexpected_frame",
            Self::Stalled => "stalled",
        }
    }

    /// Returns `true` if the connection cannot be used any more.
    #[cfg(feature = "server")]
    pub(crate) fn is_fatal(&self) -> bool {
        match self {
            Self::Io(_) | Self::Stalled => true,
            Self::Frame(error) => error.is_fatal(),
            Self::Refused { .. } | Self::Unexpected(_) => false,
        }
    }

    /// Returns the skipped frame if it was a request, which may be answered.
    #[cfg(feature = "server")]
    pub(crate) fn answerable(&self) -> Option<FrameId> {
        match self {
            Self::Frame(error) => error.frame().filter(|frame| !frame.response),
            Self::Unexpected(frame) => Some(*frame).filter(|frame| !frame.response),
            _ => None,
        }
    }
}

/// Limits on waits in the middle of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Patience {
    /// Limit for a header, from its first byte on.
    pub(crate) header: Option<Duration>,
    /// Minimum rate in the middle of a frame, in both directions.
    pub(crate) stall: Option<MinimumRate>,
}

/// The receiving half.
#[derive(Debug)]
pub(crate) struct Receiver<R, P: Protocol> {
    read: R,
    decoder: Decoder<P>,
    patience: Patience,
    header_since: Option<Instant>,
    /// Time waited for the arriving frame since the last progress.
    waited: Duration,
    /// Bytes received since the last progress.
    gathered: usize,
    received: usize,
}

impl<R: AsyncRead + Unpin, P: Protocol> Receiver<R, P> {
    pub(crate) fn new(read: R, decoder: Decoder<P>, patience: Patience) -> Self {
        Self {
            read,
            decoder,
            patience,
            header_since: None,
            waited: Duration::ZERO,
            gathered: 0,
            received: 0,
        }
    }

    /// Returns the next frame, or `None` at the end. Cancellation safe.
    #[cfg(feature = "client")]
    pub(crate) async fn recv(&mut self) -> Result<Option<StreamFrame>, StreamError> {
        loop {
            if let Some(frame) = self.take()? {
                return Ok(Some(frame));
            }
            if self.fill().await? == 0 {
                self.decoder.finish()?;
                return Ok(None);
            }
        }
    }

    /// Reads the first bytes of a frame. No memory is reserved before bytes have arrived. Returns 0 at the end of the
    /// stream.
    #[cfg(feature = "server")]
    pub(crate) async fn begin(&mut self) -> io::Result<usize> {
        let mut first = [0; FIRST];
        let n = self.read.read(&mut first).await?;
        self.decoder.begin(first.get(..n).unwrap_or_default());
        self.header_since = None;
        self.waited = Duration::ZERO;
        self.gathered = 0;
        self.received += n;
        Ok(n)
    }

    /// Reads and drops everything up to the end of the stream.
    pub(crate) async fn skip_to_end(&mut self) -> io::Result<()> {
        poll_fn(|cx| poll_skip_to_end(&mut self.read, cx)).await
    }

    /// Returns the number of received bytes of the arriving frame, and its length if known.
    #[cfg(feature = "client")]
    pub(crate) fn arriving(&self) -> (usize, Option<usize>) {
        (self.decoder.pending(), self.decoder.expected())
    }

    /// Returns the number of bytes received since the last call.
    #[cfg(feature = "server")]
    pub(crate) fn take_received(&mut self) -> usize {
        std::mem::take(&mut self.received)
    }

    /// Returns the decoder, which holds the incomplete frame.
    #[cfg(feature = "server")]
    pub(crate) fn decoder(&mut self) -> &mut Decoder<P> {
        &mut self.decoder
    }

    /// Returns the next complete frame.
    pub(crate) fn take(&mut self) -> Result<Option<StreamFrame>, StreamError> {
        let Some(frame) = self.decoder.next()? else {
            return Ok(None);
        };
        self.waited = Duration::ZERO;
        self.gathered = 0;
        let id = frame.id();
        if id.kind != P::STREAM {
            return Err(StreamError::Unexpected(id));
        }
        if !id.response {
            return Ok(Some(StreamFrame {
                code: id.code,
                id: id.id,
                data: frame.into_body(),
            }));
        }
        let allowance = P::DEFAULTS.limits.json();
        let Ok(read) = read_enveloped::<P::Response, Empty>(frame.body(), allowance) else {
            return Err(StreamError::Unexpected(id));
        };
        Err(match read.envelope.result_code() {
            Some(code) => {
                let refusal = Refusal::new(code, read.envelope.result_text());
                StreamError::Refused { frame: id, refusal }
            }
            None => StreamError::Unexpected(id),
        })
    }

    /// Reads once. Returns 0 at the end of the stream.
    pub(crate) async fn fill(&mut self) -> Result<usize, StreamError> {
        let now = Instant::now();
        let pending = self.decoder.pending();
        if pending == 0 || pending >= P::Header::LEN {
            self.header_since = None;
        } else {
            self.header_since.get_or_insert(now);
        }
        let deadline = match (self.header_since, pending) {
            (_, 0) => None,
            (Some(since), _) => self
                .patience
                .header
                .and_then(|limit| since.checked_add(limit)),
            (None, _) => self
                .patience
                .stall
                .and_then(|least| now.checked_add(least.within.saturating_sub(self.waited))),
        };
        let waiting = Waiting {
            waited: &mut self.waited,
            since: now,
        };
        let read = self.read.read_buf(self.decoder.room());
        let n = until(deadline, read).await?;
        drop(waiting);
        self.received += n;
        self.gathered = self.gathered.saturating_add(n);
        let least = self.patience.stall.map_or(1, |least| least.bytes);
        if pending == 0 || self.gathered >= least {
            self.waited = Duration::ZERO;
            self.gathered = 0;
        }
        Ok(n)
    }
}

/// Waits for an operation of a socket, but not beyond `deadline`.
async fn until(
    deadline: Option<Instant>,
    operation: impl Future<Output = io::Result<usize>>,
) -> Result<usize, StreamError> {
    let done = match deadline {
        None => operation.await,
        Some(deadline) => timeout_at(deadline, operation)
            .await
            .map_err(|_| StreamError::Stalled)?,
    };
    Ok(done?)
}

/// Adds up the time of waiting, also of futures that are dropped. So an app that waits often for a short time waits as
/// long as an app that waits once. The time in between does not count.
struct Waiting<'a> {
    waited: &'a mut Duration,
    since: Instant,
}

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        *self.waited = self.waited.saturating_add(self.since.elapsed());
    }
}

/// Yields to other tasks after work on this many bytes.
#[cfg(feature = "client")]
pub(crate) async fn give_way(bytes: usize) {
    if bytes >= LONG {
        yield_now().await;
    }
}

/// Prepares a body, with pauses for other tasks.
#[cfg(feature = "server")]
pub(crate) async fn prepare<P: Protocol>(
    encoder: &mut Encoder<P>,
    data: &[u8],
) -> Result<Prepared, FrameError> {
    let mut body = encoder.begin(data.to_vec())?;
    while body.go_on(LONG) {
        yield_now().await;
    }
    Ok(body.finish())
}

/// The sending half.
#[derive(Debug)]
pub(crate) struct Sender<W> {
    write: W,
    out: Vec<u8>,
    /// Body after `out`.
    body: Option<Prepared>,
    /// Written bytes of both.
    written: usize,
    stall: Option<MinimumRate>,
    /// Rate of the frame that is being sent.
    flow: Option<RateMeter<Instant>>,
}

impl<W: AsyncWrite + Unpin> Sender<W> {
    pub(crate) fn new(write: W, patience: Patience) -> Self {
        Self {
            write,
            out: Vec::new(),
            body: None,
            written: 0,
            stall: patience.stall,
            flow: None,
        }
    }

    /// Sends a frame. If the future is dropped, the rest of the frame can still be flushed.
    #[cfg(feature = "client")]
    pub(crate) async fn send(&mut self, frame: Vec<u8>) -> Result<(), StreamError> {
        self.flush().await?;
        self.out = frame;
        self.flush().await?;
        self.out = Vec::new();
        Ok(())
    }

    /// Sends a frame with a prepared body without copying the body. Returns the number of bytes sent.
    #[cfg(feature = "server")]
    pub(crate) async fn send_prepared<P: Protocol>(
        &mut self,
        id: FrameId,
        data: &Prepared,
    ) -> Result<usize, StreamError> {
        self.flush().await?;
        data.header::<P>(&mut self.out, id);
        let length = self.out.len() + data.len();
        self.body = Some(data.clone());
        self.flush().await?;
        Ok(length)
    }

    /// Sends the rest.
    pub(crate) async fn flush(&mut self) -> Result<(), StreamError> {
        loop {
            let body = self.body.as_ref().map_or(&[][..], Prepared::data);
            let front = self.out.get(self.written..).unwrap_or_default();
            let back = self.written.saturating_sub(self.out.len());
            let back = body.get(back..).unwrap_or_default();
            if front.is_empty() && back.is_empty() {
                break;
            }
            if self.written > 0 {
                yield_now().await;
            }
            // Send bytes of the body only if the whole header fits.
            let room = LONG.saturating_sub(front.len());
            let piece = [
                IoSlice::new(front.get(..LONG).unwrap_or(front)),
                IoSlice::new(back.get(..room).unwrap_or(back)),
            ];
            let write = self.write.write_vectored(&piece);
            let n = match self.stall {
                None => write.await?,
                Some(least) => {
                    let flow = self.flow.get_or_insert(RateMeter::new(Instant::now()));
                    let n = until(flow.since.checked_add(least.within), write).await?;
                    flow.add(n, least.bytes, Instant::now());
                    n
                }
            };
            if n == 0 {
                return Err(io::Error::from(io::ErrorKind::WriteZero).into());
            }
            self.written += n;
        }
        self.out.clear();
        self.body = None;
        self.written = 0;
        self.flow = None;
        self.write.flush().await?;
        Ok(())
    }

    /// Sends the rest and closes the sending side.
    pub(crate) async fn close(&mut self) -> Result<(), StreamError> {
        self.flush().await?;
        Ok(self.write.shutdown().await?)
    }
}
