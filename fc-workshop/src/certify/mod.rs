//! Trials of a device against the spec, and the certificate of their results.
//!
//! ```text
//! trial ──(robot)──► Line ──bytes──► robot       one new connection for each trial
//! trial ──(app)────────────bytes──► app         over the connections of the app
//!   └─► Result ──► Certificate ──json, html──► files
//! ```

mod app;
mod checks;
mod html;
mod json;
mod line;
mod malformed;
mod reports;
mod requests;
mod robot;

pub use app::app;
pub use html::page as html;
pub use json::{line as json_line, text as json};
pub use robot::robot;

use crate::permission::Permission;
use fc_spec::model::{Lang, Text};
use std::time::{Duration, SystemTime};

/// The settings of a certification.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Address of the device's command port.
    pub address: String,
    /// The largest effect of the commands that are sent.
    pub permission: Permission,
    /// Names of the trials to run, or all if empty. A name ends at a dot, such as `call` for `call.get_level`.
    pub only: Vec<String>,
}

/// The result of a trial.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The device does what the spec demands.
    Passed,
    /// The device does not.
    Failed(Failure),
    /// The trial was not run, for this reason.
    Skipped(Text),
}

/// The deviation of a device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The reason.
    pub reason: Text,
    /// The frames and bytes that were sent, in their order.
    pub sent: Vec<Vec<u8>>,
    /// The frames and bytes that were received, in their order.
    pub received: Vec<Vec<u8>>,
}

/// A trial that is over.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Name.
    pub name: String,
    /// The demand of the spec.
    pub demand: Text,
    /// Result.
    pub outcome: Outcome,
}

/// The results of all trials.
#[derive(Clone, Debug)]
pub struct Certificate {
    /// Address of the device.
    pub address: String,
    /// Id of the protocol.
    pub protocol: String,
    /// Version of the protocol.
    pub version: String,
    /// Fingerprint of the spec.
    pub fingerprint: String,
    /// Version of the program.
    pub program: String,
    /// Start.
    pub start: SystemTime,
    /// Duration.
    pub duration: Duration,
    /// The names of the only trials that were wanted, or none for all.
    pub only: Vec<String>,
    /// The trials in their order.
    pub trials: Vec<Trial>,
}

impl Trial {
    /// Returns the name, the result and its reason as a line, without the end of the line.
    #[must_use]
    pub fn line(&self, lang: Lang) -> String {
        let (result, reason) = match &self.outcome {
            Outcome::Passed => (lang.pick("通过", "passed"), None),
            Outcome::Failed(failure) => (lang.pick("失败", "FAILED"), Some(&failure.reason)),
            Outcome::Skipped(reason) => (lang.pick("跳过", "skipped"), Some(reason)),
        };
        let reason = reason.map(|reason| format!(": {}", lang.text(reason)));
        format!("{result}  {}{}", self.name, reason.unwrap_or_default())
    }
}

impl Certificate {
    /// Returns `true` if no trial has failed and one has passed.
    #[must_use]
    pub fn is_passed(&self) -> bool {
        let mut outcomes = self.trials.iter().map(|trial| &trial.outcome);
        let has_failed = outcomes.clone().any(|it| matches!(it, Outcome::Failed(_)));
        !has_failed && outcomes.any(|it| *it == Outcome::Passed)
    }

    /// Returns the number of passed, failed and skipped trials.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for trial in &self.trials {
            let [passed, failed, skipped] = &mut counts;
            *match trial.outcome {
                Outcome::Passed => passed,
                Outcome::Failed(_) => failed,
                Outcome::Skipped(_) => skipped,
            } += 1;
        }
        counts
    }
}
