//! Counters and times for the recorder that the program has installed with the `metrics` crate.
//!
//! There are two implementations: `on` passes values to the recorder, `off` is empty and costs nothing.

#[cfg(not(feature = "metrics"))]
mod off;
#[cfg(feature = "metrics")]
mod on;

#[cfg(not(feature = "metrics"))]
pub(crate) use off::*;
#[cfg(feature = "metrics")]
pub(crate) use on::*;

/// Metrics of calls by operation.
#[cfg_attr(
    not(feature = "metrics"),
    allow(dead_code, reason = "names of metrics")
)]
#[derive(Debug)]
pub(crate) struct Family {
    /// Name of the counter by operation and result.
    pub(crate) calls: &'static str,
    /// Help text.
    pub(crate) calls_help: &'static str,
    /// Name of the histogram of seconds by operation.
    pub(crate) seconds: &'static str,
    /// Help text.
    pub(crate) seconds_help: &'static str,
}

/// Metrics of calls of the client.
#[cfg(feature = "client")]
pub(crate) const CLIENT: Family = Family {
    calls: "fc_client_calls_total",
    calls_help: "Calls that have ended, by operation and result.",
    seconds: "fc_client_call_duration_seconds",
    seconds_help: "Time from a call to its end, by operation.",
};

/// Metrics of requests at the server.
#[cfg(feature = "server")]
pub(crate) const SERVER: Family = Family {
    calls: "fc_server_calls_total",
    calls_help: "Requests with a response, by operation and result.",
    seconds: "fc_server_handler_duration_seconds",
    seconds_help: "Time from the start of a handler to its end, by operation.",
};
