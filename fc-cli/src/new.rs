//! `fcproto new`.

use fc_codegen::output::replace_spec_file;
use fc_spec::model::Kind;
use fc_spec::scaffold::{NewOperation, scaffold};

use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;
use crate::spec::Spec;

/// Add a command, report or stream to the file of its group.
///
/// It gets the next free code, a stream that of the command that starts it, and is added after the last of its kind. The result is valid; what you
/// have to fill in is marked. The spec is only changed if it has no errors before and after.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto new get_battery --group status
  fcproto new battery_low --group status --report
  fcproto new battery_curve --group status --stream --started-by get_battery
  fcproto new set_volume --group settings --code 0x0A20")]
pub struct Options {
    /// Its name in `snake_case`, such as `get_battery`.
    #[arg(value_name = "NAME")]
    name: String,
    /// Id of the group it belongs to.
    #[arg(long, value_name = "GROUP")]
    group: String,
    /// Add a report of the robot instead of a command of the app.
    #[arg(long)]
    report: bool,
    /// Add a stream on the data port instead; without --started-by and --code it has no code yet.
    #[arg(long, conflicts_with = "report")]
    stream: bool,
    /// The command that starts the stream, and whose code it shares.
    #[arg(long, value_name = "COMMAND", requires = "stream")]
    started_by: Option<String>,
    /// Its code, such as 0x0A20 [default: the next free one].
    #[arg(long, value_name = "CODE", value_parser = code)]
    code: Option<u16>,
}

/// A code as the spec writes it, or in decimal.
pub fn code(text: &str) -> Result<u16, String> {
    let number = match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u16::from_str_radix(digits, 16),
        None => text.parse(),
    };
    number.map_err(|_| "a code is a number from 0x0000 to 0xFFFF".to_owned())
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
