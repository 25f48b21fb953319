//! A robot for testing apps, and nothing else. It answers every command with the spec's example,
//! also commands that would move a real robot. It pushes every report once to each app. It sends
//! the picture of a map over the data port to any app that asks for one.
//!
//! ```text
//! cargo run --example robot -- --command-port 0 --data-port 0
//! ```

mod support;

use fc_generated::descriptors::OPERATIONS;
use fc_generated::{ExampleRobot, Fc, GetMapImageRequest, Reporter, RobotService, for_each_report};
use fc_runtime::{
    Acknowledgement, Audience, Command, ConnectionId, Context, Handling, Json, Message, Protocol,
    PushError, RawAnswer, RawRequest, Refusal, Report, Request, Server, ServerConfig, ServerHandle,
    Service,
};
use std::collections::HashSet;
use std::net::IpAddr;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;
use support::stop::Stop;
use support::{Args, Fault};
use tokio::sync::mpsc;

/// Time limit for requests in progress when the robot is asked to end.
const GRACE: Duration = Duration::from_secs(5);

const USAGE: &str = "\
Responds to every command with the example in the spec. Nothing moves: this is for trying out apps.

Usage: robot [--host 127.0.0.1] [--command-port PORT] [--data-port PORT] [--once]
             [--delay MILLISECONDS] [--gzip-from BYTES] [--picture-scale N]

Without ports, those of the spec; 0 for any that is free. The first line says which:
commands 127.0.0.1:PORT data 127.0.0.1:PORT
With --once the robot ends when its app has left, otherwise with Ctrl-C or SIGTERM:
what it has begun is answered first. With --delay it takes so long over each command; with
--gzip-from it compresses whatever has so many bytes; with --picture-scale the picture of a
map is so many times as wide and high.
RUST_LOG says what is logged to stderr, e.g. RUST_LOG=warn.";

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    support::main(USAGE, run).await
}

async fn run(args: Args) -> Result<(), Fault> {
    support::log()?;
    let host: IpAddr = args
        .host
        .parse()
        .map_err(|_| format!("{} is no address", args.host))?;
    let mut config = ServerConfig::new().address(host).gzip(args.gzip);
    if let Some(port) = args.command_port {
        config = config.command_port(port);
    }
    if let Some(port) = args.data_port {
        config = config.data_port(port);
    }
    let (asked, requests) = mpsc::channel(256);
    let service = Attentive {
        // This robot has nothing that could move.
        examples: RobotService::new(ExampleRobot {
            pretend_motion: true,
        }),
        asked,
        delay: args.delay,
    };
    let picture = picture(args.picture_scale);
    let server = Server::bind(config, service).await?;
    // This is before the ports are printed, so that an immediate signal is not lost.
    let mut stop = Stop::listen()?;
    println!(
        "commands {} data {}",
        server.command_addr(),
        server.data_addr()
    );

    let handle = server.handle();
    let serving = tokio::spawn(server.run());
    // #region stop
    tokio::select! {
        () = attend(&handle, requests, &picture, args.once) => tracing::info!("the last app has left"),
        signal = stop.asked() => tracing::info!("{signal}: ending within {GRACE:?}"),
    }
    tokio::select! {
        () = handle.shutdown(GRACE) => {}
        // A second signal means that the user does not want to wait.
        signal = stop.asked() => {
            tracing::warn!("{signal} again: ending at once");
            handle.shutdown(Duration::ZERO).await;
        }
    }
    serving.await?;
    // #endregion stop
    tracing::info!("ended");
    Ok(())
}

/// Answers with the examples, and passes on the context of every request.
struct Attentive {
    examples: RobotService<ExampleRobot>,
    asked: mpsc::Sender<Context<Fc>>,
    delay: Duration,
}

