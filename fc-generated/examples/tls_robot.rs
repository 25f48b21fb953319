//! A robot that accepts only TLS, from apps with a certificate, such as `tls_app`.
//!
//! ```text
//! cargo run --example tls_robot -- --certificates FOLDER
//! ```

mod support;
#[path = "support/tls.rs"]
mod tls;

use fc_generated::{ExampleRobot, Fc, RobotService};
use fc_runtime::{Server, ServerConfig, ServerHandle};
use std::net::{IpAddr, Ipv4Addr};
use std::process::ExitCode;
use std::time::Duration;
use support::stop::Stop;
use support::{Args, Fault};
use tls::Files;
use tokio::net::{TcpListener, TcpStream};
use tokio_rustls::TlsAcceptor;

const USAGE: &str = "\
Responds to every command with the example in the spec, over TLS.

Usage: tls_robot --certificates FOLDER [--host 127.0.0.1]
                 [--command-port PORT] [--data-port PORT]

The folder has ca.pem, robot.pem and robot.key. The first line says the ports:
commands 127.0.0.1:PORT data 127.0.0.1:PORT";

#[tokio::main]
async fn main() -> ExitCode {
    support::main(USAGE, run).await
}

async fn run(args: Args) -> Result<(), Fault> {
    support::log()?;
    let files = Files {
        folder: args.certificates.clone(),
        name: "robot",
    };
    let tls = TlsAcceptor::from(files.server()?);
    let host: IpAddr = args.host.parse()?;
    let listen = |port: Option<u16>| TcpListener::bind((host, port.unwrap_or(0)));
    let (commands, data) = (
        listen(args.command_port).await?,
        listen(args.data_port).await?,
    );

    // #region serve
    // 不加密的端口只对本机开放，端口号任意；对外的端口由下面的循环接受连接。
    // The plain ports are open only to this machine. The loops below accept connections from
    // others.
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let server = Server::bind(config, RobotService::new(ExampleRobot::default())).await?;
    // #endregion serve
    let mut stop = Stop::listen()?;
    println!(
        "commands {} data {}",
        commands.local_addr()?,
        data.local_addr()?
    );
    let handle = server.handle();
    let serving = tokio::spawn(server.run());
    let signal = tokio::select! {
        () = accept(&commands, &tls, &handle, false) => return Ok(()),
        () = accept(&data, &tls, &handle, true) => return Ok(()),
        signal = stop.asked() => signal,
    };
    tracing::info!("{signal}: ending");
    handle.shutdown(Duration::from_secs(5)).await;
    serving.await?;
    Ok(())
}

// #region accept
/// 握手由运行库进行：有时限，计入连接数和每个地址的上限，`allow` 之外的地址不会开始握手。
/// The runtime runs the handshake: it has a time limit, and counts towards the limits on
/// connections and per address. Addresses outside of `allow` cannot start one.
async fn accept(listener: &TcpListener, tls: &TlsAcceptor, robot: &ServerHandle<Fc>, data: bool) {
    loop {
        let accepted: std::io::Result<(TcpStream, _)> = listener.accept().await;
        let Ok((stream, address)) = accepted else {
            tokio::time::sleep(Duration::from_millis(50)).await;
            continue;
        };
        let _ = stream.set_nodelay(true);
        let handshake = tls.accept(stream);
        if data {
            robot.serve_data_after(handshake, address);
        } else {
            robot.serve_after(handshake, address);
        }
    }
}
// #endregion accept
