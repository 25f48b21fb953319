//! One connection's bytes: a stream, the decoder behind it and the outlet in front of it.

use crate::frame::Decoder;
use crate::protocol::Protocol;
use socket2::{SockRef, TcpKeepalive};
use std::io;
use std::pin::{Pin, pin};
use std::task::{Context, Poll, ready};
use std::time::Duration;
#[cfg(feature = "server")]
use tokio::io::ReadBuf;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite};
use tokio::net::TcpStream;

/// How long a closing connection tries to send what is left, and waits for the peer's goodbye.
pub(crate) const CLOSING: Duration = Duration::from_secs(1);
/// Memory an emptied buffer may keep for what is sent next, in bytes.
const KEEP: usize = 2 * 1024 * 1024;

/// How much of a frame is read before there is memory for more, in bytes: most requests as a whole.
#[cfg(feature = "server")]
pub(crate) const FIRST: usize = 1024;

/// Sets up a TCP connection: small frames leave at once, and a peer that is gone without a word is
/// noticed.
pub(crate) fn prepare(stream: &TcpStream, keepalive: Option<Duration>) -> io::Result<()> {
    stream.set_nodelay(true)?;
    if let Some(silence) = keepalive {
        let probes = TcpKeepalive::new()
            .with_time(silence)
            .with_interval((silence / 3).max(Duration::from_secs(1)));
        let socket = SockRef::from(stream);
        socket.set_tcp_keepalive(&probes)?;
        // Keepalive asks only while nothing is on its way; this bounds the other case, which would
        // take a quarter of an hour otherwise.
        #[cfg(any(target_os = "android", target_os = "linux"))]
        socket.set_tcp_user_timeout(Some(silence.saturating_mul(2)))?;
    }
    Ok(())
}

/// What a connection runs over: TCP, TLS on top of it, or a pipe in a test.
pub trait Transport: AsyncRead + AsyncWrite + Send + Unpin + 'static {}

impl<S: AsyncRead + AsyncWrite + Send + Unpin + 'static> Transport for S {}

/// What is to be written to a stream, in front of it.
#[derive(Debug, Default)]
pub(crate) struct Outlet {
    out: Vec<u8>,
    written: usize,
}

impl Outlet {
    /// How much is still to be written, in bytes.
    pub(crate) fn unwritten(&self) -> usize {
        self.out.len() - self.written
    }

    /// Takes over what is in `out`, if the last has been written: the buffers change places, so
    /// that both keep their memory.
    pub(crate) fn load(&mut self, out: &mut Vec<u8>) {
        if self.unwritten() == 0 && !out.is_empty() {
            self.out.clear();
            self.written = 0;
            if self.out.capacity() > KEEP {
                self.out = Vec::new();
            }
            std::mem::swap(&mut self.out, out);
        }
    }

    /// Writes all that has been loaded; ready once nothing is left.
    pub(crate) fn poll_write(
        &mut self,
        stream: &mut (impl AsyncWrite + Unpin),
        cx: &mut Context<'_>,
    ) -> Poll<io::Result<()>> {
        self.poll_some(stream, cx, usize::MAX)
    }

    /// Writes at most so many bytes of what has been loaded; ready once they or all are written.
    fn poll_some(
        &mut self,
        stream: &mut (impl AsyncWrite + Unpin),
        cx: &mut Context<'_>,
        mut most: usize,
    ) -> Poll<io::Result<()>> {
        while let Some(rest) = self.out.get(self.written..)
            && let rest = rest.get(..most).unwrap_or(rest)
            && !rest.is_empty()
        {
            let n = ready!(Pin::new(&mut *stream).poll_write(cx, rest))?;
            if n == 0 {
                return Poll::Ready(Err(io::ErrorKind::WriteZero.into()));
            }
            self.written += n;
            most = most.saturating_sub(n);
        }
        Pin::new(stream).poll_flush(cx)
    }

    /// Says goodbye to the peer once all has been written, and waits for its own.
    pub(crate) async fn goodbye(
        &mut self,
        stream: &mut (impl AsyncRead + AsyncWrite + Unpin),
    ) -> io::Result<()> {
        std::future::poll_fn(|cx| {
            ready!(self.poll_write(stream, cx))?;
            Pin::new(&mut *stream).poll_shutdown(cx)
        })
        .await?;
        skip_to_end(stream).await
    }
}

/// Reads once into the decoder; 0 at the end of the stream.
pub(crate) fn poll_read<P: Protocol>(
    stream: &mut (impl AsyncRead + Unpin),
    decoder: &mut Decoder<P>,
    cx: &mut Context<'_>,
) -> Poll<io::Result<usize>> {
    let read = stream.read_buf(decoder.room());
    let mut read = pin!(read);
    Future::poll(read.as_mut(), cx)
}

/// A stream with one owner, the decoder behind it and the outlet in front of it.
#[cfg(feature = "server")]
#[derive(Debug)]
pub(crate) struct Link<S, P: Protocol> {
    stream: S,
    pub(crate) decoder: Decoder<P>,
    outlet: Outlet,
}

#[cfg(feature = "server")]
impl<S: Transport, P: Protocol> Link<S, P> {
    pub(crate) fn new(stream: S, decoder: Decoder<P>) -> Self {
        Self {
            stream,
            decoder,
            outlet: Outlet::default(),
        }
    }

    /// Reads once into the decoder; 0 at the end of the stream.
    pub(crate) fn poll_read(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<usize>> {
        poll_read(&mut self.stream, &mut self.decoder, cx)
    }

    /// The same for a decoder that is bare: until something has come, no memory is needed for it.
    pub(crate) fn poll_begin(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<usize>> {
        let mut first = [0; FIRST];
        let mut first = ReadBuf::new(&mut first);
        ready!(Pin::new(&mut self.stream).poll_read(cx, &mut first))?;
        self.decoder.begin(first.filled());
        Poll::Ready(Ok(first.filled().len()))
    }

    /// How much is still to be written, in bytes.
    pub(crate) fn unwritten(&self) -> usize {
        self.outlet.unwritten()
    }

    /// Memory of the buffer in front of the stream, in bytes.
    pub(crate) fn capacity(&self) -> usize {
        self.outlet.out.capacity()
    }

    /// Gives back the memory that is not needed at this moment.
    pub(crate) fn tidy(&mut self) {
        self.decoder.tidy();
        if self.outlet.unwritten() == 0 {
            self.outlet = Outlet::default();
        }
    }

    /// Takes over what is in `out`, if the last has been written.
    pub(crate) fn load(&mut self, out: &mut Vec<u8>) {
        self.outlet.load(out);
    }

    /// Writes at most so many bytes of what has been loaded; ready once they or all are written.
    pub(crate) fn poll_write(&mut self, cx: &mut Context<'_>, most: usize) -> Poll<io::Result<()>> {
        self.outlet.poll_some(&mut self.stream, cx, most)
    }

    /// Says goodbye to the peer once all has been written, and waits for its own.
    pub(crate) async fn goodbye(&mut self) -> io::Result<()> {
        self.outlet.goodbye(&mut self.stream).await
    }
}

/// Reads on to the end: a socket that is closed while something is unread is reset, and what the peer has
/// not read yet is lost to it.
pub(crate) async fn skip_to_end(stream: &mut (impl AsyncRead + Unpin)) -> io::Result<()> {
    let mut unread = [0; 4096];
    while stream.read(&mut unread).await? > 0 {}
    Ok(())
}