impl Service<Fc> for Attentive {
    fn call(&self, request: Request<'_, Fc>) -> Handling {
        let (connection, code, id) = (request.context().connection, request.code(), request.id());
        tracing::debug!(%connection, code, id, "request");
        // If the channel is full, the app still gets its response.
        let _ = self.asked.try_send(request.context());
        if self.delay.is_zero() {
            return self.examples.call(request);
        }
        let delay = self.delay;
        request.handle_raw(move |_, request| async move {
            tokio::time::sleep(delay).await;
            example(&request)
        })
    }
}

/// Returns the spec's example of the response, as [`ExampleRobot`] does, for a command of any code.
fn example(request: &RawRequest) -> Result<RawAnswer, Refusal> {
    let operation = OPERATIONS
        .iter()
        .find(|operation| operation.code == Some(request.code))
        .ok_or_else(Refusal::unknown::<Fc>)?;
    let allowance = Fc::DEFAULTS.limits.json();
    (operation.request.check)(request.text.as_str().as_bytes(), allowance)
        .map_err(Refusal::invalid::<Fc>)?;
    Json::new(operation.response.example)
        .map(RawAnswer)
        .map_err(Refusal::invalid::<Fc>)
}

/// Pushes all reports to each new app, and sends pictures on request. Returns when the last app has
/// left, if `once`.
async fn attend(
    handle: &ServerHandle<Fc>,
    mut requests: mpsc::Receiver<Context<Fc>>,
    picture: &Arc<[u8]>,
    once: bool,
) {
    let mut known: HashSet<ConnectionId> = HashSet::new();
    let mut look = tokio::time::interval(Duration::from_millis(100));
    loop {
        tokio::select! {
            Some(request) = requests.recv() => {
                if known.insert(request.connection) {
                    tokio::spawn(push_all(Reporter::new(handle.clone()), request.connection));
                }
                if request.code == GetMapImageRequest::CODE {
                    tokio::spawn(send_picture(handle.clone(), request, picture.clone()));
                }
            }
            _ = look.tick() => {
                if once && !known.is_empty() && handle.connections().is_empty() {
                    return;
                }
            }
        }
    }
}

macro_rules! push_all {
    ($($method:ident $report:ident $acknowledgement:ident;)*) => {
        /// Pushes every report with the spec's example.
        async fn push_all(reporter: Reporter, app: ConnectionId) {
            $(
                let report = fc_generated::$report::example();
                let pushed = reporter.$method(Audience::One(app), &report).await;
                show(<fc_generated::$report as Report>::NAME, pushed);
            )*
        }
    };
}
for_each_report!(push_all);

/// Prints the outcome of a report.
fn show(name: &str, pushed: Result<Vec<Acknowledgement>, PushError>) {
    match pushed {
        Ok(acknowledgements) => {
            for Acknowledgement {
                connection,
                outcome,
            } in acknowledgements
            {
                println!("{name} to {connection}: {outcome:?}");
            }
        }
        Err(error) => println!("{name}: {error}"),
    }
}

/// Sends a picture to the app that has asked for one, with the id of its request.
async fn send_picture(handle: ServerHandle<Fc>, request: Context<Fc>, picture: Arc<[u8]>) {
    let app = Audience::One(request.connection);
    for _ in 0..40 {
        match handle
            .send_stream(app, request.code, request.id, &picture)
            .await
        {
            Ok(_) => {
                println!(
                    "picture of {} bytes to {}",
                    picture.len(),
                    request.connection
                );
                return;
            }
            // The app may ask before its data connection has been accepted.
            Err(PushError::NoConnection(_)) => tokio::time::sleep(Duration::from_millis(50)).await,
            Err(error) => {
                println!("picture: {error}");
                return;
            }
        }
    }
    println!("picture: {} has no data connection", request.connection);
}

/// Returns a small map as a portable graymap: a room with a wall around it.
fn picture(scale: usize) -> Arc<[u8]> {
    let (width, height) = (64 * scale, 48 * scale);
    let mut out = format!("P5 {width} {height} 255\n").into_bytes();
    for y in 0..height {
        for x in 0..width {
            let wall = x == 0 || y == 0 || x + 1 == width || y + 1 == height;
            out.push(if wall { 0 } else { 254 });
        }
    }
    out.into()
}
