//! A connection's socket, which its driver shares with callers: one that finds nothing else to be sent
//! writes by itself, and its request does not wait until the driver has its turn.

use crate::frame::Decoder;
use crate::link::{Outlet, Transport, poll_read};
use crate::protocol::Protocol;
use crate::sync::lock;
use std::fmt;
use std::io;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

struct Socket<S> {
    stream: S,
    outlet: Outlet,
    /// What a caller has met with. Nothing may be written after that: who knows what has left already?
    broken: Option<io::Error>,
}

/// A socket that driver and callers share. Who has its lock may take the lock of the connection's state;
/// who has that may only try for the socket's.
pub(super) struct Shared<S>(Arc<Mutex<Socket<S>>>);

impl<S> Shared<S> {
    /// Held for one read or write. What a panic in there has left behind is the stream's own affair.
    fn lock(&self) -> MutexGuard<'_, Socket<S>> {
        lock(&self.0)
    }
}

impl<S: Transport> Shared<S> {
    pub(super) fn new(stream: S) -> Self {
        Self(Arc::new(Mutex::new(Socket {
            stream,
            outlet: Outlet::default(),
            broken: None,
        })))
    }

    /// For callers.
    pub(super) fn for_callers(&self) -> CallersSocket {
        CallersSocket(Arc::clone(&self.0) as _)
    }

    /// Reads once into the decoder; 0 at the end of the stream.
    pub(super) fn poll_read<P: Protocol>(
        &self,
        decoder: &mut Decoder<P>,
        cx: &mut Context<'_>,
    ) -> Poll<io::Result<usize>> {
        poll_read(&mut self.lock().stream, decoder, cx)
    }

    /// How much is still to be written, in bytes.
    pub(super) fn unwritten(&self) -> usize {
        self.lock().outlet.unwritten()
    }

    /// Writes all there is, and what `load` has for the outlet whenever that is empty; ready once nothing
    /// is left. Says how much there was to be written before, and how much there is now, in bytes.
    pub(super) fn write(
        &self,
        cx: &mut Context<'_>,
        mut load: impl FnMut(&mut Outlet),
    ) -> io::Result<(usize, usize)> {
        let mut socket = self.lock();
        let Socket {
            stream,
            outlet,
            broken,
        } = &mut *socket;
        if let Some(error) = broken.take() {
            return Err(error);
        }
        load(outlet);
        let before = outlet.unwritten();
        while let Poll::Ready(written) = outlet.poll_write(stream, cx) {
            written?;
            load(outlet);
            if outlet.unwritten() == 0 {
                break;
            }
        }
        Ok((before, outlet.unwritten()))
    }

    /// Says goodbye to the peer once all has been written, `out` as the last, and waits for its own.
    pub(super) async fn goodbye(mut self, mut out: Vec<u8>) -> io::Result<()> {
        let (mut outlet, broken) = {
            let mut socket = self.lock();
            (std::mem::take(&mut socket.outlet), socket.broken.take())
        };
        if let Some(error) = broken {
            return Err(error);
        }
        outlet.load(&mut out);
        outlet.goodbye(&mut self).await
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Shared<S> {
    fn poll_read(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.lock().stream).poll_read(cx, buf)
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Shared<S> {
    fn poll_write(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.lock().stream).poll_write(cx, bytes)
    }

    fn poll_flush(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.lock().stream).poll_flush(cx)
    }

    fn poll_shutdown(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.lock().stream).poll_shutdown(cx)
    }
}

/// What callers know of a socket.
trait Write: Send {
    /// Takes over what is in `out`, if nothing is left to be written.
    fn load(&mut self, out: &mut Vec<u8>) -> bool;

    /// Writes what the stream takes at once. Whether that was all of it.
    fn write(&mut self, cx: &mut Context<'_>) -> bool;
}

impl<S: Transport> Write for Socket<S> {
    fn load(&mut self, out: &mut Vec<u8>) -> bool {
        let may = self.outlet.unwritten() == 0 && self.broken.is_none();
        if may {
            self.outlet.load(out);
        }
        may
    }

    fn write(&mut self, cx: &mut Context<'_>) -> bool {
        match self.outlet.poll_write(&mut self.stream, cx) {
            Poll::Ready(Ok(())) => true,
            Poll::Ready(Err(error)) => {
                self.broken = Some(error);
                false
            }
            Poll::Pending => false,
        }
    }
}

/// A socket whose stream may be of any type.
#[derive(Clone)]
pub(super) struct CallersSocket(Arc<Mutex<dyn Write>>);

impl fmt::Debug for CallersSocket {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("CallersSocket")
    }
}

impl CallersSocket {
    /// Takes over what is to be sent, unless somebody else is reading or writing at this moment or something
    /// is left to be written: then it is the driver's.
    pub(super) fn begin(&self, out: &mut Vec<u8>) -> Option<Writing<'_>> {
        let mut socket = self.0.try_lock().ok()?;
        socket.load(out).then_some(Writing(socket))
    }
}

/// The bytes of a caller, in the outlet.
#[must_use = "somebody has to write them"]
pub(super) struct Writing<'a>(MutexGuard<'a, dyn Write + 'static>);

impl Writing<'_> {
    /// Writes what the stream takes at once. Whether that was all of it: the driver sends the rest, or ends
    /// the connection if it broke.
    pub(super) fn finish(mut self, cx: &mut Context<'_>) -> bool {
        self.0.write(cx)
    }
}
