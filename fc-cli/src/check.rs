//! `fcproto check`.

use clap::ValueEnum;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::fix::fix_all;
use fc_spec::source::Sources;

use crate::lang::{both, counted, lang, said};
use crate::outcome::{Failure, Status};
use crate::output::Output;
use crate::print;
use crate::project::{Project, in_repository};
use crate::project_dirs::ProjectDirs;
use crate::spec::Spec;

/// Options of `fcproto check`.
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
        help = both("做无需选择的修改，再检查", "Apply the fixes that leave no choice, then check")
    )]
    fix: bool,
    #[arg(
        long,
        requires = "fix",
        help = both("以 diff 显示 `--fix` 的修改，什么也不写", "Show the changes of `--fix` as a diff and write nothing")
    )]
    dry_run: bool,
}

/// The findings that `--deny` counts as errors.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Denied {
    #[value(help = both("所有警告", "Every warning"))]
    Warnings,
}

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OutputFormat {
    #[value(help = both("带规范摘录，供人阅读", "With excerpts from the spec, for people"))]
    Text,
    #[value(help = both("每行一个 JSON 对象", "One JSON object per line"))]
    Json,
    #[value(help = both("SARIF 2.1.0 日志，供代码托管平台和编辑器使用", "A SARIF 2.1.0 log, for code hosts and editors"))]
    Sarif,
    #[value(help = both("GitHub 合并请求的注释", "Annotations of a GitHub pull request"))]
    Github,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let mut spec = Spec::read(dirs)?;
    if options.fix {
        spec = fixed(spec, options)?;
    }
    if let Some(model) = &spec.model {
        spec.project.targets.check_audiences(model)?;
    }
    options
        .output
        .format
        .show(&spec.project, &spec.faults, &spec.sources)?;
    if let (OutputFormat::Text, Some(model)) = (options.output.format, &spec.model) {
        let files = counted(spec.files(), "文件", "file");
        let operations = counted(model.operations.len(), "接口", "operation");
        let types = counted(model.types.len(), "类型", "type");
        let checked = print::good(&said!("检查完毕", "checked"));
        print::done(&said!(
            "{checked}：{files}，{operations}，{types}\n",
            "{checked} {files}: {operations}, {types}\n"
        ))?;
    }
    Ok(options.status(&spec))
}

/// Applies the certain fixes and returns the fixed spec. Writes the files, unless `--dry-run` only shows the changes.
fn fixed(spec: Spec, options: &Options) -> Result<Spec, Failure> {
    let Some(fixed) = fix_all(&spec.sources, |sources| {
        spec.instead(sources.clone()).faults
    }) else {
        if options.output.format == OutputFormat::Text {
            print::done(&said!(
                "没有能自动修改的错误\n",
                "no error has a certain fix\n"
            ))?;
        }
        return Ok(spec);
    };
    if options.dry_run {
        let changes = fixed.sources.changes_since(&spec.sources);
        let changes = changes.map(|(old, new)| print::change(&old.path, &old.text, &new.text));
        print::result(&changes.collect::<String>())?;
        return Ok(spec);
    }
    spec.project.write_changes(&spec.sources, &fixed.sources)?;
    if options.output.format == OutputFormat::Text {
        let good = print::good(&said!("已修改", "fixed"));
        let lines = fixed.done.iter().map(|it| {
            let message = lang().text(&it.message);
            format!("{good} {}:{} {}: {message}\n", it.path, it.line, it.code)
        });
        print::done(&lines.collect::<String>())?;
    }
    Ok(Spec::in_project(spec.project))
}

impl OutputFormat {
    /// Shows diagnostics. Text for people goes to standard error, and formats for programs go to standard output.
    pub fn show(
        self,
        project: &Project,
        faults: &Faults,
        sources: &Sources,
    ) -> Result<(), Failure> {
        let below = || sources.below(&in_repository(&project.root));
        let rendered = match self {
            Self::Text => return Ok(print::faults(faults, sources)?),
            Self::Json => render(faults, sources, Format::Json, lang()),
            Self::Sarif => render(faults, &below(), Format::Sarif, lang()),
            Self::Github => render(faults, &below(), Format::Github, lang()),
        };
        Ok(print::result(&rendered)?)
    }
}

impl Options {
    /// Returns the options of a run that counts warnings as errors.
    pub fn strict() -> Self {
        Self {
            output: Output {
                format: OutputFormat::Text,
            },
            deny: Some(Denied::Warnings),
            fix: false,
            dry_run: false,
        }
    }

    fn status(&self, spec: &Spec) -> Status {
        match spec.status() {
            Status::Fine if self.deny.is_some() && !spec.faults.is_empty() => Status::Faulty,
            status => status,
        }
    }
}
