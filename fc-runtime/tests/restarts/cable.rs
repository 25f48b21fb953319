//! The network between an app and a robot. It or an end of the robot can vanish silently. As with TCP, both ends learn
//! after a minute that no data arrives.

use std::io::{Error, ErrorKind, Result};
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, Waker};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, DuplexStream, ReadBuf, duplex};
use tokio::time::sleep;

/// Capacity of one direction, in bytes.
const WINDOW: usize = 64 * 1024;
/// Silence after which both ends are told, like the default of keepalive.
const KEEPALIVE: Duration = Duration::from_secs(60);

#[derive(Default)]
struct State {
    silent: bool,
    /// Number of outages.
    silences: u32,
    /// The robot's machine knows nothing of the connection any more.
    forgotten: bool,
    error: Option<ErrorKind>,
    readers: [Option<Waker>; 2],
}

impl State {
    fn wake(&mut self) {
        for reader in self.readers.iter_mut().filter_map(Option::take) {
            reader.wake();
        }
    }

    fn fail(&mut self, error: ErrorKind) {
        self.error = Some(error);
        self.wake();
    }
}

/// One connection.
#[derive(Clone)]
pub struct Cable(Arc<Mutex<State>>);

impl Cable {
    /// A connection and its ends: app's, robot's.
    pub fn new() -> (Self, End, End) {
        let state = Arc::<Mutex<State>>::default();
        let (app, robot) = duplex(WINDOW);
        let end = |pipe, side| End {
            pipe,
            state: Arc::clone(&state),
            side,
        };
        (Self(Arc::clone(&state)), end(app, APP), end(robot, ROBOT))
    }

    fn change<T>(&self, change: impl FnOnce(&mut State) -> T) -> T {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Blocks all data from now on.
    pub fn fall_silent(&self) {
        let silence = self.change(|state| {
            state.silent = true;
            state.silences += 1;
            state.silences
        });
        let cable = self.clone();
        tokio::spawn(async move {
            sleep(KEEPALIVE).await;
            cable.change(|state| {
                if state.silent && state.silences == silence {
                    state.fail(ErrorKind::TimedOut);
                }
            });
        });
    }

    /// Delivers the held data, and all later data.
    pub fn go_on(&self) {
        self.change(|state| {
            state.silent = false;
            state.wake();
        });
    }

    /// The robot's machine has started again: it resets a connection that it does not know.
    pub fn forget(&self) {
        self.change(|state| state.forgotten = true);
    }
}

const APP: usize = 0;
const ROBOT: usize = 1;

/// One end of a connection.
pub struct End {
    pipe: DuplexStream,
    state: Arc<Mutex<State>>,
    side: usize,
}

impl AsyncRead for End {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<Result<()>> {
        let this = &mut *self;
        let mut state = this.state.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(error) = state.error {
            return Poll::Ready(Err(Error::from(error)));
        }
        state.readers[this.side] = Some(cx.waker().clone());
        if state.silent {
            return Poll::Pending;
        }
        Pin::new(&mut this.pipe).poll_read(cx, buf)
    }
}

impl AsyncWrite for End {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &[u8],
    ) -> Poll<Result<usize>> {
        let this = &mut *self;
        let mut state = this.state.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(error) = state.error {
            return Poll::Ready(Err(Error::from(error)));
        }
        if state.forgotten {
            // The first segment is taken, and answered with a reset.
            state.fail(ErrorKind::ConnectionReset);
            return Poll::Ready(Ok(buf.len()));
        }
        if state.silent {
            // As much as that is kept to be sent again.
            return match Pin::new(&mut this.pipe).poll_write(cx, buf) {
                Poll::Ready(Err(_)) => Poll::Ready(Ok(buf.len())),
                other => other,
            };
        }
        Pin::new(&mut this.pipe).poll_write(cx, buf)
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<()>> {
        Pin::new(&mut self.pipe).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<()>> {
        Pin::new(&mut self.pipe).poll_shutdown(cx)
    }
}
