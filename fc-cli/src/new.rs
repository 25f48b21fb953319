//! `fcproto new`.

use fc_codegen::output::replace_spec_file;
use fc_spec::model::Kind;
use fc_spec::scaffold::{NewOperation, scaffold};

use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status};
use crate::print;
use crate::spec::Spec;

/// Options of `fcproto new`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "NAME",
        help = both("snake_case 名称，例如 `get_battery`", "Name in snake_case, such as `get_battery`")
    )]
    name: String,
    #[arg(
        long,
        value_name = "GROUP",
        help = both("所属分组的 ID", "ID of the group to add it to")
    )]
    group: String,
    #[arg(
        long,
        help = both("新增上报，而不是指令", "Add a report instead of a command")
    )]
    report: bool,
    #[arg(
        long,
        conflicts_with = "report",
        help = both("新增数据端口上的流，而不是指令", "Add a stream on the data port instead of a command")
    )]
    stream: bool,
    #[arg(
        long,
        value_name = "COMMAND",
        requires = "stream",
        help = both("启动流的指令，流与它共用功能码", "Command that starts the stream and shares its code")
    )]
    started_by: Option<String>,
    #[arg(
        long,
        value_name = "CODE",
        value_parser = code,
        help = both("功能码，例如 `0x0A20` [默认：下一个空闲的]", "Code, such as `0x0A20` [default: the next free one]")
    )]
    code: Option<u16>,
}

/// Parses a code in hexadecimal with `0x` or in decimal.
pub fn code(text: &str) -> Result<u16, String> {
    let number = match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u16::from_str_radix(digits, 16),
        None => text.parse(),
    };
    number.map_err(|_| {
        said!(
            "功能码应为 0x0000 至 0xFFFF 的数",
            "a code is a number from 0x0000 to 0xFFFF"
        )
    })
}

pub fn run(spec: &Spec, options: &Options) -> Result<Status, Failure> {
    let model = spec.valid()?;
    let new = scaffold(
        model,
        &spec.sources,
        &NewOperation {
            name: &options.name,
            group: &options.group,
            kind: match (options.report, options.stream) {
                (true, _) => Kind::Report,
                (false, true) => Kind::Stream,
                (false, false) => Kind::Command,
            },
            code: options.code,
            started_by: options.started_by.as_deref(),
            lang: lang(),
            texts: spec.texts(),
        },
    )?;
    let after = spec.with(&new.path, &new.text);
    if after.model.is_none() {
        let (name, objection) = (&options.name, after.objection());
        return Err(said!("加上 `{name}` 之后{objection}", "with `{name}` {objection}").into());
    }
    replace_spec_file(&spec.project.root, &new.path, &new.text)?;
    let code = match new.code {
        Some(code) => said!("功能码 0x{code:04X}", "as 0x{code:04X}"),
        None => said!("没有功能码", "without a code"),
    };
    let added = print::good(&said!("已加入", "added"));
    let (name, path, line) = (&options.name, &new.path, new.line);
    print::done(&said!(
        "{added} {name}，{code}，在 {path}:{line}\n在那里写明它的作用，再运行 `fcproto generate`\n",
        "{added} {name} {code} in {path}:{line}\ndescribe it there, then run `fcproto generate`\n"
    ))?;
    Ok(Status::Fine)
}
