//! The app side: calls a robot and receives its reports.

use crate::connection::{Connection, End, Event, NotSent};
use crate::facts;
use fc_reflect::{Frame, Reflector};
use fc_runtime::AckPolicy;
use fc_spec::model::Text;
use fc_spec::{text, text_error};
use std::collections::VecDeque;
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::time::{Instant, timeout, timeout_at};

/// The reason why there is no response.
#[derive(Debug)]
pub enum ClientError {
    /// The robot accepts no connection.
    Connect {
        /// Address.
        address: String,
        /// Reason.
        error: io::Error,
    },
    /// There is no response in time.
    Timeout(Duration),
    /// The robot sends nothing for this time.
    Silence(Duration),
    /// The connection has ended.
    Ended(End),
    /// The request was not sent.
    NotSent(NotSent),
}

impl ClientError {
    /// Returns `true` if the connection has ended.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        matches!(self, Self::Ended(_))
    }

    /// Returns the message in both languages.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Connect { address, error } => text!(
                "无法连接 {address}：{error}；检查地址，或先启动机器人",
                "cannot connect to {address}: {error}; check the address, or start the robot first"
            ),
            Self::Timeout(wait) => {
                let wait = wait.as_millis();
                text!(
                    "{wait} ms 内没有响应；可用 --timeout 延长",
                    "no response within {wait} ms; wait longer with --timeout"
                )
            }
            Self::Silence(wait) => {
                let wait = wait.as_millis();
                text!(
                    "{wait} ms 内机器人没有发送",
                    "the robot has sent nothing for {wait} ms"
                )
            }
            Self::Ended(End::Closed) => {
                text!("机器人断开了连接", "the robot closed the connection")
            }
            Self::Ended(End::Frame(error)) => text!(
                "机器人发来的字节不是帧：{error}；检查端口和规范的帧格式",
                "the robot sent bytes that are no frame: {error}; check the port and the frame of the spec"
            ),
            Self::Ended(End::Io(error)) => {
                text!("连接出错：{error}", "the connection failed: {error}")
            }
            Self::NotSent(error) => text!("没有发送：{error}", "not sent: {error}"),
        }
    }
}

text_error!(ClientError);

/// A client of a robot.
pub struct Client<'m> {
    connection: Connection<'m, TcpStream, ()>,
    /// Reports that have arrived during calls, oldest first.
    reports: VecDeque<Frame<'m>>,
    /// The maximum number of waiting reports.
    most_reports: usize,
}

impl<'m> Client<'m> {
    /// Connects to a robot.
    ///
    /// # Errors
    /// [`ClientError::Connect`].
    pub async fn connect(
        reflector: &'m Reflector<'m>,
        address: &str,
        wait: Duration,
    ) -> Result<Self, ClientError> {
        let connected = timeout(wait, TcpStream::connect(address)).await;
        let connected = connected.unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into()));
        let stream = connected.and_then(|stream| {
            stream.set_nodelay(true)?;
            Ok(stream)
        });
        let stream = stream.map_err(|error| ClientError::Connect {
            address: address.to_owned(),
            error,
        })?;
        Ok(Self {
            connection: Connection::new(reflector, stream, facts::first_id()),
            reports: VecDeque::new(),
            most_reports: facts::limits(reflector.model()).queued_reports,
        })
    }

    /// Sends a command with this data and waits for the response.
    ///
    /// # Errors
    /// [`ClientError`] if there is no response in time.
    pub async fn call(
        &mut self,
        kind: u8,
        code: u16,
        data: Arc<[u8]>,
        wait: Duration,
    ) -> Result<Frame<'m>, ClientError> {
        let policy = AckPolicy {
            timeout: wait,
            retries: 0,
        };
        let sent = self.connection.request(kind, code, &data, policy, ());
        sent.map_err(ClientError::NotSent)?;
        loop {
            match self.connection.next().await {
                Event::Answer((), frame) => return Ok(frame),
                Event::Expired(()) => return Err(ClientError::Timeout(wait)),
                other => self.take(other)?,
            }
        }
    }

    /// Waits for the next report and acknowledges it.
    ///
    /// # Errors
    /// [`ClientError`] if none arrives in time.
    pub async fn report(&mut self, wait: Duration) -> Result<Frame<'m>, ClientError> {
        let end = Instant::now().checked_add(wait);
        loop {
            if let Some(report) = self.reports.pop_front() {
                return Ok(report);
            }
            let next = self.connection.next();
            let event = match end {
                Some(end) => timeout_at(end, next)
                    .await
                    .map_err(|_| ClientError::Silence(wait))?,
                None => next.await,
            };
            self.take(event)?;
        }
    }

    /// Waits for the next frame of a stream.
    ///
    /// # Errors
    /// [`ClientError`] if none arrives in time.
    pub async fn stream_frame(&mut self, wait: Duration) -> Result<Frame<'m>, ClientError> {
        let arrived = timeout(wait, async {
            loop {
                match self.connection.next().await {
                    Event::Stream(frame) => return Ok(frame),
                    other => self.take(other)?,
                }
            }
        });
        arrived.await.map_err(|_| ClientError::Silence(wait))?
    }

    /// Sends a whole frame, and closes the connection behind it.
    ///
    /// # Errors
    /// [`ClientError::Ended`].
    pub async fn send(&mut self, frame: &[u8]) -> Result<(), ClientError> {
        self.connection.send(frame);
        self.finish().await
    }

    /// Writes the last acknowledgements, and closes the connection.
    ///
    /// # Errors
    /// [`ClientError::Ended`].
    pub async fn close(mut self) -> Result<(), ClientError> {
        self.finish().await
    }

    async fn finish(&mut self) -> Result<(), ClientError> {
        let finished = self.connection.finish().await;
        finished.map_err(|error| ClientError::Ended(End::Io(error)))
    }

    /// Handles an event that no call waits for.
    fn take(&mut self, event: Event<'m, ()>) -> Result<(), ClientError> {
        match event {
            Event::Report(frame) => {
                self.connection.acknowledge(&frame);
                if self.reports.len() >= self.most_reports {
                    self.reports.pop_front();
                }
                self.reports.push_back(frame);
                Ok(())
            }
            Event::Ended(end) => Err(ClientError::Ended(end)),
            Event::Answer(..)
            | Event::Expired(())
            | Event::Late(_)
            | Event::Command(_)
            | Event::Stream(_)
            | Event::Invalid(..) => Ok(()),
        }
    }
}
