//! Addresses of robots, with or without a port.

use std::net::Ipv6Addr;

/// Adds the port to an address that has none. An IPv6 address with a port has brackets.
#[must_use]
pub fn with_port(address: &str, port: u16) -> String {
    let is_bare_v6 = address.parse::<Ipv6Addr>().is_ok();
    match address.rsplit_once(':') {
        _ if is_bare_v6 => format!("[{address}]:{port}"),
        Some((_, number)) if number.parse::<u16>().is_ok() => address.to_owned(),
        _ => format!("{address}:{port}"),
    }
}

/// Returns the address without its port, and with this port instead.
#[must_use]
pub fn at_port(address: &str, port: u16) -> String {
    let whole = with_port(address, port);
    match whole.rsplit_once(':') {
        Some((host, _)) => format!("{host}:{port}"),
        None => whole,
    }
}
