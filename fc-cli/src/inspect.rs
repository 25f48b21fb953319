//! `fcproto inspect`.

use clap::ValueEnum;
use fc_codegen::target::part;

use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::spec::Spec;

/// Print the spec as the generator understands it.
///
/// All names are resolved and all defaults filled in, so that other programs can use the protocol
/// without knowing the spec language.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto inspect --format json | jq '.operations[].name'
  fcproto inspect --format yaml
  fcproto inspect --for product_app
                                only what the product app has
  fcproto inspect > model.json  all that `fcproto generate --from model.json` needs")]
pub struct Options {
    /// How to print it.
    #[arg(long, value_name = "FORMAT", default_value = "json")]
    format: Shown,
    /// Print only what this audience has, as the spec names it under `availability`.
    #[arg(long = "for", value_name = "AUDIENCE")]
    audience: Option<String>,
}

/// How to print the model.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shown {
    /// One JSON document
    Json,
    /// The same as YAML
    Yaml,
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let spec = Spec::read(place)?;
    spec.show_faults()?;
    if let Some(model) = &spec.model {
        let part = part(model, options.audience.as_deref())?;
        print::result(&match options.format {
            Shown::Json => fc_codegen::inspect::json(&part),
            Shown::Yaml => fc_codegen::inspect::yaml(&part),
        })?;
    }
    Ok(spec.status())
}
