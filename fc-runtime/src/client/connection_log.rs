//! Log lines about a connection of an app.

use super::loss::Loss;
use crate::clock;
use crate::log_limiter::LogLimiter;
use crate::protocol::Protocol;

/// Logs the events of a connection, one line each.
#[derive(Debug)]
pub(super) struct ConnectionLog {
    protocol: &'static str,
    address: String,
    /// Name of the port, "command" or "data".
    port: &'static str,
    /// Failed attempts since the last connection.
    failed: u64,
    /// Last logged reason of a failed attempt.
    told: Option<Loss>,
    connected: LogLimiter,
    ended: LogLimiter,
    failing: LogLimiter,
}

impl ConnectionLog {
    pub(super) fn new<P: Protocol>(address: String, port: &'static str) -> Self {
        Self {
            protocol: P::NAME,
            address,
            port,
            failed: 0,
            told: None,
            connected: LogLimiter::per_second(),
            ended: LogLimiter::per_second(),
            failing: LogLimiter::per_second(),
        }
    }

    /// Logs connection number `connects`.
    pub(super) fn connected(&mut self, connects: u64) {
        let failed = std::mem::take(&mut self.failed);
        self.told = None;
        let Some(held) = self.connected.admit(clock::now()) else {
            return;
        };
        let event = if connects > 1 {
            "connected again"
        } else {
            "connected"
        };
        tracing::info!(
            protocol = self.protocol,
            port = self.port,
            address = self.address,
            connects,
            failed,
            held = held.shown(),
            "{event}"
        );
    }

    /// Logs the end of the connection.
    pub(super) fn ended(&mut self, why: Loss) {
        let Some(held) = self.ended.admit(clock::now()) else {
            return;
        };
        let (protocol, port, held) = (self.protocol, self.port, held.shown());
        let (address, reason) = (self.address.as_str(), why.name());
        if why == Loss::Here {
            tracing::info!(protocol, port, address, held, "closed");
        } else {
            tracing::warn!(protocol, port, address, reason, held, "lost: {why}");
        }
    }

    /// Logs a failed attempt to connect, unless it failed like the one before.
    pub(super) fn not_connected(&mut self, why: Loss) {
        self.failed = self.failed.saturating_add(1);
        if self.told.replace(why) == Some(why) {
            return;
        }
        let Some(held) = self.failing.admit(clock::now()) else {
            return;
        };
        tracing::warn!(
            protocol = self.protocol,
            port = self.port,
            address = self.address,
            reason = why.name(),
            held = held.shown(),
            "{why}"
        );
    }

    /// Logs that there are no more attempts, if there were any. Otherwise the end has been logged already.
    pub(super) fn given_up(&self, why: Loss) {
        if self.failed == 0 {
            return;
        }
        tracing::warn!(
            protocol = self.protocol,
            port = self.port,
            address = self.address,
            reason = why.name(),
            failed = self.failed,
            "given up: {why}"
        );
    }
}
