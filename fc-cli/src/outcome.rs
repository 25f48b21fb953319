//! The outcome of a command.

use std::io;
use std::path::Path;

use fc_spec::diagnostic::{FaultCode, Faults};
use fc_workshop::client::ClientError;

use crate::lang::said;
use crate::print;

/// The outcome of a command. Its number is the exit status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Success.
    Fine = 0,
    /// The spec has errors, generated files are stale, or the spec is not formatted.
    Faulty = 1,
    /// Wrong usage, or a file that cannot be read or written.
    Failed = 2,
    /// A robot has refused a request.
    Refused = 3,
    /// A robot has not answered.
    Unanswered = 4,
}

impl Status {
    /// Returns the status for diagnostics.
    pub fn of(faults: &Faults) -> Self {
        if faults.iter().any(|it| it.code == FaultCode::Unreadable) {
            Self::Failed
        } else {
            Self::fine_if(!faults.has_errors())
        }
    }

    /// Returns success, or [`Self::Faulty`] if `is_fine` is `false`.
    pub fn fine_if(is_fine: bool) -> Self {
        if is_fine { Self::Fine } else { Self::Faulty }
    }
}

/// The reason why a command failed: a sentence for the user.
pub type Failure = Box<dyn std::error::Error>;

/// The failure of a command that has already shown the reason.
#[derive(Debug)]
pub struct Reported(pub Status);

impl std::fmt::Display for Reported {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "exit status {}", self.0 as u8)
    }
}

impl std::error::Error for Reported {}

/// Shows that a robot has not answered. Returns other failures.
pub fn unanswered(failure: Failure) -> Result<Status, Failure> {
    if !failure.is::<ClientError>() {
        return Err(failure);
    }
    print::failure(failure.as_ref());
    Ok(Status::Unanswered)
}

/// Makes an error in reading a path the reason of a failure.
pub fn unreadable(path: &Path) -> impl Fn(io::Error) -> Failure {
    let path = path.display();
    move |error| {
        said!(
            "无法读取 `{path}`：{error}",
            "cannot read `{path}`: {error}"
        )
        .into()
    }
}

/// Makes an error in writing a path the reason of a failure.
pub fn unwritable(path: &Path) -> impl Fn(io::Error) -> Failure {
    let path = path.display();
    move |error| {
        said!(
            "无法写入 `{path}`：{error}",
            "cannot write `{path}`: {error}"
        )
        .into()
    }
}
