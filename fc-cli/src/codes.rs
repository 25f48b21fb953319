//! `fcproto codes`.

use clap::ValueEnum;
use fc_codegen::codes::CodeMap;
use fc_spec::model::Model;

use crate::lang::{both, lang};
use crate::new::code;
use crate::outcome::{Failure, Status};
use crate::print;

/// Options of `fcproto codes`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "CODE",
        value_parser = code,
        help = both("功能码，例如 `0x0123` [默认：全部]", "Codes, such as `0x0123` [default: all]")
    )]
    codes: Vec<u16>,
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        conflicts_with = "codes",
        help = both("输出格式", "Output format")
    )]
    format: OutputFormat,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum OutputFormat {
    #[value(help = both("在终端上阅读", "For reading on a terminal"))]
    Text,
    #[value(help = both("一个 JSON 文档，含两种语言", "One JSON document in both languages"))]
    Json,
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let map = CodeMap::new(model);
    let lang = lang();
    print::result(&match options.format {
        _ if !options.codes.is_empty() => {
            let codes = options.codes.iter();
            codes.map(|code| map.standing(*code, lang)).collect()
        }
        OutputFormat::Text => map.text(lang),
        OutputFormat::Json => map.json(),
    })?;
    Ok(Status::Fine)
}
