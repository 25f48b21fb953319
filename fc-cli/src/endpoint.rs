//! Addresses of robots, and of ports to listen on.

use std::net::{Ipv6Addr, SocketAddr};

use fc_spec::model::Model;
use fc_workshop::listen::{ListenError, Listeners};

use crate::lang::both;

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
}

/// Returns the line that names the listening ports.
pub fn line((commands, data): (SocketAddr, SocketAddr)) -> String {
    format!("commands {commands} data {data}\n")
}

/// Adds the port to an address that has none. An IPv6 address with a port has brackets.
pub fn with_port(address: &str, port: u16) -> String {
    let is_bare_v6 = address.parse::<Ipv6Addr>().is_ok();
    match address.rsplit_once(':') {
        _ if is_bare_v6 => format!("[{address}]:{port}"),
        Some((_, number)) if number.parse::<u16>().is_ok() => address.to_owned(),
        _ => format!("{address}:{port}"),
    }
}

/// Returns the address without its port, and with this port instead.
pub fn at_port(address: &str, port: u16) -> String {
    let whole = with_port(address, port);
    match whole.rsplit_once(':') {
        Some((host, _)) => format!("{host}:{port}"),
        None => whole,
    }
}
