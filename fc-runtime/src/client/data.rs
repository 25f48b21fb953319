//! An app's connection to the data port.

use super::config::ClientConfig;
use super::connecting::connect;
use super::error::ConnectError;
use crate::frame::{Encoder, FrameId};
use crate::link::Transport;
use crate::protocol::Protocol;
use crate::rate::Least;
use crate::stream::{Patience, Receiver, Sender, StreamError, StreamFrame};
use std::fmt;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::Mutex;

type Read = Box<dyn AsyncRead + Send + Unpin>;
type Write = Box<dyn AsyncWrite + Send + Unpin>;

/// A connection to a robot's data port: frames of raw bytes in both directions.
///
/// Nothing is queued: a frame is read from the socket when it is asked for, and sending waits until
/// the socket has taken the frame. Receiving and sending do not wait for each other. The connection
/// is not made again after a loss, because nobody knows how much of a stream the robot would repeat.
pub struct DataConnection<P: Protocol> {
    receiver: Mutex<Receiver<Read, P>>,
    sender: Mutex<(Sender<Write>, Encoder<P>)>,
}

impl<P: Protocol> DataConnection<P> {
    /// Connects over TCP to the data port of `config`.
    ///
    /// # Errors
    ///
    /// [`ConnectError`].
    pub async fn connect(config: &ClientConfig) -> Result<Self, ConnectError> {
        let stream = connect(config.data_address::<P>(), config).await?;
        Ok(Self::over(stream, config))
    }

    /// A connection over a stream that exists already, such as TLS or a pipe in a test.
    pub fn over<S: Transport>(stream: S, config: &ClientConfig) -> Self {
        let (read, write) = tokio::io::split(stream);
        let stall = Some(Least::new(0, config.stall_timeout_value()));
        let patience = Patience {
            header: None,
            stall,
        };
        let receiver = Receiver::new(Box::new(read) as Read, config.decoder(), patience);
        let sender = Sender::new(Box::new(write) as Write, patience);
        Self {
            receiver: Mutex::new(receiver),
            sender: Mutex::new((sender, config.encoder())),
        }
    }

    /// The next frame; `None` once the robot has closed the connection.
    ///
    /// Cancellation safe: bytes that have arrived are kept for the next call.
    ///
    /// # Errors
    ///
    /// [`StreamError`]; unless it is fatal, the next call goes on with the next frame.
    pub async fn recv(&self) -> Result<Option<StreamFrame>, StreamError> {
        self.receiver.lock().await.recv().await
    }

    /// Sends a frame of raw bytes: `code` says what they belong to, `id` which request they answer
    /// or prepare.
    ///
    /// Cancellation: a frame that has been begun is finished by the next call.
    ///
    /// # Errors
    ///
    /// [`StreamError`].
    pub async fn send(&self, code: u16, id: u32, data: &[u8]) -> Result<(), StreamError> {
        let frame = FrameId {
            response: false,
            kind: P::STREAM,
            code,
            id,
        };
        let (sender, encoder) = &mut *self.sender.lock().await;
        sender.send(encoder, frame, data).await
    }

    /// Sends what is left and ends the connection.
    ///
    /// # Errors
    ///
    /// [`StreamError`].
    pub async fn close(self) -> Result<(), StreamError> {
        self.sender.lock().await.0.close().await
    }
}

impl<P: Protocol> fmt::Debug for DataConnection<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DataConnection").finish_non_exhaustive()
    }
}
