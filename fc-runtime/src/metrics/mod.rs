//! What is counted and timed, for the recorder that the program has installed with the `metrics` crate.
//!
//! What counts and times is here in two forms: `on` hands it to the recorder, `off` is empty and costs
//! nothing.

#[cfg(not(feature = "metrics"))]
mod off;
#[cfg(feature = "metrics")]
mod on;

#[cfg(not(feature = "metrics"))]
pub(crate) use off::*;
#[cfg(feature = "metrics")]
pub(crate) use on::*;

/// A family of metrics by operation, and the results that its calls can have.
#[cfg_attr(
    not(feature = "metrics"),
    allow(dead_code, reason = "names of metrics")
)]
#[derive(Debug)]
pub(crate) struct Family {
    /// Calls, by operation and result.
    pub(crate) calls: &'static str,
    /// What it says of them.
    pub(crate) calls_help: &'static str,
    /// Seconds, by operation.
    pub(crate) seconds: &'static str,
    /// What it says of them.
    pub(crate) seconds_help: &'static str,
}

/// Of calls at the client.
#[cfg(feature = "client")]
pub(crate) const CLIENT: Family = Family {
    calls: "fc_client_calls_total",
    calls_help: "Calls that have ended, by operation and by what they have ended with.",
    seconds: "fc_client_call_duration_seconds",
    seconds_help: "Time from a call to its end, by operation.",
};

/// Of requests at the server.
#[cfg(feature = "server")]
pub(crate) const SERVER: Family = Family {
    calls: "fc_server_calls_total",
    calls_help: "Requests answered, by operation and result.",
    seconds: "fc_server_handler_duration_seconds",
    seconds_help: "Time from the beginning of a handler to its end, by operation.",
};
