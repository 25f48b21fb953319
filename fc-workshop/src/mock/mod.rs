//! A robot that is played from a spec, on all its ports.
//!
//! [`Mock::start`] runs one in a thread, for tests. [`serve`] runs one in the caller's task.

mod apps;
mod robot;

use crate::connection::{Connection, Event};
use crate::facts;
use apps::Apps;
use fc_reflect::Reflector;
use fc_spec::model::{Model, PortRole, Text};
use fc_spec::text;
use futures_util::stream::{FuturesUnordered, StreamExt as _};
use robot::Robot;
use std::cell::RefCell;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;
use std::{fmt, io};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::oneshot;

/// The addresses on which a mock listens.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Host name or address.
    pub host: String,
    /// Port of commands; 0 for any free port.
    pub command_port: u16,
    /// Port of streams; 0 for any free port.
    pub data_port: u16,
}

impl Settings {
    /// Returns free ports on loopback, for tests.
    #[must_use]
    pub fn any_port() -> Self {
        Self {
            host: "127.0.0.1".to_owned(),
            command_port: 0,
            data_port: 0,
        }
    }

    /// Returns the ports of a spec on loopback.
    #[must_use]
    pub fn of(model: &Model) -> Self {
        Self {
            command_port: model.transport.ports.command.number,
            data_port: model.transport.ports.data.number,
            ..Self::any_port()
        }
    }
}

/// The reason why a mock does not start.
#[derive(Debug)]
pub enum MockError {
    /// It cannot listen on an address.
    Listen {
        /// Address.
        address: String,
        /// Reason.
        error: io::Error,
    },
    /// The system gives no thread or timer.
    System(io::Error),
}

impl MockError {
    /// Returns the message in both languages.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Listen { address, error } => text!(
                "无法监听 {address}：{error}；换一个端口，0 表示任意空闲端口",
                "cannot listen on {address}: {error}; choose another port, or 0 for any free port"
            ),
            Self::System(error) => {
                text!("无法启动模拟端：{error}", "cannot start the mock: {error}")
            }
        }
    }
}

impl fmt::Display for MockError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text().en)
    }
}

impl std::error::Error for MockError {}

/// The sockets of a mock.
#[derive(Debug)]
pub struct Listeners {
    commands: TcpListener,
    data: TcpListener,
}

impl Listeners {
    /// Listens on the ports.
    ///
    /// # Errors
    /// [`MockError::Listen`].
    pub async fn bind(settings: &Settings) -> Result<Self, MockError> {
        Ok(Self {
            commands: listen(&settings.host, settings.command_port).await?,
            data: listen(&settings.host, settings.data_port).await?,
        })
    }

    /// Returns the addresses of the command port and the data port.
    ///
    /// # Errors
    /// [`MockError::System`].
    pub fn addresses(&self) -> Result<(SocketAddr, SocketAddr), MockError> {
        let commands = self.commands.local_addr().map_err(MockError::System)?;
        let data = self.data.local_addr().map_err(MockError::System)?;
        Ok((commands, data))
    }
}

async fn listen(host: &str, port: u16) -> Result<TcpListener, MockError> {
    let bound = TcpListener::bind((host, port)).await;
    bound.map_err(|error| MockError::Listen {
        address: format!("{host}:{port}"),
        error,
    })
}

/// Plays the robot of a model until `end` is ready.
pub async fn serve(model: &Model, listeners: Listeners, end: impl Future<Output = ()>) {
    let reflector = &Reflector::new(model);
    let most = facts::limits(model).connections;
    let robot = &RefCell::new(Robot::new(reflector));
    let apps = &Apps::new(facts::limits(model).queued_reports);
    let mut talks = FuturesUnordered::new();
    let mut end = pin!(end);
    loop {
        let due = robot.borrow().next_due();
        tokio::select! {
            () = &mut end => return,
            accepted = listeners.commands.accept(), if talks.len() < most => {
                if let Ok((stream, _)) = accepted {
                    talks.push(talk(reflector, robot, apps, PortRole::Command, stream));
                }
            }
            accepted = listeners.data.accept(), if talks.len() < most => {
                if let Ok((stream, _)) = accepted {
                    talks.push(talk(reflector, robot, apps, PortRole::Data, stream));
                }
            }
            Some(()) = talks.next(), if !talks.is_empty() => {}
            () = until(due) => {
                for report in robot.borrow_mut().due(Instant::now()) {
                    apps.send(&report);
                }
            }
        }
    }
}

/// Talks with one app until it ends the connection.
async fn talk<'m>(
    reflector: &'m Reflector<'m>,
    robot: &RefCell<Robot<'m>>,
    apps: &Apps,
    port: PortRole,
    stream: TcpStream,
) {
    // Without it, small frames only travel later.
    let _ = stream.set_nodelay(true);
    let mut connection: Connection<'m, _, ()> = Connection::new(reflector, stream);
    let mut reports = apps.join();
    loop {
        tokio::select! {
            event = connection.next() => {
                let answer = match event {
                    Event::Command(frame) | Event::Report(frame) => {
                        robot.borrow_mut().answer(&frame)
                    }
                    Event::Stream(frame) if port == PortRole::Command => {
                        robot.borrow_mut().answer(&frame)
                    }
                    Event::Invalid(id, error) => robot.borrow_mut().answer_invalid(id, &error),
                    Event::Ended(_) => break,
                    Event::Answer(..) | Event::Expired(()) | Event::Late(_) | Event::Stream(_) => None,
                };
                if let Some(bytes) = answer {
                    connection.send(&bytes);
                }
            }
            Some(report) = reports.recv() => {
                let kind = reflector.model().frame.kinds.report.value;
                let data = Arc::clone(&report.data);
                // An app with too many unacknowledged reports misses this one.
                let _ = connection.request(kind, report.code, data, report.ack, ());
            }
        }
    }
    // The app may have closed only its sending side.
    let _ = connection.finish().await;
}

async fn until(due: Option<Instant>) {
    match due {
        Some(due) => tokio::time::sleep_until(due.into()).await,
        None => std::future::pending().await,
    }
}

/// A mock in its own thread. It stops when it is dropped.
#[derive(Debug)]
pub struct Mock {
    commands: SocketAddr,
    data: SocketAddr,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Mock {
    /// Starts a mock.
    ///
    /// # Errors
    /// [`MockError`] if it cannot listen.
    pub fn start(model: Model, settings: Settings) -> Result<Self, MockError> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(MockError::System)?;
        let listeners = runtime.block_on(Listeners::bind(&settings))?;
        let (commands, data) = listeners.addresses()?;
        let (stop, stopped) = oneshot::channel::<()>();
        let run = move || {
            runtime.block_on(serve(&model, listeners, async {
                // A dropped sender stops the mock, too.
                let _ = stopped.await;
            }));
        };
        let thread = std::thread::Builder::new().name("mock".to_owned());
        let thread = thread.spawn(run).map_err(MockError::System)?;
        Ok(Self {
            commands,
            data,
            stop: Some(stop),
            thread: Some(thread),
        })
    }

    /// Returns the address of the command port.
    #[must_use]
    pub fn commands(&self) -> SocketAddr {
        self.commands
    }

    /// Returns the address of the data port.
    #[must_use]
    pub fn data(&self) -> SocketAddr {
        self.data
    }
}

impl Drop for Mock {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was printed already.
            let _ = thread.join();
        }
    }
}
