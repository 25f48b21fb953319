//! An app that connects over TLS to the robot `tls_robot`, with its own certificate.
//!
//! ```text
//! cargo run --example tls_app -- --certificates FOLDER --host robot.local --command-port PORT
//! ```

mod support;
#[path = "support/tls.rs"]
mod tls;

use fc_generated::{Client, GetRobotSnRequest};
use fc_runtime::{ClientConfig, Connection};
use std::process::ExitCode;
use support::{Args, Fault};
use tls::Files;
use tokio::net::TcpStream;
use tokio_rustls::TlsConnector;
use tokio_rustls::rustls::pki_types::ServerName;

const USAGE: &str = "\
Asks a robot for its serial number over TLS.

Usage: tls_app --certificates FOLDER --command-port PORT [--host 127.0.0.1]

The folder has ca.pem, app.pem and app.key.";

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    support::main(USAGE, run).await
}

async fn run(args: Args) -> Result<(), Fault> {
    let files = Files {
        folder: args.certificates.clone(),
        name: "app",
    };
    let app = connect(&files, args.host, args.command_port.ok_or("needs a port")?).await?;
    let answer = app.get_robot_sn(&GetRobotSnRequest::default()).await?;
    println!("answered: {answer:?}");
    Ok(())
}

// #region connect
/// 断线后重连时，TLS 握手也会重新进行。
/// After a loss, each reconnect repeats the TLS handshake.
async fn connect(files: &Files, host: String, port: u16) -> Result<Client, Fault> {
    let tls = TlsConnector::from(files.client()?);
    let name = ServerName::try_from(host.clone())?;
    let config = ClientConfig::new().host(host.clone()).command_port(port);
    let dial = move || {
        let (tls, name, host) = (tls.clone(), name.clone(), host.clone());
        async move {
            let stream = TcpStream::connect((host, port)).await?;
            stream.set_nodelay(true)?;
            tls.connect(name, stream).await
        }
    };
    Ok(Connection::connect_by(dial, config).await?.into())
}
// #endregion connect
