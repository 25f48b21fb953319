//! What the spec says of when a command is accepted and of when a report is sent.

use std::time::Duration;

/// What has to hold before a command is accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preconditions {
    /// In which states it is accepted.
    pub states: AcceptedStates,
    /// Names of the commands that come first.
    pub after: &'static [&'static str],
}

/// In which states a command is accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AcceptedStates {
    /// The spec does not say.
    Unsaid,
    /// In any state.
    Any,
    /// In those in which each of these enums has one of these values.
    Only(&'static [States]),
}

/// Some values of an enum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct States {
    /// Name of the enum in the spec.
    pub of: &'static str,
    /// Its values as JSON.
    pub values: &'static [&'static str],
}

/// When a report is sent. A path is that of wire keys from the report's body on, joined by dots; it leads through lists
/// into their items.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cadence {
    /// At each change of the field at this path.
    OnChange(&'static str),
    /// At each step of a number.
    Step {
        /// Path of the number.
        field: &'static str,
        /// How far it moves from one report to the next.
        by: f64,
    },
    /// At intervals.
    Every(Duration),
    /// At the latest so long after a command that sets it off.
    Within(Duration),
}

impl Cadence {
    /// At each step of the number at this path.
    #[must_use]
    pub const fn step(field: &'static str, by: f64) -> Self {
        Self::Step { field, by }
    }

    /// At intervals of so many milliseconds.
    #[must_use]
    pub const fn every_ms(milliseconds: u64) -> Self {
        Self::Every(Duration::from_millis(milliseconds))
    }

    /// At the latest so many milliseconds after a command that sets it off.
    #[must_use]
    pub const fn within_ms(milliseconds: u64) -> Self {
        Self::Within(Duration::from_millis(milliseconds))
    }
}
