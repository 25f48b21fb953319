//! `fcproto codes`.

use clap::ValueEnum;
use fc_codegen::codes::CodeMap;

use crate::help::{Help, Part};
use crate::lang::{both, lang};
use crate::new::code;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::spec::Spec;

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
    format: Shown,
}

pub fn help() -> Help {
    Help {
        summary: both(
            "列出已用、退役和空闲的功能码",
            "List assigned, retired and free codes",
        ),
        details: vec![
            Part::Text(both(
                "先是下一条指令和上报取得的功能码，再是每个号段中的接口、退役的功能码及理由、空闲的数量。给出功能码时，只显示它们的情况。",
                "The list begins with the codes that the next command and report get. Each range follows with its operations, its \
                 retired codes with the reason, and the number of free codes. If you name codes, the list shows only these.",
            )),
            Part::Examples(vec![
                ("fcproto codes", both("全部功能码", "All codes")),
                (
                    "fcproto codes 0x0123 0x0456",
                    both(
                        "显示使用它们的接口，或它们空闲",
                        "Show their operations, or that they are free",
                    ),
                ),
                ("fcproto codes --format json | jq -r .next_command", ""),
            ]),
        ],
        fails: both("规范有错误", "Errors in the spec"),
        speaks: both(
            "`text` 格式；`json` 含两种语言",
            "`text`; `json` has both languages",
        ),
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shown {
    #[value(help = both("在终端上阅读", "For reading on a terminal"))]
    Text,
    #[value(help = both("一个 JSON 文档，含两种语言", "One JSON document in both languages"))]
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
