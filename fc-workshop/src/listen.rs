//! The listening sockets of a robot's ports.

use fc_spec::model::Text;
use fc_spec::{text, text_error};
use std::io;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::time::sleep;

/// The time before the next attempt to accept a connection.
const PAUSE: Duration = Duration::from_millis(100);

/// The reason why nothing listens.
#[derive(Debug)]
pub enum ListenError {
    /// An address is not available.
    Address {
        /// Address.
        address: String,
        /// Reason.
        error: io::Error,
    },
    /// The system gives no thread, timer or address.
    System(io::Error),
}

impl ListenError {
    /// Returns the message in both languages.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Address { address, error } => text!(
                "无法监听 {address}：{error}；换一个端口，0 表示任意空闲端口",
                "cannot listen on {address}: {error}; choose another port, or 0 for any free port"
            ),
            Self::System(error) => {
                text!("无法开始监听：{error}", "cannot start to listen: {error}")
            }
        }
    }
}

text_error!(ListenError);

/// The listening sockets of the command port and the data port.
#[derive(Debug)]
pub struct Listeners {
    pub(crate) commands: TcpListener,
    pub(crate) data: TcpListener,
}

impl Listeners {
    /// Listens on both ports; 0 is any free port.
    ///
    /// # Errors
    /// [`ListenError::Address`].
    pub async fn bind(host: &str, command_port: u16, data_port: u16) -> Result<Self, ListenError> {
        Ok(Self {
            commands: listen(host, command_port).await?,
            data: listen(host, data_port).await?,
        })
    }

    /// Returns the addresses of the command port and the data port.
    ///
    /// # Errors
    /// [`ListenError::System`].
    pub fn addresses(&self) -> Result<(SocketAddr, SocketAddr), ListenError> {
        let commands = self.commands.local_addr().map_err(ListenError::System)?;
        let data = self.data.local_addr().map_err(ListenError::System)?;
        Ok((commands, data))
    }
}

/// Waits for the next connection. Its small frames are sent at once.
///
/// An error, such as too many open files, may last, so the next attempt follows after a pause.
pub(crate) async fn accept(listener: &TcpListener) -> TcpStream {
    loop {
        match listener.accept().await {
            Ok((stream, _)) => {
                // Without it, small frames only travel later.
                let _ = stream.set_nodelay(true);
                return stream;
            }
            Err(_) => sleep(PAUSE).await,
        }
    }
}

async fn listen(host: &str, port: u16) -> Result<TcpListener, ListenError> {
    let bound = TcpListener::bind((host, port)).await;
    bound.map_err(|error| ListenError::Address {
        address: format!("{host}:{port}"),
        error,
    })
}
