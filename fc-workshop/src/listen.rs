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
    /// The system allows too few open files for so many robots.
    OpenFiles {
        /// Number of robots.
        robots: u16,
        /// The number of files that they need.
        needed: u64,
        /// The number that the system allows.
        allowed: u64,
    },
    /// The system gives no thread, timer, address or limit.
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
            Self::OpenFiles {
                robots,
                needed,
                allowed,
            } => text!(
                "{robots} 台机器人需要打开 {needed} 个文件，系统允许 {allowed} 个；提高上限（`ulimit -Hn`），或减小 --count",
                "{robots} robots need {needed} open files, and the system allows {allowed}; raise the limit (`ulimit -Hn`), or lower --count"
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

    /// Listens on free ports for a number of robots. Raises the limit of open files of this process to their need.
    ///
    /// # Errors
    /// [`ListenError`].
    pub async fn bind_robots(host: &str, count: u16) -> Result<Vec<Self>, ListenError> {
        allow_open_files(count)?;
        let mut robots = Vec::new();
        for _ in 0..count {
            robots.push(Self::bind(host, 0, 0).await?);
        }
        Ok(robots)
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

/// Raises the limit of open files to the need of some robots: two ports and two connections each.
#[cfg(unix)]
fn allow_open_files(robots: u16) -> Result<(), ListenError> {
    use nix::sys::resource::{Resource, getrlimit, setrlimit};

    /// Open files of a program besides its connections.
    const OTHER_FILES: u64 = 64;

    let system = |error: nix::Error| ListenError::System(error.into());
    let needed = u64::from(robots) * 4 + OTHER_FILES;
    let (soft, hard) = getrlimit(Resource::RLIMIT_NOFILE).map_err(system)?;
    if soft >= needed {
        return Ok(());
    }
    if hard < needed {
        return Err(ListenError::OpenFiles {
            robots,
            needed,
            allowed: hard,
        });
    }
    setrlimit(Resource::RLIMIT_NOFILE, needed, hard).map_err(system)
}

/// Windows has no such limit.
#[cfg(not(unix))]
fn allow_open_files(_robots: u16) -> Result<(), ListenError> {
    Ok(())
}

async fn listen(host: &str, port: u16) -> Result<TcpListener, ListenError> {
    let bound = TcpListener::bind((host, port)).await;
    bound.map_err(|error| ListenError::Address {
        address: format!("{host}:{port}"),
        error,
    })
}
