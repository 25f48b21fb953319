//! `fcproto inspect`.

use clap::ValueEnum;
use fc_codegen::target::part;

use crate::lang::both;
use crate::outcome::{Failure, Status};
use crate::print;
use crate::spec::Spec;

/// Options of `fcproto inspect`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "json",
        help = both("输出格式", "Output format")
    )]
    format: OutputFormat,
    #[arg(
        long = "for",
        value_name = "AUDIENCE",
        help = both("只含规范中这个受众的内容", "Include only the part of this audience of the spec")
    )]
    audience: Option<String>,
}

/// The output format.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum OutputFormat {
    #[value(help = both("一个 JSON 文档", "One JSON document"))]
    Json,
    #[value(help = both("同样的内容，YAML 格式", "The same as YAML"))]
    Yaml,
}

pub fn run(spec: &Spec, options: &Options) -> Result<Status, Failure> {
    spec.show_faults()?;
    if let Some(model) = &spec.model {
        let part = part(model, options.audience.as_deref())?;
        print::result(&match options.format {
            OutputFormat::Json => fc_codegen::inspect::json(&part),
            OutputFormat::Yaml => fc_codegen::inspect::yaml(&part),
        })?;
    }
    Ok(spec.status())
}
