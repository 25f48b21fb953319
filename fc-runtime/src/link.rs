//! A connection: a stream, its decoder and its send buffer.

use crate::frame::Decoder;
use crate::protocol::Protocol;
use socket2::{SockRef, TcpKeepalive};
#[cfg(feature = "server")]
use std::future::poll_fn;
use std::io;
#[cfg(feature = "server")]
use std::mem::MaybeUninit;
use std::pin::{Pin, pin};
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;

/// Longest time for a closing connection to send the rest and to receive the end of the stream.
pub(crate) const CLOSING: Duration = Duration::from_secs(1);
/// Memory that an empty buffer may keep for the next frames, in bytes.
const KEEP: usize = 2 * 1024 * 1024;

/// Bytes read before memory is reserved. Most requests are not longer.
#[cfg(feature = "server")]
pub(crate) const FIRST: usize = 1024;

/// Configures a TCP connection: small frames are sent at once, and a vanished peer is detected.
pub(crate) fn prepare(stream: &TcpStream, keepalive: Option<Duration>) -> io::Result<()> {
    stream.set_nodelay(true)?;
    if let Some(silence) = keepalive {
        let probes = TcpKeepalive::new()
            .with_time(silence)
            .with_interval((silence / 3).max(Duration::from_secs(1)));
        let socket = SockRef::from(stream);
        socket.set_tcp_keepalive(&probes)?;
        // Keepalive works only while no data is unacknowledged. This covers the other case, which would take a quarter
        // of an hour otherwise.
        #[cfg(any(target_os = "android", target_os = "linux"))]
        socket.set_tcp_user_timeout(Some(silence.saturating_mul(2)))?;
    }
    Ok(())
}

/// A byte stream for a connection: TCP, TLS on top of it, or a pipe in a test.
pub trait Transport: AsyncRead + AsyncWrite + Send + Unpin + 'static {}

impl<S: AsyncRead + AsyncWrite + Send + Unpin + 'static> Transport for S {}

/// Bytes to be written to a stream.
#[derive(Debug, Default)]
pub(crate) struct Outlet {
    out: Vec<u8>,
    written: usize,
}

impl Outlet {
    /// Returns the number of unwritten bytes.
    pub(crate) fn unwritten(&self) -> usize {
        self.out.len() - self.written
    }

    /// If everything has been written, takes the bytes of `out`. The buffers are swapped, so that both keep their
    /// memory.
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

    /// Writes all bytes. Ready when none are left.
    pub(crate) fn poll_write(
        &mut self,
        stream: &mut (impl AsyncWrite + Unpin),
        cx: &mut Context<'_>,
    ) -> Poll<io::Result<()>> {
        self.poll_some(stream, cx, usize::MAX)
    }

    /// Writes up to `most` bytes. Ready when they or all bytes are written.
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

    /// Writes everything and closes the sending side.
    pub(crate) fn poll_close(
        &mut self,
        stream: &mut (impl AsyncWrite + Unpin),
        cx: &mut Context<'_>,
    ) -> Poll<io::Result<()>> {
        ready!(self.poll_write(stream, cx))?;
        Pin::new(stream).poll_shutdown(cx)
    }
}

/// Reads once into the decoder. Returns 0 at the end of the stream.
pub(crate) fn poll_read<P: Protocol>(
    stream: &mut (impl AsyncRead + Unpin),
    decoder: &mut Decoder<P>,
    cx: &mut Context<'_>,
) -> Poll<io::Result<usize>> {
    let read = stream.read_buf(decoder.room());
    let mut read = pin!(read);
    Future::poll(read.as_mut(), cx)
}

/// A stream with its decoder and send buffer, owned by one task.
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

    /// Reads once into the decoder. Returns 0 at the end of the stream.
    pub(crate) fn poll_read(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<usize>> {
        poll_read(&mut self.stream, &mut self.decoder, cx)
    }

    /// Reads once into a bare decoder. No memory is reserved before bytes have arrived.
    pub(crate) fn poll_begin(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<usize>> {
        let mut first = [const { MaybeUninit::uninit() }; FIRST];
        let mut first = ReadBuf::uninit(&mut first);
        ready!(Pin::new(&mut self.stream).poll_read(cx, &mut first))?;
        self.decoder.begin(first.filled());
        Poll::Ready(Ok(first.filled().len()))
    }

    /// Returns the number of unwritten bytes.
    pub(crate) fn unwritten(&self) -> usize {
        self.outlet.unwritten()
    }

    /// Returns the memory of the send buffer, in bytes.
    pub(crate) fn capacity(&self) -> usize {
        self.outlet.out.capacity()
    }

    /// Releases unused memory.
    pub(crate) fn tidy(&mut self) {
        self.decoder.tidy();
        if self.outlet.unwritten() == 0 {
            self.outlet = Outlet::default();
        }
    }

    /// If everything has been written, takes the bytes of `out`.
    pub(crate) fn load(&mut self, out: &mut Vec<u8>) {
        self.outlet.load(out);
    }

    /// Writes up to `most` bytes. Ready when they or all bytes are written.
    pub(crate) fn poll_write(&mut self, cx: &mut Context<'_>, most: usize) -> Poll<io::Result<()>> {
        self.outlet.poll_some(&mut self.stream, cx, most)
    }

    /// Writes everything, closes the sending side and waits for the peer to close its side.
    pub(crate) async fn goodbye(&mut self) -> io::Result<()> {
        poll_fn(|cx| self.outlet.poll_close(&mut self.stream, cx)).await?;
        poll_fn(|cx| poll_skip_to_end(&mut self.stream, cx)).await
    }
}

/// Reads and drops everything up to the end. A socket that is closed with unread data is reset, and the peer then loses
/// what it has not read yet.
pub(crate) fn poll_skip_to_end(
    stream: &mut (impl AsyncRead + Unpin),
    cx: &mut Context<'_>,
) -> Poll<io::Result<()>> {
    let mut room = [0; 4096];
    loop {
        let mut unread = ReadBuf::new(&mut room);
        ready!(Pin::new(&mut *stream).poll_read(cx, &mut unread))?;
        if unread.filled().is_empty() {
            return Poll::Ready(Ok(()));
        }
    }
}
