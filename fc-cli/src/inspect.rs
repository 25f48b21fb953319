//! `fcproto inspect`.

use clap::ValueEnum;
use fc_codegen::target::part;

use crate::help::{Help, Part};
use crate::lang::both;
use crate::outcome::{Failure, Status};
use crate::place::Place;
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
    format: Shown,
    #[arg(
        long = "for",
        value_name = "AUDIENCE",
        help = both("只含规范中这个受众的内容", "Include only the part of this audience of the spec")
    )]
    audience: Option<String>,
}

pub fn help() -> Help {
    Help {
        summary: both(
            "输出解析后的规范，JSON 或 YAML",
            "Print the resolved spec as JSON or YAML",
        ),
        details: vec![
            Part::Text(both(
                "所有名称都已解析，所有默认值都已填入，其他程序不了解规范语言也能使用协议。`fcproto schema dump` 输出它的 JSON Schema。",
                "All names are resolved and all defaults are filled in. Other programs can use the protocol without knowing the spec \
                 language. `fcproto schema dump` prints the JSON Schema of the output.",
            )),
            Part::Examples(vec![
                (
                    "fcproto inspect --format json | jq '.operations[].name'",
                    "",
                ),
                ("fcproto inspect --format yaml", ""),
                (
                    "fcproto inspect --for product_app",
                    both("只含产品 app 的部分", "Only the part of the product app"),
                ),
                (
                    "fcproto inspect > model.json",
                    both(
                        "供 `fcproto generate --from` 使用",
                        "For `fcproto generate --from`",
                    ),
                ),
            ]),
        ],
        fails: both("规范有错误", "Errors in the spec"),
        speaks: "",
    }
}

/// The output format.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shown {
    #[value(help = both("一个 JSON 文档", "One JSON document"))]
    Json,
    #[value(help = both("同样的内容，YAML 格式", "The same as YAML"))]
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
