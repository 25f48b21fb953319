//! The outcome of a command.

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

/// The reason why a command failed: a sentence for the user.
pub type Failure = Box<dyn std::error::Error>;
