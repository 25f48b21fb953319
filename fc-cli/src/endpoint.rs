//! Options for the ports to listen on.

use std::net::SocketAddr;

use fc_spec::model::Model;
use fc_workshop::listen::{ListenError, Listeners};

use crate::lang::{both, said};
use crate::outcome::Failure;

/// Options that name the ports to listen on.
#[derive(Debug, clap::Args)]
pub struct Ports {
    #[arg(
        long,
        value_name = "HOST",
        default_value = "127.0.0.1",
        help = both("监听的地址", "Address to listen on")
    )]
    host: String,
    #[arg(
        long,
        value_name = "PORT",
        help = both("指令端口，0 为任意 [默认：按规范]", "Command port, 0 for any [default: by the spec]")
    )]
    command_port: Option<u16>,
    #[arg(
        long,
        value_name = "PORT",
        help = both("数据端口，0 为任意 [默认：按规范]", "Data port, 0 for any [default: by the spec]")
    )]
    data_port: Option<u16>,
}

impl Ports {
    /// Listens on both ports.
    pub async fn listen(&self, model: &Model) -> Result<Listeners, ListenError> {
        let ports = &model.transport.ports;
        let command_port = self.command_port.unwrap_or(ports.command.number);
        let data_port = self.data_port.unwrap_or(ports.data.number);
        Listeners::bind(&self.host, command_port, data_port).await
    }

    /// Listens on free ports for a number of robots.
    pub async fn listen_often(&self, count: u16) -> Result<Vec<Listeners>, Failure> {
        let has_port = |port: Option<u16>| port.is_some_and(|port| port != 0);
        if has_port(self.command_port) || has_port(self.data_port) {
            return Err(said!(
                "--count 大于 1 时，每台机器人使用任意空闲端口；去掉端口选项",
                "with --count above 1, each robot has any free ports; leave out the options for ports"
            )
            .into());
        }
        Ok(Listeners::bind_robots(&self.host, count).await?)
    }
}

/// Returns the line that names the listening ports.
pub fn line((commands, data): (SocketAddr, SocketAddr)) -> String {
    format!("commands {commands} data {data}\n")
}
