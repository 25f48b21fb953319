//! Where the project is, as every command is told.

use std::path::PathBuf;

/// Heading of the options that every command has.
pub const GLOBAL: &str = "Global options";

/// Where the project and its spec are.
#[derive(Debug, clap::Args)]
pub struct Place {
    /// Project directory [default: the current or nearest parent directory with fc.yaml or SPEC/protocol.yaml]
    #[arg(long, value_name = "DIR", global = true, help_heading = GLOBAL)]
    pub root: Option<PathBuf>,
    /// Spec directory, relative to the root [default: what fc.yaml says, or spec]
    #[arg(long, value_name = "DIR", global = true, help_heading = GLOBAL)]
    pub spec: Option<PathBuf>,
}
