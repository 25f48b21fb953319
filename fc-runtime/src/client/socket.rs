//! The socket of a connection, which its driver shares with callers. A caller that finds nothing else to send writes
//! its request itself, without waiting for the driver.

use crate::frame::Decoder;
use crate::link::{Outlet, Transport, poll_read, poll_skip_to_end};
use crate::protocol::Protocol;
use crate::sync::lock;
use std::fmt;
use std::future::poll_fn;
use std::io;
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll};

struct Socket<S> {
    stream: S,
    outlet: Outlet,
    /// Error of a caller's write. After it, nothing may be written, because part of a frame may have been sent.
    broken: Option<io::Error>,
}

/// A socket that driver and callers share. Lock order: a holder of this lock may take the lock of the connection's
/// state. A holder of the state's lock may only try this one.
pub(super) struct Shared<S>(Arc<Mutex<Socket<S>>>);

impl<S> Shared<S> {
    /// The lock is held for one read or write. After a panic, the state of the stream is the stream's responsibility.
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

    /// Returns a handle for callers.
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

    /// Returns the number of unwritten bytes.
    pub(super) fn unwritten(&self) -> usize {
        self.lock().outlet.unwritten()
    }

    /// Writes everything, and asks `load` for more when all is written. Returns the number of unwritten bytes before
    /// and after.
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

    /// Writes everything, then `out`, closes the sending side and waits for the peer to close its side.
    pub(super) async fn goodbye(self, mut out: Vec<u8>) -> io::Result<()> {
        {
            let mut socket = self.lock();
            if let Some(error) = socket.broken.take() {
                return Err(error);
            }
            socket.outlet.load(&mut out);
        }
        poll_fn(|cx| {
            let Socket { stream, outlet, .. } = &mut *self.lock();
            outlet.poll_close(stream, cx)
        })
        .await?;
        poll_fn(|cx| poll_skip_to_end(&mut self.lock().stream, cx)).await
    }
}

/// The part of a socket that callers use.
trait Write: Send {
    /// Takes the bytes of `out` if everything is written.
    fn load(&mut self, out: &mut Vec<u8>) -> bool;

    /// Writes without waiting. Returns `true` if everything is written.
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

/// A socket with any stream.
#[derive(Clone)]
pub(super) struct CallersSocket(Arc<Mutex<dyn Write>>);

impl fmt::Debug for CallersSocket {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("CallersSocket")
    }
}

impl CallersSocket {
    /// Takes the bytes to be sent. Returns `None` if another task uses the socket or bytes are unwritten; the driver
    /// sends them in that case.
    pub(super) fn begin(&self, out: &mut Vec<u8>) -> Option<Writing<'_>> {
        let mut socket = self.0.try_lock().ok()?;
        socket.load(out).then_some(Writing(socket))
    }
}

/// Bytes of a caller in the send buffer.
#[must_use = "somebody has to write them"]
pub(super) struct Writing<'a>(MutexGuard<'a, dyn Write + 'static>);

impl Writing<'_> {
    /// Writes without waiting. Returns `true` if everything is written. Otherwise the driver sends the rest, or ends a
    /// broken connection.
    pub(super) fn finish(mut self, cx: &mut Context<'_>) -> bool {
        self.0.write(cx)
    }
}
