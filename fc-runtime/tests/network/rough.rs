//! A real connection that is treated roughly: it writes in bits and breaks off in the middle.

use super::random::Random;
use std::io::{Error, ErrorKind, Result};
use std::pin::Pin;
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

/// Transport of an app's connection.
pub trait Both: AsyncRead + AsyncWrite + Send + Unpin {}

impl<S: AsyncRead + AsyncWrite + Send + Unpin> Both for S {}

pub struct Rough {
    pub stream: Box<dyn Both>,
    pub random: Random,
    /// Bytes until it breaks, if it does.
    pub left: Option<usize>,
}

impl Rough {
    fn spend(&mut self, bytes: usize) -> Result<()> {
        match &mut self.left {
            Some(left) if *left < bytes => Err(Error::from(ErrorKind::ConnectionReset)),
            Some(left) => {
                *left -= bytes;
                Ok(())
            }
            None => Ok(()),
        }
    }
}

impl AsyncRead for Rough {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<Result<()>> {
        let before = buf.filled().len();
        let read = Pin::new(&mut self.stream).poll_read(cx, buf);
        match read {
            Poll::Ready(Ok(())) => Poll::Ready(self.spend(buf.filled().len() - before)),
            other => other,
        }
    }
}

impl AsyncWrite for Rough {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &[u8],
    ) -> Poll<Result<usize>> {
        let this = &mut *self;
        let bits = this.random.one_in(2);
        let n = if bits {
            1 + this.random.below(buf.len())
        } else {
            buf.len()
        };
        match Pin::new(&mut this.stream).poll_write(cx, &buf[..n]) {
            Poll::Ready(Ok(n)) => Poll::Ready(this.spend(n).map(|()| n)),
            other => other,
        }
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
