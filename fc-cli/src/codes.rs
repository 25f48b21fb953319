//! `fcproto codes`.

use clap::ValueEnum;
use fc_codegen::codes::CodeMap;

use crate::lang::lang;
use crate::new::code;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::spec::Spec;

/// Show who has which code, and which are free.
///
/// What the next command and report get, then each range with the operations in it, the codes that were
/// retired with the reason, and how many are free. With codes, only what is to be said of these.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto codes                the whole map
  fcproto codes 0x0123 0x0456  whether they are free, and who has them if not
  fcproto codes --format json | jq -r .next_command")]
pub struct Options {
    /// Codes, such as 0x0123 [default: all]
    #[arg(value_name = "CODE", value_parser = code)]
    codes: Vec<u16>,
    /// How to print them.
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        conflicts_with = "codes"
    )]
    format: Shown,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shown {
    /// For reading on a terminal
    Text,
    /// One JSON document, in both languages
    Json,
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let spec = Spec::read(place)?;
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    let map = CodeMap::new(model);
    let lang = lang();
    print::result(&match options.format {
        _ if !options.codes.is_empty() => {
            let codes = options.codes.iter();
            codes.map(|code| map.standing(*code, lang)).collect()
        }
        Shown::Text => map.text(lang),
        Shown::Json => map.json(),
    })?;
    Ok(Status::Fine)
}
