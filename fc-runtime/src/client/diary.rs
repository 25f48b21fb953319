//! What a person finds in the log about an app's connection.

use super::loss::Loss;
use crate::clock;
use crate::protocol::Protocol;
use crate::thin::Thin;

/// Logs what happens to a connection, one line each.
#[derive(Debug)]
pub(super) struct Diary {
    protocol: &'static str,
    address: String,
    /// The port it is, "command" or "data".
    port: &'static str,
    /// Attempts that have failed since there was a connection.
    failed: u64,
    /// The reason that was last logged for a failed attempt.
    told: Option<Loss>,
    connected: Thin,
    ended: Thin,
    failing: Thin,
}

impl Diary {
    pub(super) fn new<P: Protocol>(address: String, port: &'static str) -> Self {
        Self {
            protocol: P::NAME,
            address,
            port,
            failed: 0,
            told: None,
            connected: Thin::per_second(),
            ended: Thin::per_second(),
            failing: Thin::per_second(),
        }
    }

    /// There is a connection, the one of this number.
    pub(super) fn connected(&mut self, connects: u64) {
        let failed = std::mem::take(&mut self.failed);
        self.told = None;
        let Some(held) = self.connected.line(clock::now()) else {
            return;
        };
        let (port, protocol, address, held) = (
            self.port,
            self.protocol,
            self.address.as_str(),
            held.shown(),
        );
        if connects > 1 {
            tracing::info!(
                protocol,
                port,
                address,
                connects,
                failed,
                held,
                "connected again"
            );
        } else {
            tracing::info!(protocol, port, address, connects, failed, held, "connected");
        }
    }

    /// The connection has ended.
    pub(super) fn ended(&mut self, why: Loss) {
        let Some(held) = self.ended.line(clock::now()) else {
            return;
        };
        let (port, protocol, address, held) = (
            self.port,
            self.protocol,
            self.address.as_str(),
            held.shown(),
        );
        let reason = why.name();
        if why == Loss::Here {
            tracing::info!(protocol, port, address, held, "closed");
        } else {
            tracing::warn!(protocol, port, address, reason, held, "lost: {why}");
        }
    }

    /// An attempt to connect has failed, and `why` says so. One that fails like the one before is no news.
    pub(super) fn not_connected(&mut self, why: Loss) {
        self.failed = self.failed.saturating_add(1);
        if self.told.replace(why) == Some(why) {
            return;
        }
        let Some(held) = self.failing.line(clock::now()) else {
            return;
        };
        let (port, protocol, address, held) = (
            self.port,
            self.protocol,
            self.address.as_str(),
            held.shown(),
        );
        tracing::warn!(protocol, port, address, reason = why.name(), held, "{why}");
    }

    /// There will be no more attempts. Where there were none, the end has been told.
    pub(super) fn given_up(&self, why: Loss) {
        if self.failed == 0 {
            return;
        }
        let (port, protocol, address, failed) =
            (self.port, self.protocol, self.address.as_str(), self.failed);
        tracing::warn!(
            protocol,
            port,
            address,
            reason = why.name(),
            failed,
            "given up: {why}"
        );
    }
}
