//! `fcproto schema`.

use clap::ValueEnum;

use crate::outcome::{Failure, Status};
use crate::print;

/// Print the JSON Schema of the spec language, or of what `fcproto inspect` prints.
///
/// Editors with a YAML language server use that of the language to complete and check spec files; `fcproto generate`
/// also writes it next to the spec. That of the dump is for plugins and other programs.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto schema
  fcproto schema dump > dump.schema.json")]
pub struct Options {
    /// What it describes.
    #[arg(value_name = "WHAT", default_value = "spec")]
    of: Of,
}

/// What a schema describes.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Of {
    /// The spec language
    Spec,
    /// What `fcproto inspect` prints
    Dump,
}

pub fn run(options: &Options) -> Result<Status, Failure> {
    print::result(&match options.of {
        Of::Spec => fc_spec::schema::schema(),
        Of::Dump => fc_spec::schema::dump(),
    })?;
    Ok(Status::Fine)
}
