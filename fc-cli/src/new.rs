//! `fcproto new`.

use fc_codegen::output::replace_spec_file;
use fc_spec::model::Kind;
use fc_spec::scaffold::{NewOperation, scaffold};

use crate::help::{Help, Part};
use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;
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

pub fn help() -> Help {
    Help {
        summary: both("新增指令、上报或流", "Add a command, report or stream"),
        details: vec![
            Part::Text(both(
                "新内容写入分组的文件，放在同类的最后一项之后。结果没有错误，需要你填写的地方有标记。规范在前后都没有错误时才会修改。",
                "The new operation goes into the file of its group, after the last one of its kind. The result has no errors, and \
                 marks show where you have to write. The spec changes only if it has no errors before and after.",
            )),
            Part::Text(both(
                "功能码取自用 `groups` 指明这个分组的号段。没有这样的号段时，取自不写 `groups` 的号段，优先取分组已有功能码所在的号段。",
                "The code comes from a range that names the group under `groups`. Without such a range, it comes from the ranges \
                 without `groups`, first from those in which the group has codes.",
            )),
            Part::Text(both(
                "没有 `--started-by` 和 `--code` 的流暂时没有功能码。",
                "A stream without `--started-by` and `--code` has no code yet.",
            )),
            Part::Examples(vec![
                ("fcproto new get_battery --group status", ""),
                ("fcproto new battery_low --group status --report", ""),
                (
                    "fcproto new battery_curve --group status --stream --started-by get_battery",
                    "",
                ),
                ("fcproto new set_volume --group settings --code 0x0A20", ""),
            ]),
        ],
        fails: both("规范有错误", "Errors in the spec"),
        speaks: "",
    }
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

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(place)?;
    let spec = Spec::in_project(&project);
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
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
    replace_spec_file(&project.root, &new.path, &new.text)?;
    let code = match new.code {
        Some(code) => said!("功能码 0x{code:04X}", "as 0x{code:04X}"),
        None => said!("没有功能码", "without a code"),
    };
    let began = print::good(&said!("已加入", "began"));
    let (name, path, line) = (&options.name, &new.path, new.line);
    print::done(&said!(
        "{began} {name}，{code}，在 {path}:{line}\n在那里写明它的作用，再运行 `fcproto generate`\n",
        "{began} {name} {code} in {path}:{line}\nsay what it does there, then run `fcproto generate`\n"
    ))?;
    Ok(Status::Fine)
}
