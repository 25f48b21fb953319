//! The states in which a command is accepted, and the times at which a report is sent.

use std::time::Duration;

/// The preconditions of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preconditions {
    /// States in which it is accepted.
    pub states: AcceptedStates,
    /// Names of the commands that must come first.
    pub after: &'static [&'static str],
}

/// The states in which a command is accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AcceptedStates {
    /// The spec does not specify the states.
    Unsaid,
    /// Any state.
    Any,
    /// States in which each of these enums has one of these values.
    Only(&'static [States]),
}

/// Some values of an enum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct States {
    /// Name of the enum in the spec.
    pub of: &'static str,
    /// Values as JSON.
    pub values: &'static [&'static str],
}

/// The time at which a report is sent. A path consists of wire keys in the report's body, joined by dots. It leads
/// through lists into their items.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cadence {
    /// At each change of the field at this path.
    OnChange(&'static str),
    /// At each step of a number.
    Step {
        /// Path of the number.
        field: &'static str,
        /// Change of the number between two reports.
        by: f64,
    },
    /// At intervals.
    Every(Duration),
    /// At most this time after a command that sets it off.
    Within(Duration),
}

impl Cadence {
    /// Creates a cadence for each step of the number at this path.
    #[must_use]
    pub const fn step(field: &'static str, by: f64) -> Self {
        Self::Step { field, by }
    }

    /// Creates a cadence with this interval in milliseconds.
    #[must_use]
    pub const fn every_ms(milliseconds: u64) -> Self {
        Self::Every(Duration::from_millis(milliseconds))
    }

    /// Creates a cadence of at most this many milliseconds after a command that sets it off.
    #[must_use]
    pub const fn within_ms(milliseconds: u64) -> Self {
        Self::Within(Duration::from_millis(milliseconds))
    }
}
