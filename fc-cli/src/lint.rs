//! `fcproto lint`.

use fc_codegen::target::FILE;
use fc_spec::diagnostic::Faults;
use fc_spec::index::definitions;
use fc_spec::lint::{faults, lint, settings, waive};

use crate::check::{Denied, OutputFormat};
use crate::lang::{both, counted, said};
use crate::outcome::{Failure, Status};
use crate::output::Output;
use crate::print;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::spec::Spec;
use crate::versions::{day, today};

/// Options of `fcproto lint`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    output: Output<OutputFormat>,
    #[arg(
        long,
        value_name = "WHAT",
        help = both("有这些内容时也以 1 退出", "Also exit with 1 for these")
    )]
    deny: Option<Denied>,
    #[arg(
        long,
        value_name = "DAY",
        value_parser = day,
        help = both("按这一天判断日期 [默认：今天]", "Judge dates as of this day [default: today]")
    )]
    today: Option<String>,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(dirs)?;
    let mut wrong = Faults::new();
    let (settings, files) = settings(&project.root, FILE, &mut wrong);
    if !wrong.is_empty() {
        wrong.sort();
        options.output.format.show(&project, &wrong, &files)?;
        return Ok(Status::Failed);
    }
    let spec = Spec::in_project(project);
    let Some(model) = &spec.model else {
        options
            .output
            .format
            .show(&spec.project, &spec.faults, &spec.sources)?;
        return Ok(spec.status());
    };
    let today = today(options.today.as_deref());
    let mut findings = lint(model, &settings, &today);
    waive(&mut findings, &model.waivers, &today);
    let shown = faults(&findings, &settings, || definitions(&spec.sources));
    options
        .output
        .format
        .show(&spec.project, &shown, &spec.sources)?;
    if options.output.format == OutputFormat::Text && shown.is_empty() {
        let waived = findings.iter().filter(|it| it.waived.is_some()).count();
        let waived = match waived {
            0 => String::new(),
            waived => said!("，{waived} 处已接受", ", {waived} waived"),
        };
        let linted = print::good(&said!("检查完毕", "linted"));
        let files = counted(spec.files(), "文件", "file");
        print::done(&said!(
            "{linted}：{files}，没有发现问题{waived}\n",
            "{linted} {files}: nothing found{waived}\n"
        ))?;
    }
    let is_denied = options.deny.is_some() && !shown.is_empty();
    Ok(Status::fine_if(!shown.has_errors() && !is_denied))
}
