//! How a command can end.

/// How a command ended; its number is the exit status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Success.
    Fine = 0,
    /// The spec has errors, generated files are stale, or the spec is not laid out.
    Faulty = 1,
    /// Wrong usage, or a file that cannot be read or written.
    Failed = 2,
}

/// Why a command could not do its work: a sentence for the user.
pub type Failure = Box<dyn std::error::Error>;
